"""A line that other processes may use between two rounds of this one.

A process that works in rounds (``watch``) keeps its line open while nobody waits for it: no new connection,
no change of DTR. It closes the line and releases its lock as soon as another process waits for the lock, and
in every long pause, because another computer or the vendor's program does not know the lock. Two processes
never have one port open at the same time: each would receive bytes for the other.
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
    """A medium that can be released and opened again.

    Args:
        opened: locks and opens it, waiting so many seconds; the stack closes both, and the callback gets the
            lock.
        wait_s: seconds to wait for another process at first; later there is no limit.
        on_lock: gets the lock, each time that it is locked.

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
        self._stopped_at: float | None = None  # the clock of a simulated PLC starts again at 0
        self._clock_offset = 0.0
        self._stack = ExitStack()
        self._open(wait_s)
        self.clock = self._now

    def take(self) -> None:
        """Open the line again, however long another process has it.

        Raises:
            LineError: it cannot be opened.
        """
        if self._inner is None:
            self._open(inf)

    def give_back(self) -> None:
        """Close the line and release its lock."""
        if self._inner is not None:
            self._stopped_at = self._now()
            self._inner = self._lock = None
            self._stack.close()

    def lend(self, seconds: float, sleep: Callable[[float], object] | None = None) -> None:
        """Wait, and release the line if another process waits for it; call ``take`` after it.

        Args:
            seconds: how long to wait.
            sleep: waits so many seconds; it may raise to end the wait. None for ``time.sleep``.
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
        """Release the line, and give the waiting process time to lock it."""
        self.give_back()
        for _ in range(_HAND_OVER_LOOKS):
            if not lock.wanted():
                return
            time.sleep(_HAND_OVER_S)

    def _open(self, wait_s: float) -> None:
        with ExitStack() as stack:
            inner = self._opened(stack, wait_s, self._locked)
            if self._settings is not None:
                inner.configure(self._settings)
            self._stack = stack.pop_all()
        if self._stopped_at is not None:
            self._clock_offset = self._stopped_at - inner.clock()
        self._inner, self.name, self.serial_settings = inner, inner.name, inner.serial_settings

    def _locked(self, lock: PortLock) -> None:
        self._lock = lock
        self.on_lock(lock)

    def _now(self) -> float:
        if self._inner is None:
            return self._stopped_at or 0.0
        return self._clock_offset + self._inner.clock()

    def _medium(self) -> Transport:
        if self._inner is None:
            raise TransportClosed(f"{self.name}: the line was released")
        return self._inner

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read what is received first."""
        return self._medium().read(max_bytes, timeout_s)

    def write(self, data: bytes) -> None:
        """Write all of ``data``."""
        self._medium().write(data)

    def drain(self) -> bytes:
        """Return what was received already."""
        return b"" if self._inner is None else self._inner.drain()

    def configure(self, settings: LineSettings) -> None:
        """Set speed and format, also for the next time that it is opened."""
        self._medium().configure(settings)
        self._settings, self.serial_settings = settings, self._medium().serial_settings

    def set_dtr(self, *, on: bool) -> bool:
        """Switch DTR."""
        return self._medium().set_dtr(on=on)

    def renew(self) -> None:
        """Close a connection; the next write makes a new one."""
        if self._inner is not None:
            self._inner.renew()

    def close(self) -> None:
        """Close the medium and release its lock."""
        self.give_back()
