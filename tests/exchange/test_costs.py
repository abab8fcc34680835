"""What an exchange costs the client: calls of the system and what stays allocated, counted, not timed."""

from __future__ import annotations

import select
import sys
import tracemalloc
from collections import Counter
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from fatektool import connect
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.pty import PTY_SUPPORTED
from fatektool.simulator.listen.servers import Server, running
from fatektool.transport.memory import MemoryTransport

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.client import Plc

CALLS = {"send", "recv", "poll", "read", "write", "settimeout", "ioctl", "tcsetattr", "sleep", "select"}
PAGES = 100


@contextmanager
def counted() -> Iterator[Counter[str]]:
    """The calls that this thread makes of the system, as long as the context lasts."""
    found: Counter[str] = Counter()

    def profile(_frame: object, event: str, called: Any) -> None:
        if event == "c_call" and called.__name__ in CALLS:
            found[called.__name__] += 1

    sys.setprofile(profile)
    try:
        yield found
    finally:
        sys.setprofile(None)


def first_exchange(plc: Plc) -> None:
    """Find out whether the line echoes, as that costs an exchange of its own."""
    plc.brief_status()


def test_within_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """An answer of ``sim:`` is one piece, at any speed: only its last byte has a time that matters."""
    read, sizes = MemoryTransport.read, []

    def counting(line: MemoryTransport, most: int, timeout_s: float) -> bytes:
        data = read(line, most, timeout_s)
        sizes.append(len(data))
        return data

    monkeypatch.setattr(MemoryTransport, "read", counting)
    with connect("sim:", baud=300) as plc:
        first_exchange(plc)
        sizes.clear()
        began = plc.link.transport.clock()
        plc.read_pages(range(PAGES))
        took_s = plc.link.transport.clock() - began
    assert len(sizes) == PAGES + 1  # and the fence
    assert sizes[:-1] == [265] * PAGES
    assert took_s > PAGES * 265 * 10 / 300  # on the clock of the line, on which it takes its time


def test_over_tcp() -> None:
    server = Server(build_simulation(ladder_words=PAGES * 64))
    door = server.open_tcp()
    with running(server), connect(door.address) as plc:
        first_exchange(plc)
        with counted() as reading:
            plc.read_pages(range(PAGES))
        pages = [(number, bytes(128)) for number in range(1, PAGES)]
        with counted() as writing:
            plc.write_pages(pages)
    exchanges = PAGES + 1  # and the fence
    assert reading["send"] == exchanges
    assert reading["recv"] == exchanges  # an answer is one piece here
    waits = "poll" if hasattr(select, "poll") else "select"
    # For the answer, and whether there is anything beside it. A socket with a time-out would wait by itself,
    # before it sends too, and this count would not see it: so it has none.
    assert reading[waits] <= 2 * exchanges + 2
    assert writing["send"] == writing["recv"] == len(pages)
    assert writing[waits] <= 2 * len(pages) + 2
    assert set(reading + writing) <= {"send", "recv", waits}


@pytest.mark.skipif(not PTY_SUPPORTED, reason="this system has no pseudo terminals")
def test_over_a_pty(tmp_path: Path) -> None:
    server = Server(build_simulation(ladder_words=PAGES * 64))
    door = server.open_pty(tmp_path / "plc")
    with running(server), connect(door.address) as plc:
        first_exchange(plc)
        with counted() as reading:
            plc.read_pages(range(PAGES))
    assert reading["write"] == PAGES + 1  # each request is one piece
    pieces = reading["read"]
    assert pieces >= PAGES + 1
    assert reading["poll"] <= pieces + PAGES + 3  # one a piece, one to see whether anything is beside
    assert set(reading) <= {"write", "read", "poll"}


def test_a_long_reading_keeps_its_answers_and_nothing_else() -> None:
    server = Server(build_simulation(ladder_words=PAGES * 64))
    door = server.open_tcp()
    with running(server), connect(door.address) as plc:
        first_exchange(plc)
        plc.read_pages(range(PAGES))
        tracemalloc.start()
        try:
            before, _ = tracemalloc.get_traced_memory()
            for _ in range(5):
                plc.read_pages(range(PAGES))
            after, _ = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
    assert after - before < 20_000  # five programs would be 80 000 and more
