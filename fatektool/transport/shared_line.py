"""One open line for PLCs that are asked one after the other: a connection a gateway, not one a PLC.

It is kept from one PLC to the next as long as all is in order and nobody else waits for it. After any trouble
it is closed, and the next PLC opens it anew; so no answer that is still on its way is taken for another's.
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
        locks: of the open line; empty for none.
    """

    def __init__(self) -> None:
        self.locks: list[PortLock] = []
        self._target = ""
        self._line: LineSettings | None = None
        self._transport: Transport | None = None
        self._lent: list[LentTransport] = []
        self._stack = ExitStack()

    def take(self, target: str, line: LineSettings, opened: Opener) -> Transport:
        """The line to a target: the one that is open, if it is the same, else another.

        Args:
            target: as the user named it.
            line: speed and format, which may be others than before.
            opened: opens the line, on a stack that closes it, and gives its lock and the line to lend.

        Raises:
            LineError: it cannot be opened, or does not take this speed and format.
        """
        if self._transport is None or self._target != target:
            self.close()
            with ExitStack() as stack:
                self._transport = opened(stack, self.locks.append, self._lent.append)
                self._stack = stack.pop_all()
        else:
            for lock in self.locks:  # who had it before left nothing on its way, or it would be closed
                lock.found_doubt = False
            if line != self._line:
                self._transport.set_line(line)
        self._target, self._line = target, line
        return self._transport

    def between(self) -> None:
        """Nobody of this process needs it now: who waits for it may have it."""
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
