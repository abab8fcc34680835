"""A line that is lent: between two jobs of one process, others may have it.

Who works in rounds (``watch``) keeps its line open while nobody else wants it, so that nothing changes on the
wire: no connection is made anew, no DTR falls. It is closed and its lock given back as soon as somebody waits
for the lock, and in every long pause, as who waits then may know no locks: another computer, the vendor's
program. Two processes never have one port open at once: each would take bytes that the other waits for.
"""

from __future__ import annotations

import time
from contextlib import ExitStack
from math import inf
from typing import TYPE_CHECKING, Final

from fatektool.errors import TransportClosed
from fatektool.transport.base import Transport

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.transport.base import LineSettings
    from fatektool.transport.lock import PortLock

LONG_PAUSE_S: Final = 5.0
_LOOK_S: Final = 0.1
_HAND_OVER_S: Final = 0.01
_HAND_OVER_LOOKS: Final = 100


class LentTransport(Transport):
    """A medium that can be given back and taken again.

    Args:
        opened: opens it and locks it, waiting so long; the stack closes both, and the callback gets the lock.
        wait_s: how long to wait for another process at first; later on, as long as it takes.
        on_lock: is given the lock, each time that it is taken.

    Raises:
        LineError: it cannot be opened.
    """

    def __init__(
        self,
        opened: Callable[[ExitStack, float, Callable[[PortLock], object]], Transport],
        wait_s: float,
        on_lock: Callable[[PortLock], object],
    ) -> None:
        self.on_lock = on_lock
        self._opened = opened
        self._settings: LineSettings | None = None
        self._lock: PortLock | None = None
        self._inner: Transport | None = None
        self._stopped_at: float | None = None  # a simulated PLC's clock begins anew with it
        self._clock_offset = 0.0
        self._stack = ExitStack()
        self._open(wait_s)
        self.clock = self._now

    def take(self) -> None:
        """Have the line, however long it takes until others let it go.

        Raises:
            LineError: it cannot be opened.
        """
        if self._inner is None:
            self._open(inf)

    def give_back(self) -> None:
        """Close the line and let others have it."""
        if self._inner is not None:
            self._stopped_at = self._now()
            self._inner = self._lock = None
            self._stack.close()

    def lend(self, seconds: float, sleep: Callable[[float], object] | None = None) -> None:
        """Wait, and let others have the line meanwhile if they want it; ``take`` it again behind this.

        Args:
            seconds: how long to wait.
            sleep: waits; it may raise to end the waiting. None for ``time.sleep``.
        """
        sleep = sleep or time.sleep
        if seconds >= LONG_PAUSE_S:
            self.give_back()
        while True:
            if self._lock is not None and self._lock.wanted():
                self._hand_over(self._lock)
            if seconds <= 0:
                return
            step = seconds if self._lock is None else min(seconds, _LOOK_S)
            sleep(step)
            seconds -= step

    def _hand_over(self, lock: PortLock) -> None:
        """Let go, and give who waits the time to take it."""
        self.give_back()
        for _ in range(_HAND_OVER_LOOKS):
            if not lock.wanted():
                return
            time.sleep(_HAND_OVER_S)

    def _open(self, wait_s: float) -> None:
        with ExitStack() as stack:
            inner = self._opened(stack, wait_s, self._locked)
            if self._settings is not None:
                inner.set_line(self._settings)
            self._stack = stack.pop_all()
        if self._stopped_at is not None:
            self._clock_offset = self._stopped_at - inner.clock()
        self._inner, self.name, self.line = inner, inner.name, inner.line

    def _locked(self, lock: PortLock) -> None:
        self._lock = lock
        self.on_lock(lock)

    def _now(self) -> float:
        if self._inner is None:
            return self._stopped_at or 0.0
        return self._clock_offset + self._inner.clock()

    def _medium(self) -> Transport:
        if self._inner is None:
            raise TransportClosed(f"{self.name}: the line is given back")
        return self._inner

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read what is there first."""
        return self._medium().read(max_bytes, timeout_s)

    def write(self, data: bytes) -> None:
        """Write all of it."""
        self._medium().write(data)

    def drain(self) -> bytes:
        """Take what is there."""
        return b"" if self._inner is None else self._inner.drain()

    def set_line(self, line: LineSettings) -> None:
        """Take another speed and format, the next time too."""
        self._medium().set_line(line)
        self._settings, self.line = line, self._medium().line

    def set_dtr(self, *, on: bool) -> bool:
        """Switch DTR."""
        return self._medium().set_dtr(on=on)

    def renew(self) -> None:
        """Start afresh."""
        if self._inner is not None:
            self._inner.renew()

    def close(self) -> None:
        """Close the medium and give its lock back."""
        self.give_back()
