"""One open line for several PLCs, one after the other: one connection for each gateway, not for each PLC.

It stays open from one PLC to the next, unless there was an error or another process waits for it. After an
error it is closed, and the next PLC opens it again, so that a late answer is not received for another PLC.
"""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType
    from typing import Self

    from fatektool.transport.base import LineSettings, Transport
    from fatektool.transport.lent import LentTransport
    from fatektool.transport.lock import PortLock

    Opener = Callable[[ExitStack, Callable[[PortLock], object], Callable[[LentTransport], object]], Transport]


class SharedLine:
    """A line that stays open between two PLCs on it.

    Attributes:
        locks: those of the open line; empty if none is open.
    """

    def __init__(self) -> None:
        self.locks: list[PortLock] = []
        self._target = ""
        self._settings: LineSettings | None = None
        self._transport: Transport | None = None
        self._lent: list[LentTransport] = []
        self._stack = ExitStack()

    def take(self, target: str, settings: LineSettings, opened: Opener) -> Transport:
        """The line to a target: the open one, if it has this target, else a new one.

        Args:
            target: as the user wrote it.
            settings: speed and format, which may differ from those before.
            opened: opens the line on a stack that closes it; the callbacks get its lock and the line itself,
                if it can be released between two rounds.

        Raises:
            LineError: it cannot be opened, or does not have this speed and format.
        """
        if self._transport is None or self._target != target:
            self.close()
            with ExitStack() as stack:
                self._transport = opened(stack, self.locks.append, self._lent.append)
                self._stack = stack.pop_all()
        else:
            for lock in self.locks:  # no answer is late on it, or it would have been closed
                lock.found_doubt = False
            if settings != self._settings:
                self._transport.configure(settings)
        self._target, self._settings = target, settings
        return self._transport

    def between(self) -> None:
        """Between two PLCs: release the line if another process waits for it."""
        if any(lock.wanted() for lock in self.locks):
            for lent in self._lent:
                lent.lend(0)
            self.close()

    def close(self) -> None:
        """Close the line; the next ``take`` opens one."""
        self._transport = None
        self._stack.close()
        self.locks.clear()
        self._lent.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
