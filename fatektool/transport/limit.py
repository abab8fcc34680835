"""An overall limit of time for one PLC, over any medium: whatever is asked on it ends when that runs out.

Looked at before each write and at least every quarter of a second of a read. So no thread that talks to a PLC
outlives its limit, or an interrupt, by more than it takes to connect or to write.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Final

from fatektool.errors import DeadlinePassed
from fatektool.transport.base import Transport

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.errors import FatektoolError
    from fatektool.transport.base import LineSettings

_LOOK_S: Final = 0.25


class Limit:
    """How long one PLC may take.

    Args:
        seconds: from now on.
        stop: set from anywhere, it ends the PLC's turn early; None for nobody who would.
        clock: seconds; for tests.
    """

    def __init__(
        self,
        seconds: float,
        stop: threading.Event | None = None,
        *,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.seconds = seconds
        self._clock = clock
        self._end = clock() + seconds
        self._stop = threading.Event() if stop is None else stop

    @property
    def stopped(self) -> bool:
        """True if it was ended early."""
        return self._stop.is_set()

    @property
    def rest_s(self) -> float:
        """What is left, at least 0."""
        return 0.0 if self._stop.is_set() else max(0.0, self._end - self._clock())

    def pause(self, seconds: float) -> None:
        """Wait so many seconds, or until it is over."""
        self._stop.wait(min(seconds, self.rest_s))

    def require_rest(self) -> float:
        """What is left, in seconds.

        Raises:
            DeadlinePassed: nothing.
        """
        rest = self.rest_s
        if not rest:
            raise self.passed()
        return rest

    def passed(self, cause: FatektoolError | None = None) -> DeadlinePassed:
        """The error of a limit that is over.

        Args:
            cause: what came of it, if that tells more.
        """
        seen = "" if cause is None or isinstance(cause, DeadlinePassed) else f" ({cause.message})"
        return DeadlinePassed(
            f"given up, its limit of {self.seconds:g} s is over{seen}",
            hint="is the line slow or bad? see 'fatektool doctor', or give it more with --deadline",
        )


class LimitedTransport(Transport):
    """A transport that works as long as the limit lasts.

    Args:
        inner: the medium.
        limit: the limit.
    """

    def __init__(self, inner: Transport, limit: Limit) -> None:
        self._inner = inner
        self._limit = limit
        self.name = inner.name
        self.line = inner.line
        self.clock = inner.clock

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read, for a quarter of a second at most; the caller looks at its clock and comes again."""
        return self._inner.read(max_bytes, min(timeout_s, _LOOK_S, self._limit.require_rest()))

    def write(self, data: bytes) -> None:
        """Write all of it."""
        self._limit.require_rest()
        self._inner.write(data)

    def drain(self) -> bytes:
        """Take what is there."""
        return self._inner.drain()

    def set_line(self, line: LineSettings) -> None:
        """Take another speed and format."""
        self._inner.set_line(line)
        self.line = self._inner.line

    def renew(self) -> None:
        """Start afresh."""
        self._inner.renew()

    def close(self) -> None:
        """Close the medium."""
        self._inner.close()
