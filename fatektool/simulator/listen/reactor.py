"""One thread that serves many listeners, with the timing of their lines.

::

             ┌── wait for bytes, or for the next piece that is due
             │      │
    Reactor ─┤      ├── bytes: listener ──> line.receive ──> pieces with their due times ──> heap
             │      └── due:   heap ──> the listener's deliver
             └── again, until stop()

Selectors wait in whole milliseconds (epoll rounds up), which is too coarse for a page at 921600 baud, 3 ms of
wire time. So the wait for a due piece uses ``select`` on the selector's own descriptor, which takes
microseconds, and at the end polls without waiting. Late wake-ups do not add up: due times are ideal times,
and do not depend on when the piece before was sent.
"""

from __future__ import annotations

import contextlib
import heapq
import itertools
import select
import selectors
import signal
import socket
import threading
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fatektool.simulator.listen.base import Lines, Listener

_SPIN_S = 0.00012
"""Seconds before a due time at which the thread stops sleeping: a wake-up may be that late."""


class Reactor:
    """Waits for the bytes of all listeners, and delivers each piece of an answer when it is due.

    Args:
        lines: the source of lines for the listeners.
    """

    def __init__(self, lines: Lines) -> None:
        self.lines = lines
        self.selector = selectors.DefaultSelector()
        self.now = time.perf_counter
        self.listeners: list[Listener] = []
        self._due: list[tuple[float, int, Callable[[bytes], None], bytes]] = []
        self._order = itertools.count()
        self._stopping = False
        self._closed = False
        self._wake_up, self._woken = socket.socketpair()
        self._wake_up.settimeout(0)
        self._woken.settimeout(0)
        self.selector.register(self._woken, selectors.EVENT_READ, self._on_wake_up)
        self._wait_s = _precise_wait(self.selector)

    def serve_until(self, stop: Callable[[], bool] = bool) -> None:
        """Serve until ``stop()`` is called, or the predicate returns True.

        The predicate is called only after a wake-up; ``stop`` wakes the thread, a signal the main thread.
        """
        due = self._due
        with self._woken_by_signals():
            while not self._stopping and not stop():
                for key, events in self._ready():
                    key.data(events)
                while due and due[0][0] <= self.now():
                    _, _, deliver, data = heapq.heappop(due)
                    deliver(data)
        self._stopping = False

    @contextlib.contextmanager
    def _woken_by_signals(self) -> Iterator[None]:
        """Let a signal end the wait: on Windows it does not by itself, so Ctrl-C would wait for a client.

        Elsewhere this is for a signal that comes just before the wait begins.
        """
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        before = signal.set_wakeup_fd(self._wake_up.fileno(), warn_on_full_buffer=False)
        try:
            yield
        finally:
            signal.set_wakeup_fd(before)

    def stop(self) -> None:
        """Make ``serve_until`` return; may be called from a signal handler or another thread."""
        self._stopping = True
        with contextlib.suppress(OSError):  # a full buffer wakes it up as well
            self._wake_up.send(b"\0")

    def close(self) -> None:
        """Close all listeners; may be called again."""
        if self._closed:
            return
        self._closed = True
        for listener in self.listeners:
            listener.close()
        self._due.clear()
        self.selector.close()
        self._wake_up.close()
        self._woken.close()

    def dispatch(
        self, due: list[tuple[float, bytes]], deliver: Callable[[bytes], None], *, join: bool = True
    ) -> int:
        """Deliver every piece when it is due; returns the number of deliveries.

        With ``join``, pieces due at the same time are delivered as one: for a stream.
        """
        if not self.lines.powered:
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

    def _lose_power(self) -> None:
        self._due.clear()
        for listener in self.listeners:
            listener.lose_power()

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
    """A wait for bytes or a time, with microseconds if the system has them."""
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
