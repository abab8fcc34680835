"""Rounds in a thread of their own, so that keys are heard while the line is slow or lost."""

from __future__ import annotations

import threading
import time
from collections import deque
from contextlib import suppress
from typing import TYPE_CHECKING, Final, Generic, TypeVar

from fatektool.cli.shared.rounds import RoundTimes, paced_rounds

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType
    from typing import Self

    from fatektool.client import Plc
    from fatektool.errors import LineError

T = TypeVar("T")
_TIMED: Final = 12
_PAUSED_S: Final = 0.1
_LEAVE_S: Final = 0.5


class _Stopped(Exception):
    """Nobody wants rounds any more."""


class _Now(Exception):
    """Something is to be done before the next round is due."""


class Reading(Generic[T]):
    """Reads rounds until it is told to stop; for a ``with`` statement.

    Args:
        plc: the PLC; nobody else uses it meanwhile.
        read: reads one round.
        pace: how often, and how many.
        on_news: is called after each round, and when all is over; from the thread.
        failed: is called for each round that failed; from the thread.
        clock: seconds.
        wait: waits so many seconds; true if it was interrupted. None to wait until then, ``stop`` or ``do``.

    Attributes:
        last: the last round; None if there is none.
        lost: the error of the last round that failed; None if the last one did not.
        lost_since: when the first of the rounds failed that have failed since.
        is_paused: no rounds are read; others may use the line.
        is_over: no further round comes.
        error: why; None if all rounds that were asked for are done.
    """

    def __init__(
        self,
        plc: Plc,
        read: Callable[[], T],
        pace: RoundTimes,
        on_news: Callable[[], object],
        *,
        failed: Callable[[LineError], object] = lambda _: None,
        clock: Callable[[], float] = time.perf_counter,
        wait: Callable[[float], object] | None = None,
    ) -> None:
        self._plc, self._read_round, self._pace = plc, read, pace
        self._on_news, self._on_failure = on_news, failed
        self._stop, self._asked = threading.Event(), threading.Event()
        self._clock, self._wait = clock, wait or self._asked.wait
        self._jobs: deque[Callable[[], object]] = deque()
        self._ended: deque[float] = deque(maxlen=_TIMED)
        self._done = 0
        self._is_in_round = False
        self._thread = threading.Thread(target=self.run, name="rounds", daemon=True)
        self.last: T | None = None
        self.lost: LineError | None = None
        self.lost_since = ""
        self.is_paused = False
        self.is_over = False
        self.error: BaseException | None = None

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Wait for the round on its way, but not for a line that another process uses."""
        self.stop()
        self._thread.join(_LEAVE_S)
        while self._thread.is_alive() and self._is_in_round:
            self._thread.join(_LEAVE_S)

    @property
    def rate(self) -> float:
        """Rounds a second, over the last ones."""
        ended = list(self._ended)
        spent = ended[-1] - ended[0] if len(ended) > 1 else 0.0
        return (len(ended) - 1) / spent if spent else 0.0

    def stop(self) -> None:
        """Read no further round."""
        self._stop.set()
        self._asked.set()

    def pause(self, *, on: bool) -> None:
        """Read no rounds for a while, or read them again."""
        self.is_paused = on
        self._ended.clear()
        self._asked.set()

    def do(self, job: Callable[[], object]) -> None:
        """Have something done on the line, at once or after the round that is being read; in the thread."""
        self._jobs.append(job)
        self._asked.set()

    def run(self) -> None:
        """Read rounds until the end; errors are kept."""
        try:
            while True:
                with suppress(_Now):
                    self._rounds()
        except _Stopped:
            pass
        except BaseException as error:  # noqa: BLE001  # who waits for rounds raises it
            self.error = error
        self.is_over = True
        self._on_news()

    def _rounds(self) -> None:
        """Rounds up to the last one, or until something else is to be done.

        Raises:
            _Stopped: that was the last one.
            _Now: something is to be done.
        """
        endless = RoundTimes(self._pace.interval_s)
        for found in paced_rounds(
            self._plc,
            self._read,
            endless,
            failed=self._failed,
            voice=None,
            sleep=self._sleep,
            clock=self._clock,
        ):
            if found is None:
                continue
            self._ended.append(self._clock())
            self._done += 1
            self.last, self.lost = found, None
            self._on_news()
            if self._done == self._pace.count:
                raise _Stopped

    def _read(self) -> T | None:
        """One round; None while there is a pause."""
        self._is_in_round = True
        try:
            return self._asked_for()
        finally:
            self._is_in_round = False

    def _asked_for(self) -> T | None:
        self._asked.clear()
        self._end_if_stopped()
        while self._jobs:
            self._jobs.popleft()()
            self._on_news()
        if self.is_paused:
            self._sleep(_PAUSED_S)
            return None
        return self._read_round()

    def _failed(self, error: LineError) -> None:
        """Say so, and go on; but for the first round of all, which shows that nothing is right yet.

        Raises:
            LineError: it was the first.
            _Stopped: this was the last.
        """
        self._on_failure(error)
        if self.last is None:
            raise error
        if self.lost is None:
            self.lost_since = time.strftime("%H:%M:%S")
        self.lost = error
        self._ended.clear()
        self._on_news()
        self._end_if_stopped()

    def _end_if_stopped(self) -> None:
        """There may be no pause between two rounds, and none of them may come to its reading."""
        if self._stop.is_set():
            raise _Stopped

    def _sleep(self, seconds: float) -> None:
        if self._wait(seconds):
            raise _Stopped if self._stop.is_set() else _Now


def lost_words(reading: Reading[T]) -> str:
    """One line of a line that is lost; empty if it is not."""
    lost = reading.lost
    return "" if lost is None else f"LINE LOST since {reading.lost_since}: {lost.message}; trying again"
