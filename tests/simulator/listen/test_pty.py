"""A real pseudo terminal, served by a thread of this process."""

from __future__ import annotations

import os
import selectors
import subprocess
import sys
from contextlib import closing, contextmanager, suppress
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import LineError
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen import pty as pty_door
from fatektool.simulator.listen.servers import Server, running
from tests.guard import GUARD_S
from tests.simulator.listen.listeners import ANSWER, ASK, PAGE_HEX, connected, read
from tests.simulator.wire import frame

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


needs_pty = pytest.mark.skipif(not pty_door.PTY_SUPPORTED, reason="no pseudo terminals here")


def write_all(terminal: int, data: bytes) -> None:
    while data:
        with suppress(BlockingIOError):  # the server has yet to read what was written before
            data = data[os.write(terminal, data) :]


def exchange(terminal: int, data: bytes, count: int) -> bytes:
    write_all(terminal, data)
    answer = b""
    with selectors.DefaultSelector() as selector:
        selector.register(terminal, selectors.EVENT_READ)
        while len(answer) < count and selector.select(10):
            answer += os.read(terminal, count - len(answer))
    return answer


@pytest.fixture
def link(tmp_path: Path) -> Path:
    return tmp_path / "plc"


@contextmanager
def terminal(link: Path) -> Iterator[int]:
    opened = os.open(link, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        yield opened
    finally:
        os.close(opened)


@needs_pty
def test_pty_survives_its_clients(link: Path) -> None:
    server = Server(build_simulation())
    listener = server.open_pty(link)
    assert listener.address == str(link)
    with running(server):
        for _ in range(5):
            with terminal(link) as client:
                assert exchange(client, ASK, len(ANSWER)) == ANSWER
        # 02 and 03, 11H and 13H and line ends pass as they are.
        loopback = frame("4E" + "".join(map(chr, [*range(4, 256), 1])))
        with terminal(link) as client:
            assert exchange(client, loopback, len(loopback)) == loopback
    assert not link.is_symlink()


@needs_pty
def test_a_pty_without_power_is_silent_and_stays(link: Path) -> None:
    simulation = build_simulation(faults=["power-cut=1"])
    server = Server(simulation)
    server.open_pty(link)
    listener = server.open_tcp()
    with running(server), terminal(link) as client, connected(listener) as witness:
        write_all(client, frame("500000" + PAGE_HEX) + ASK)
        assert read(witness, 1) == b""  # the power is gone
        simulation.power_on()
        assert exchange(client, ASK, len(ANSWER)) == ANSWER


@needs_pty
def test_what_a_gone_client_left_unread_does_not_jam_a_pty(link: Path) -> None:
    server = Server(build_simulation())
    server.open_pty(link)
    with running(server):
        with terminal(link) as client:
            for _ in range(1000):
                write_all(client, frame("4F0000"))
        with terminal(link) as client:
            nonce = frame("4Efence")
            write_all(client, nonce)
            heard = b""
            with selectors.DefaultSelector() as selector:
                selector.register(client, selectors.EVENT_READ)
                while not heard.endswith(nonce) and selector.select(10):
                    with suppress(BlockingIOError):  # the server has dropped it in between
                        heard += os.read(client, 4096)
            assert heard.endswith(nonce)
            assert exchange(client, ASK, len(ANSWER)) == ANSWER


@needs_pty
def test_a_link_of_a_dead_simulator_is_replaced(link: Path) -> None:
    code = (
        "import os, sys; from fatektool.simulator.build import build_simulation;"
        "from fatektool.simulator.listen.servers import Server;"
        "Server(build_simulation()).open_pty(sys.argv[1]); os._exit(9)"
    )
    subprocess.run([sys.executable, "-c", code, str(link)], check=False, timeout=GUARD_S)
    assert link.is_symlink()
    with closing(Server(build_simulation())) as server:
        listener = server.open_pty(link)
        assert link.exists()
        listener.close()
        listener.close()
    assert list(link.parent.iterdir()) == []


@needs_pty
def test_the_terminal_of_a_dead_simulator_may_be_anothers_by_now(link: Path) -> None:
    with closing(Server(build_simulation())) as server, closing(Server(build_simulation())) as other:
        server.open_pty(link.with_name("other"))
        link.symlink_to(link.with_name("other").readlink())
        link.with_name(".plc.lock").touch()
        other.open_pty(link)
        assert link.readlink() != link.with_name("other").readlink()


@needs_pty
def test_a_link_to_a_terminal_that_is_no_more_is_replaced(link: Path) -> None:
    link.symlink_to("/dev/pts/999999999")
    with closing(Server(build_simulation())) as server:
        server.open_pty(link)
        assert link.exists()


@needs_pty
def test_what_is_not_a_dead_simulators_link_is_kept(link: Path, tmp_path: Path) -> None:
    with closing(Server(build_simulation())) as server, closing(Server(build_simulation())) as other:
        server.open_pty(link)
        target = link.readlink()
        with pytest.raises(LineError, match="another simulator uses it"):
            other.open_pty(link)
        assert link.readlink() == target
        (tmp_path / "console").symlink_to(target)
        (tmp_path / "file").write_text("mine")
        (tmp_path / "dangling").symlink_to(tmp_path / "nowhere")
        for name in ("file", "dangling", "console"):
            with pytest.raises(LineError, match="it exists"):
                other.open_pty(tmp_path / name)
        with pytest.raises(LineError, match="No such file"):
            other.open_pty(tmp_path / "nowhere" / "plc")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["console", "dangling", "file"]
    assert (tmp_path / "file").read_text() == "mine"


@needs_pty
def test_a_link_that_points_elsewhere_by_now_is_left(link: Path, tmp_path: Path) -> None:
    with closing(Server(build_simulation())) as server:
        server.open_pty(link)
        link.unlink()
        link.symlink_to(tmp_path)
    assert link.is_symlink()


def test_no_pty_where_there_is_none(link: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pty_door, "PTY_SUPPORTED", False)
    with closing(Server(build_simulation())) as server, pytest.raises(LineError, match="use TCP"):
        server.open_pty(link)


@needs_pty
def test_a_folder_is_no_link() -> None:
    with closing(Server(build_simulation())) as server, pytest.raises(LineError, match="folder"):
        server.open_pty("/")
