"""Trying again where the connection itself fails: refused, reset, or closed by the other side.

A gateway that serves one connection may free it only some time after it was closed, and refuses the next one
until then, or takes it and closes it ("Port already in use"). Tries without a pause are over in milliseconds.
So before each try on a connection that failed there is a pause, longer each time::

    time-out 0.5 s     try  0.25 s  try  0.5 s  try  1 s  try     with 3 retries

The number of tries is that of the exchange, ``--retries``; the pauses are in proportion to ``--timeout``.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final, NamedTuple, TypeVar

from fatektool.callbacks import ignore
from fatektool.errors import TransportClosed
from fatektool.transport.base import Transport

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.transport.base import LineSettings

T = TypeVar("T")

_LONGEST_PAUSE_S: Final = 5.0


class Patience(NamedTuple):
    """How often a connection is tried, and how long between.

    Attributes:
        timeout_s: the PLC's time to answer.
        retries: further tries.
        pause: waits so many seconds.
        note: is told of each pause.
    """

    timeout_s: float = 0.5
    retries: int = 0
    pause: Callable[[float], object] = time.sleep
    note: Callable[[str], None] = ignore

    def pause_s(self, losses: int) -> float:
        """How long to wait after so many failures in a row, from 1: half a time-out, one, two at most."""
        return min(self.timeout_s * 2.0 ** min(losses - 2, 1), _LONGEST_PAUSE_S)

    def wait(self, error: TransportClosed, losses: int) -> None:
        """Wait before the next try."""
        seconds = self.pause_s(losses)
        self.note(f"{error.message}; tried again in {seconds:g} s")
        self.pause(seconds)

    def opened(self, make: Callable[[], T]) -> T:
        """Make a connection, as often as it takes and is allowed.

        Args:
            make: one try.

        Raises:
            LineError: as ``make`` does; ``TransportClosed`` when all tries were in vain.
        """
        for losses in range(1, self.retries + 1):
            try:
                return make()
            except TransportClosed as error:
                if not error.may_return:
                    raise
                self.wait(error, losses)
        try:
            return make()
        except TransportClosed as error:
            if not error.may_return or not self.retries:
                raise
            raise TransportClosed(
                f"{error.message}, in {self.retries + 1} tries", hint=error.hint, may_return=True
            ) from error


class PatientTransport(Transport):
    """A medium that makes a lost connection anew at the next ``write``, after a pause.

    Failures in a row are those with no answer between them: a connection that says why it closes, and closes,
    is one failure more.

    Args:
        inner: the medium.
        patience: how long the pauses are.
    """

    def __init__(self, inner: Transport, patience: Patience) -> None:
        self._inner = inner
        self._patience = patience
        self._losses = 0
        self._lost: TransportClosed | None = None
        self.name = inner.name
        self.line = inner.line
        self.clock = inner.clock

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read what is there first."""
        try:
            return self._inner.read(max_bytes, timeout_s)
        except TransportClosed as error:
            self._note_loss(error)
            raise

    def write(self, data: bytes) -> None:
        """Write all of it; after a loss, wait first."""
        if self._lost is None:
            self._losses = 0
        else:
            lost, self._lost = self._lost, None
            self._patience.wait(lost, self._losses)
        try:
            self._inner.write(data)
        except TransportClosed as error:
            self._note_loss(error)
            raise

    def _note_loss(self, error: TransportClosed) -> None:
        if error.may_return and self._lost is None:
            self._lost = error
            self._losses += 1

    def drain(self) -> bytes:
        """Take what is there."""
        return self._inner.drain()

    def set_line(self, line: LineSettings) -> None:
        """Take another speed and format."""
        self._inner.set_line(line)
        self.line = self._inner.line

    def set_dtr(self, *, on: bool) -> bool:
        """Switch DTR."""
        return self._inner.set_dtr(on=on)

    def renew(self) -> None:
        """Start afresh."""
        self._inner.renew()

    def close(self) -> None:
        """Close the medium."""
        self._inner.close()
