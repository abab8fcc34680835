"""The clock that jumps: what takes hours on the line takes no time here, and comes to the same end."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from fatektool.connection import connect
from fatektool.errors import NoAnswer
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server
from tests.hurry import hurried

if TYPE_CHECKING:
    from pathlib import Path

HOURS = 4 * 3600.0
MEDIA = ["tcp", "udp", *(["pty"] if hasattr(os, "openpty") else [])]


@pytest.fixture(autouse=True)
def locks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(tmp_path))


def opened(server: Server, medium: str, folder: Path, baud: int | None = None) -> str:
    if medium == "pty":
        return server.open_pty(folder / "plc", baud).address
    return (server.open_tcp() if medium == "tcp" else server.open_udp()).address


@pytest.mark.parametrize("medium", MEDIA)
def test_hours_of_silence(medium: str, tmp_path: Path) -> None:
    server = Server(build_simulation(faults=["drop=1"]))
    target = opened(server, medium, tmp_path)
    with hurried(server), connect(target, timeout_s=HOURS, retries=0) as plc:
        with pytest.raises(NoAnswer):
            plc.brief_status()
        assert server.now() >= HOURS


@pytest.mark.parametrize("medium", MEDIA)
def test_an_answer_that_takes_hours_is_heard(medium: str, tmp_path: Path) -> None:
    server = Server(build_simulation(scan_ms=HOURS * 1000))
    target = opened(server, medium, tmp_path)
    with hurried(server), connect(target, timeout_s=2 * HOURS, retries=0) as plc:
        assert not plc.brief_status().flags.running
        assert HOURS <= server.now() < 2 * HOURS


@pytest.mark.parametrize("medium", MEDIA)
def test_a_paced_line_takes_its_time_on_the_clock(medium: str, tmp_path: Path) -> None:
    server = Server(build_simulation(baud=50, ladder_words=400))
    target = opened(server, medium, tmp_path)
    with hurried(server), connect(target, baud=50) as plc:
        began = server.now()
        plc.read_page(0)
        chars = 12 + 265  # of the request, and of the answer
        assert chars * 10 / 50 <= server.now() - began < (chars + 1) * 10 / 50


@pytest.mark.skipif("pty" not in MEDIA, reason="no pseudo terminals here")
def test_bytes_at_another_speed_are_taken_and_never_answered(tmp_path: Path) -> None:
    server = Server(build_simulation())
    target = opened(server, "pty", tmp_path, 38400)
    with hurried(server):
        with connect(target, baud=9600, timeout_s=HOURS, retries=0) as plc, pytest.raises(NoAnswer):
            plc.brief_status()
        with connect(target, baud=38400, timeout_s=HOURS, retries=0) as plc:
            assert not plc.brief_status().flags.running
