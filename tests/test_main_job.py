"""The main job from end to end, as its users do it: real processes, ptys and sockets, a paced line.

A program of 13184 words is backed up over a paced pty, is restored to a second PLC over serial, TCP and UDP,
verified, and RUN again. A restore that is killed at any page is finished by the same command.
"""

from __future__ import annotations

import os
import signal
import subprocess
from typing import TYPE_CHECKING

import pytest

from fatektool.cli import run
from fatektool.program.archive import load_backup
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.pty import PTY_SUPPORTED
from fatektool.simulator.listen.servers import Server, running
from tests.forks.command import COMMAND, PIPE, Forked

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.simulator.plc import SimulatedPlc

PACE = ["--baud", "921600"]


@pytest.fixture(autouse=True)
def locks_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(tmp_path))
    monkeypatch.chdir(tmp_path)


def forked(*words: str, expect: int = 0) -> None:
    with Forked(words, stdout=PIPE, stderr=PIPE) as process:
        _, err = process.communicate()
    assert process.returncode == expect, err


def fatektool_of_its_own(*words: str, expect: int = 0) -> None:
    """In an interpreter that was started for it, as a user's is."""
    done = subprocess.run([*COMMAND, *words], capture_output=True, text=True, check=False)
    assert done.returncode == expect, done.stderr


def open_door(server: Server, medium: str, link: Path) -> str:
    """A door of this medium; gives its target."""
    if medium == "pty":
        return server.open_pty(link).address
    return (server.open_tcp if medium == "tcp" else server.open_udp)().address


@pytest.fixture(params=["pty", "tcp", "udp"])
def medium(request: pytest.FixtureRequest) -> str:
    name: str = request.param
    if name == "pty" and not PTY_SUPPORTED:
        pytest.skip("no pseudo terminals on this system")
    return name


@pytest.fixture
def origin(tmp_path: Path, medium: str) -> Iterator[tuple[str, SimulatedPlc]]:
    """The machine: a PLC in RUN."""
    simulation = build_simulation()
    simulation.plcs[1].running = True
    server = Server(simulation)
    target = open_door(server, medium, tmp_path / "machine")
    with running(server):
        yield target, simulation.plcs[1]


def test_a_program_goes_from_one_plc_to_another(
    medium: str, origin: tuple[str, SimulatedPlc], tmp_path: Path
) -> None:
    target, machine = origin
    fatektool = fatektool_of_its_own if medium == "tcp" else forked
    fatektool("backup", "machine.json", "-p", target, *PACE)
    saved = load_backup(tmp_path / "machine.json")
    assert len(saved.program.pages) == 207
    assert list(saved.program.pages) == machine.pages

    simulation = build_simulation(ladder_words=13184, program_seed=2)
    spare = simulation.plcs[1]
    spare.running = True
    old = list(spare.pages)
    server = Server(simulation)
    door = open_door(server, medium, tmp_path / "spare")
    with running(server):
        fatektool("verify", "machine.json", "-p", door, *PACE, expect=1)
        fatektool("restore", "machine.json", "-p", door, *PACE, "--yes", expect=4)
        assert spare.pages == old
        fatektool("restore", "machine.json", "-p", door, *PACE, "--yes", "--stop", "--run", "-q")
        fatektool("verify", "machine.json", "-p", door, *PACE)
    assert spare.pages == machine.pages
    assert spare.running
    (safety,) = tmp_path.glob("machine.safety-*.json")
    assert list(load_backup(safety).program.pages) == old


PAGES = 8


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs SIGKILL")
@pytest.mark.parametrize("page", range(PAGES))
def test_a_restore_killed_at_any_page_is_finished_by_the_same_command(page: int, tmp_path: Path) -> None:
    words = (PAGES - 1) * 64
    wanted = build_simulation(ladder_words=words).plcs[1]
    simulation = build_simulation(ladder_words=words, program_seed=2)
    plc = simulation.plcs[1]
    old = list(plc.pages)
    state = tmp_path / "wanted.state"
    build_simulation(ladder_words=words, state=state)
    assert run(["backup", "wanted.json", "-p", f"sim:{state}"]) == 0

    server = Server(simulation)
    command = ["restore", "wanted.json", "-p", server.open_tcp().address, "--yes"]
    kill_at_page(plc, page)
    with running(server):
        with Forked(command, stderr=PIPE) as process:
            victims.append(process)
            process.communicate()
        assert process.returncode == -signal.SIGKILL
        assert plc.pages[: page + 1] == wanted.pages[: page + 1]
        assert plc.pages[page + 1 :] == old[page + 1 :]
        assert kept_programs(tmp_path) == [old]

        assert run(command) == 0
        assert plc.pages == wanted.pages
        assert kept_programs(tmp_path) == [old]
        assert not list(tmp_path.glob(".fatektool-*.tmp"))


def kept_programs(folder: Path) -> list[list[bytes]]:
    """What the safety backups in a folder hold."""
    return [list(load_backup(path).program.pages) for path in folder.glob("wanted.safety-*.json")]


victims: list[Forked] = []


def kill_at_page(plc: SimulatedPlc, page: int) -> None:
    """Let the PLC take this page, and kill the newest victim before it hears of it."""
    victims.clear()
    write_page = plc.write_page

    def write_and_kill(number: int, content: bytes) -> None:
        write_page(number, content)
        if number == page and victims:
            os.kill(victims.pop().pid, signal.SIGKILL)

    plc.write_page = write_and_kill  # type: ignore[assignment, method-assign]
