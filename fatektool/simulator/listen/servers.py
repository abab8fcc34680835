"""One thread that serves a simulator through many doors and keeps the pace of its lines.

::

            ┌── wait for bytes, or for the next piece that is due
            │      │
    Server ─┤      ├── bytes: door.read ──> line.receive ──> pieces with their due times ──> heap
            │      └── due:   heap ──> door's deliver
            └── again, until stop()

Selectors wait in whole milliseconds (epoll rounds up), which a page at 921600 baud, 3 ms of wire time,
cannot bear. So the wait for a due piece is done by ``select`` on the selector's own descriptor, which
takes microseconds, and its last stretch by asking without waiting. A late wake-up does not add up: due
times come from the line's ideal timeline, not from when the piece before was sent.
"""

from __future__ import annotations

import contextlib
import heapq
import itertools
import select
import selectors
import socket
import threading
import time
from typing import TYPE_CHECKING

from fatektool.simulator.listen.discovery import ANSWER_PORT, DiscoveryDoor
from fatektool.simulator.listen.listeners import TcpDoor, UdpDoor
from fatektool.simulator.listen.pty import PtyDoor

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterator

    from fatektool.simulator.listen.listeners import Door, Lines

_SPIN_S = 0.00012
"""How long before a due time the thread stops sleeping: a system's wake-up may be that late."""


class Server:
    """Doors to one simulation or replay. Open them, then serve; one thread does all.

    Args:
        simulation: gives each door its lines.
    """

    def __init__(self, simulation: Lines) -> None:
        self.simulation = simulation
        self.selector = selectors.DefaultSelector()
        self.now = time.perf_counter
        self.doors: list[Door] = []
        self._due: list[tuple[float, int, Callable[[bytes], None], bytes]] = []
        self._order = itertools.count()
        self._stopping = False
        self._closed = False
        self._wake_up, self._woken = socket.socketpair()
        self._wake_up.settimeout(0)
        self._woken.settimeout(0)
        self.selector.register(self._woken, selectors.EVENT_READ, self._on_wake_up)
        self._wait_s = _precise_wait(self.selector)

    def open_tcp(self, host: str = "127.0.0.1", port: int = 0) -> Door:
        """Listen on TCP; port 0 takes a free one. LineError if it cannot be had."""
        return self._opened(TcpDoor(self, host, port))

    def open_udp(self, host: str = "127.0.0.1", port: int = 0) -> Door:
        """Listen on UDP; port 0 takes a free one. LineError if it cannot be had."""
        return self._opened(UdpDoor(self, host, port))

    def open_discovery(self, host: str = "127.0.0.1", port: int = 0, answer_port: int = ANSWER_PORT) -> Door:
        """Answer who looks for Ethernet modules by UDP. LineError if the address cannot be had."""
        return self._opened(DiscoveryDoor(self, host, port, answer_port))

    def open_pty(self, link: str | os.PathLike[str], baud: int | None = None) -> Door:
        """Make a pseudo terminal with ``link`` pointing to it. LineError if it cannot be had.

        Args:
            link: the path that clients open.
            baud: the only speed at which clients are understood; None for any.
        """
        return self._opened(PtyDoor(self, link, baud))

    def serve_until(self, stop: Callable[[], bool] = bool) -> None:
        """Serve until ``stop()`` of this server was called, or the predicate given here says so.

        The predicate is asked after every wake-up only; ``Server.stop`` wakes the thread.
        """
        due = self._due
        while not self._stopping and not stop():
            for key, events in self._ready():
                key.data(events)
            while due and due[0][0] <= self.now():
                _, _, deliver, data = heapq.heappop(due)
                deliver(data)
        self._stopping = False

    def stop(self) -> None:
        """Make ``serve_until`` return; may be called from a signal handler or another thread."""
        self._stopping = True
        with contextlib.suppress(OSError):  # a full buffer wakes it up as well
            self._wake_up.send(b"\0")

    def close(self) -> None:
        """Close all doors; twice is fine."""
        if self._closed:
            return
        self._closed = True
        for door in self.doors:
            door.close()
        self._due.clear()
        self.selector.close()
        self._wake_up.close()
        self._woken.close()

    def dispatch(
        self, due: list[tuple[float, bytes]], deliver: Callable[[bytes], None], *, join: bool = True
    ) -> int:
        """Have every piece delivered when it is due; the number of deliveries.

        What is due at the same time is delivered as one, if ``join``: for a stream.
        """
        if not self.simulation.powered:
            self._lose_power()
            return 0
        if join and len(due) > 1:
            due = [
                (moment, b"".join([data for _, data in pieces]))
                for moment, pieces in itertools.groupby(due, key=lambda piece: piece[0])
            ]
        for moment, data in due:
            heapq.heappush(self._due, (moment, next(self._order), deliver, data))
        return len(due)

    def _opened(self, door: Door) -> Door:
        self.doors.append(door)
        return door

    def _lose_power(self) -> None:
        self._due.clear()
        for door in self.doors:
            door.lose_power()

    def _ready(self) -> list[tuple[selectors.SelectorKey, int]]:
        if not self._due:
            return self.selector.select()
        wait_s = self._due[0][0] - self.now() - _SPIN_S
        if wait_s > 0:
            self._wait_s(wait_s)
        return self.selector.select(0)

    def _on_wake_up(self, _events: int) -> None:
        with contextlib.suppress(OSError):
            self._woken.recv(64)


def _precise_wait(selector: selectors.BaseSelector) -> Callable[[float], object]:
    """A wait for bytes or a time, to the microsecond if the system can."""
    # epoll and kqueue are descriptors themselves, readable when one that they watch is.
    fileno = getattr(selector, "fileno", None)
    if fileno is None:
        return selector.select
    descriptor = fileno()
    try:
        select.select([descriptor], [], [], 0)
    except (OSError, ValueError):  # more descriptors are open than select() can name
        return selector.select
    return lambda wait_s: select.select([descriptor], [], [], wait_s)


@contextlib.contextmanager
def running(server: Server) -> Iterator[Server]:
    """Serve in a thread of its own as long as the context lasts, then close the server."""
    failures: list[BaseException] = []

    def serve() -> None:
        try:
            server.serve_until()
        except BaseException as error:  # noqa: BLE001 - raised again where the context ends
            failures.append(error)
            server.close()  # clients see an end, not a silence

    thread = threading.Thread(target=serve, name="fatektool simulator", daemon=True)
    thread.start()
    try:
        yield server
    finally:
        server.stop()
        thread.join()
        server.close()
    if failures:
        raise failures[0]
