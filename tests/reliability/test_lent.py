"""A line that ``watch`` lends: others have it between two rounds, as processes of their own."""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import threading
from contextlib import contextmanager, suppress
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running
from fatektool.transport.lock import PortLock
from tests.cli.running import Press, check, process, started
from tests.reliability.test_two import REGISTERS, line, value

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.forks.command import Process

pytestmark = pytest.mark.skipif(os.name != "posix", reason="ptys and signals of POSIX")


class Gateway:
    """It serves one connection at a time; the next waits unheard until that one is closed."""

    def __init__(self, inside: tuple[str, int]) -> None:
        self._inside = inside
        self._door = socket.create_server(("127.0.0.1", 0))
        self.target = f"tcp://127.0.0.1:{self._door.getsockname()[1]}"
        self.served = 0

    def serve(self) -> None:
        while True:
            try:
                client, _ = self._door.accept()
            except OSError:  # closed
                return
            self.served += 1
            with client, socket.create_connection(self._inside) as plc, suppress(ConnectionError):
                other = {client: plc, plc: client}
                while data := (ready := select.select([client, plc], [], [])[0][0]).recv(4096):
                    other[ready].sendall(data)

    def close(self) -> None:
        self._door.shutdown(socket.SHUT_RDWR)
        self._door.close()


@contextmanager
def gateway() -> Iterator[Gateway]:
    simulation = build_simulation(ladder_words=64)
    simulation.plcs[1].write_words("R", 0, [value(address) for address in range(REGISTERS)])
    server = Server(simulation)
    host, port = server.open_tcp().address.removeprefix("tcp://").split(":")
    with running(server):
        made = Gateway((host, int(port)))
        thread = threading.Thread(target=made.serve, daemon=True)
        thread.start()
        yield made
        made.close()


@contextmanager
def over_tcp(_: Path) -> Iterator[str]:
    with gateway() as made:
        yield made.target


@contextmanager
def over_a_pty(folder: Path) -> Iterator[str]:
    with line(folder / "plc") as (target, _):
        yield target


class Watch:
    """``watch`` in a process of its own, whose output is always read: a full pipe would hold it up."""

    def __init__(self, process: Process) -> None:
        self.process = process
        self.pid = process.pid
        self._lines: SimpleQueue[str] = SimpleQueue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for text in self.process.stdout:
            self._lines.put(text)

    def rounds(self, count: int) -> list[Any]:
        """The next rounds from now on."""
        while not self._lines.empty():
            self._lines.get()
        found = [json.loads(self._lines.get()) for _ in range(count)]
        for each in found:
            check(each, "watch")
        return [each["values"] for each in found]

    def told(self) -> str:
        """The next line on stderr."""
        assert self.process.stderr is not None
        return self.process.stderr.readline()

    def interrupted(self) -> str:
        """End it by Ctrl-C; give the rest of its stderr."""
        self.process.send_signal(signal.SIGINT)
        assert self.process.wait() == 130
        self._reader.join()
        assert self.process.stderr is not None
        return self.process.stderr.read()


@contextmanager
def watching(target: str, interval: float, *words: object) -> Iterator[Watch]:
    """A watch past its first round."""
    with started("watch", "R0", "-p", target, "--interval", interval, "--timeout", 10, *words) as process:
        try:
            job = Watch(process)
            assert job.rounds(1)[0].keys() == {"R0"}
            yield job
        finally:
            process.kill()


@pytest.mark.parametrize("interval", [0, 0.05, 60])
@pytest.mark.parametrize("medium", [over_a_pty, over_tcp])
def test_who_waits_for_a_watched_line_has_it_between_two_rounds(
    place: Path, medium: Any, interval: float
) -> None:
    """Whatever the interval. Neither takes a byte of the other's, and each says whom it waits for."""
    with medium(place) as target, watching(target, interval) as job:
        for n in (5, 500, 999):
            done = process("read", f"R{n}", "-p", target, "--lock-wait", 60, "--timeout", 10)
            assert (done.code, done.out.split()) == (0, [f"R{n}", str(value(n))])
            if done.err:  # the line may have been free
                assert f"is in use by process {job.pid} (fatektool watch R0 -p " in done.err
                assert done.err.endswith("Z): waiting, for 60 s at most\n")
        if interval < 60:
            assert job.rounds(3) == [{"R0": value(0)}] * 3
        assert "trying again" not in job.interrupted()


def test_a_watch_waits_for_its_line_as_long_as_it_takes(place: Path) -> None:
    """It says whom it waits for, goes on afterwards, and ends at once by Ctrl-C meanwhile."""
    with line(place / "plc") as (target, _), watching(target, 0, "--lock-wait", 0) as job:
        lock = PortLock(os.path.realpath(target), 60)
        lock.acquire()
        told = job.told()
        assert f"is in use by process {os.getpid()} (" in told
        assert told.endswith("Z): waiting\n")
        lock.release()
        job.rounds(50)
        lock.acquire()
        job.interrupted()
        lock.release()


def test_a_watched_line_stays_open_while_nobody_wants_it(place: Path) -> None:
    """No connection is made anew for a round, which an Ethernet module answers with pauses."""
    assert place.exists()
    with gateway() as made, watching(made.target, 0.01) as job:
        job.rounds(20)
        assert made.served == 1


def test_a_port_that_is_gone_is_opened_anew(place: Path) -> None:
    with line(place / "plc") as (target, _), watching(target, 0.05) as job:
        (place / "plc").rename(place / "away")
        lock = PortLock(os.path.realpath(place / "away"), 60)
        lock.acquire()
        lock.release()
        while "trying again" not in job.told():
            pass
        (place / "away").rename(place / "plc")
        job.rounds(3)


def test_a_simulated_plc_in_a_file(place: Path) -> None:
    """What another process writes between two rounds is there in the next."""
    press = Press(place)
    with watching(press.target, 0.05) as job:
        assert process("write", "R0=7", "-p", press.target, "--lock-wait", 60).code == 0
        while job.rounds(1)[0] == {"R0": 0}:
            pass
        assert process("read", "R0", "-p", press.target, "--lock-wait", 60).out.split() == ["R0", "7"]
