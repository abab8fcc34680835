"""A time limit for one PLC, over any medium: every exchange ends when the time is over.

It is checked before each write, and at least every quarter of a second in a read. So a thread that talks to a
PLC ends at its limit, or after an interrupt, with a delay of at most one connect or one write.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Final

from fatektool.errors import DeadlinePassed
from fatektool.transport.base import WrappedTransport

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.errors import FatektoolError
    from fatektool.transport.base import Transport

_LOOK_S: Final = 0.25


class Limit:
    """The time that one PLC may take.

    Args:
        seconds: the time, from now on.
        stop: when it is set, the time is over; None if only the clock ends it.
        clock: in seconds; for tests.
    """

    def __init__(
        self,
        seconds: float,
        stop: threading.Event | None = None,
        *,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self.seconds = seconds
        self._clock = clock
        self._end = clock() + seconds
        self._stop = threading.Event() if stop is None else stop

    @property
    def stopped(self) -> bool:
        """True if ``stop`` was set."""
        return self._stop.is_set()

    @property
    def rest_s(self) -> float:
        """Remaining seconds, at least 0."""
        return 0.0 if self._stop.is_set() else max(0.0, self._end - self._clock())

    def pause(self, seconds: float) -> None:
        """Wait so many seconds, or until the time is over."""
        self._stop.wait(min(seconds, self.rest_s))

    def require_rest(self) -> float:
        """Remaining seconds, more than 0.

        Raises:
            DeadlinePassed: none remain.
        """
        rest = self.rest_s
        if not rest:
            raise self.passed()
        return rest

    def passed(self, cause: FatektoolError | None = None) -> DeadlinePassed:
        """The error for a limit that is over.

        Args:
            cause: an error that the end of the time caused, if its message is worth adding.
        """
        seen = "" if cause is None or isinstance(cause, DeadlinePassed) else f" ({cause.message})"
        return DeadlinePassed(
            f"stopped at the time limit of {self.seconds:g} s{seen}",
            hint="if the line is slow or disturbed: 'fatektool doctor'; or allow more time with --deadline",
        )


class LimitedTransport(WrappedTransport):
    """A transport that works until the time is over.

    Args:
        inner: the medium.
        limit: the time.
    """

    def __init__(self, inner: Transport, limit: Limit) -> None:
        super().__init__(inner)
        self._limit = limit

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read, for a quarter of a second at most; the caller checks its clock and calls again."""
        return super().read(max_bytes, min(timeout_s, _LOOK_S, self._limit.require_rest()))

    def write(self, data: bytes) -> None:
        """Write all of ``data``."""
        self._limit.require_rest()
        super().write(data)
