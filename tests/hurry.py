"""Real media without real waits: a served simulator and the clients in this process share a clock that jumps.

Bytes go through the sockets and terminals of the system as ever. But when a client waits and nothing can come
(all that it wrote was taken and answered, all that was answered was read) the clock jumps: to the moment when
the next piece is due, or to the end of the client's time-out. So time-outs, slow answers and paced lines are
exact and cost nothing, however busy the machine is.

What cannot be proven is waited for: bytes that a full terminal drops, clients that are other processes.
"""

from __future__ import annotations

import os
import threading
import time
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING
from unittest.mock import patch

from fatektool.simulator.listen.pty import PtyListener
from fatektool.simulator.listen.servers import running
from tests.clocked import clocked

if TYPE_CHECKING:
    import selectors
    from collections.abc import Callable, Iterator

    from fatektool.simulator.listen.base import ServedLine
    from fatektool.simulator.listen.servers import Server


class ServerClock:
    """A clock that stands while a client has a line, and jumps where it waits; it runs while none has.

    Args:
        server: whose clock it is; not serving yet.
    """

    def __init__(self, server: Server) -> None:
        self._server = server
        self._since, self._now = time.perf_counter(), 0.0
        self._lock = threading.Lock()
        self._asked = self._taken = self._answered = self._read = 0  # bytes
        self._taking = 0
        self._open = 0
        self._lines, self._dispatch, self._ready = server.lines, server.dispatch, server._ready
        server.lines = self
        server.now = self.now
        server.dispatch = self.dispatch  # type: ignore[method-assign]
        server._ready = self.ready  # type: ignore[assignment, method-assign]

    @property
    def powered(self) -> bool:
        return self._lines.powered

    def line(self, *, whole_answers: bool = False) -> ServedLine:
        return _Counted(self._lines.line(whole_answers=whole_answers), self)  # a pty has its line already

    def now(self) -> float:
        return self._now if self._open else self._now + time.perf_counter() - self._since

    def skip(self, seconds: float) -> None:
        """Sleep."""
        with self._lock:
            self._now += seconds

    # --- the server's side

    def ready(self) -> Iterator[tuple[selectors.SelectorKey, int]]:
        """What the server has to do; what it took is taken when that is done."""
        for each in self._ready():
            yield each
            with self._lock:
                self._taken += self._taking
                self._taking = 0

    def taking(self, size: int) -> None:
        self._taking += size

    def dispatch(
        self, due: list[tuple[float, bytes]], deliver: Callable[[bytes], None], *, join: bool = True
    ) -> int:
        coming, held = sum(len(data) for _, data in due), self._held
        with self._lock:
            self._answered += coming
        deliveries = self._dispatch(due, deliver, join=join)
        if not self.powered:
            with self._lock:
                self._answered -= coming + held
        return deliveries

    def read_by(self, door: PtyListener) -> Callable[[int, int], bytes]:
        """``os.read``, which counts what this door reads, whatever it makes of it."""
        read = os.read

        def counting(descriptor: int, size: int) -> bytes:
            data = read(descriptor, size)
            if descriptor == door._master:
                self.taking(len(data))
            elif descriptor == door._slave:  # an answer that nobody read
                self.read(len(data))
            return data

        return counting

    @property
    def _held(self) -> int:
        """Bytes that are not due yet."""
        return sum(len(data) for *_, data in self._server._due)

    # --- the clients' side

    def opened(self, *, keeps: bool) -> None:
        """A client comes; on a medium that ``keeps`` them it is given what was for the one before."""
        with self._lock:
            if not self._open:
                self._asked = self._taken = self._read = 0
                self._answered = self._held if keeps else 0
                self._now = self.now()
            self._open += 1

    def closed(self) -> None:
        with self._lock:
            self._open -= 1
            self._since = time.perf_counter()

    def asked(self, size: int) -> None:
        with self._lock:
            self._asked += size

    def read(self, size: int) -> None:
        with self._lock:
            self._read += size

    def jump(self, deadline: float, *, sure: bool = False) -> None:
        """Jump to when the next piece is due, or to a deadline; stay where something may be on its way.

        Args:
            deadline: of the client that waits.
            sure: nothing can be on its way any more.
        """
        with self._lock:
            due = self._server._due
            if sure or (self._asked == self._taken and (due or self._read == self._answered)):
                self._now = max(self._now, min(due[0][0], deadline) if due else deadline)
        self._server._wake_up.send(b"\0")


class _Counted:
    """The line of a socket, whose requests are counted."""

    def __init__(self, line: ServedLine, clock: ServerClock) -> None:
        self._line = line
        self._clock = clock

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        self._clock.taking(len(data))
        return self._line.receive(data, now)

    def datagram(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        self._clock.taking(len(data))
        return self._line.datagram(data, now)


@contextmanager
def hurried(server: Server) -> Iterator[Server]:
    """Serve in a thread, as ``running`` does, on a clock that jumps for the clients in this process."""
    clock = ServerClock(server)
    addresses = {door.address for door in server.listeners}
    with ExitStack() as stack:
        for door in server.listeners:
            if isinstance(door, PtyListener):
                stack.enter_context(patch.object(os, "read", clock.read_by(door)))
        stack.enter_context(clocked(clock, addresses.__contains__))
        yield stack.enter_context(running(server))
