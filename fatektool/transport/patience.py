"""Retries of a connection that fails: refused, reset, or closed by the other side.

A gateway that serves one connection may need some time until it accepts the next one. Until then it refuses
it, or accepts and closes it ("Port already in use"). Retries without a pause would fail within milliseconds.
So there is a pause before each retry, longer each time::

    time-out 0.5 s     try  0.25 s  try  0.5 s  try  1 s  try     with 3 retries

The number of retries is ``--retries``, as for a request; the pauses are in proportion to ``--timeout``.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final, NamedTuple, TypeVar

from fatektool.callbacks import ignore
from fatektool.errors import TransportClosed
from fatektool.transport.base import WrappedTransport

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.transport.base import Transport

T = TypeVar("T")

_LONGEST_PAUSE_S: Final = 5.0


class Patience(NamedTuple):
    """How often a connection is retried, and the pauses between.

    Attributes:
        timeout_s: the time for the PLC to answer, in seconds.
        retries: retries after the first try.
        pause: waits so many seconds.
        note: gets a message for each pause.
    """

    timeout_s: float = 0.5
    retries: int = 0
    pause: Callable[[float], object] = time.sleep
    note: Callable[[str], None] = ignore

    def pause_s(self, losses: int) -> float:
        """Seconds to wait after so many failures in a row, from 1: half a time-out, then one, then two."""
        return min(self.timeout_s * 2.0 ** min(losses - 2, 1), _LONGEST_PAUSE_S)

    def wait(self, error: TransportClosed, losses: int) -> None:
        """Wait before the next try."""
        seconds = self.pause_s(losses)
        self.note(f"{error.message}; next try in {seconds:g} s")
        self.pause(seconds)

    def opened(self, make: Callable[[], T]) -> T:
        """Make a connection, with retries.

        Args:
            make: makes it, once.

        Raises:
            LineError: as ``make`` does; ``TransportClosed`` when all tries failed.
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


class PatientTransport(WrappedTransport):
    """A medium that replaces a lost connection at the next ``write``, after a pause.

    Failures in a row are those with no successful request between them: a connection that is accepted, sends
    a reason and is closed counts as another failure.

    Args:
        inner: the medium.
        patience: the pauses.
    """

    def __init__(self, inner: Transport, patience: Patience) -> None:
        super().__init__(inner)
        self._patience = patience
        self._losses = 0
        self._lost: TransportClosed | None = None

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read what is received first."""
        try:
            return super().read(max_bytes, timeout_s)
        except TransportClosed as error:
            self._note_loss(error)
            raise

    def write(self, data: bytes) -> None:
        """Write all of ``data``; after a loss, wait first."""
        if self._lost is None:
            self._losses = 0
        else:
            lost, self._lost = self._lost, None
            self._patience.wait(lost, self._losses)
        try:
            super().write(data)
        except TransportClosed as error:
            self._note_loss(error)
            raise

    def _note_loss(self, error: TransportClosed) -> None:
        if error.may_return and self._lost is None:
            self._lost = error
            self._losses += 1
