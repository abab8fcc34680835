"""Rounds in a thread of their own, so that keys are heard while the line is slow or lost."""

from __future__ import annotations

import threading
import time
from collections import deque
from typing import TYPE_CHECKING, Final

from fatektool.cli.programs.monitor.frame import News
from fatektool.cli.programs.monitor.words import program_words
from fatektool.cli.shared.rounds import paced_rounds

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType
    from typing import Self

    from fatektool.cli.shared.rounds import RoundTimes
    from fatektool.client import Plc
    from fatektool.errors import LineError
    from fatektool.jobs.monitor.live import Monitor
    from fatektool.jobs.monitor.rounds import Round

_TIMED: Final = 12


class _Stopped(Exception):
    """Nobody wants rounds any more."""


class Reading:
    """Reads rounds until it is told to stop; for a ``with`` statement.

    Args:
        plc: the PLC; nobody else uses it meanwhile.
        monitor: what is read.
        pace: how often, and how many.
        on_news: is called after each round, and when all is over; from the thread.
        clock: seconds.
        wait: waits so many seconds; true to end the rounds. None to wait until then or the end of ``with``.

    Attributes:
        last: the last round; None if there is none.
        lost: the error of the last round that failed; None if the last one did not.
        lost_since: when the first of the rounds failed that have failed since.
        is_over: no further round comes.
        error: why; None if all rounds that were asked for are done.
    """

    def __init__(
        self,
        plc: Plc,
        monitor: Monitor,
        pace: RoundTimes,
        on_news: Callable[[], object],
        *,
        clock: Callable[[], float] = time.perf_counter,
        wait: Callable[[float], object] | None = None,
    ) -> None:
        self._plc, self._monitor, self._pace, self._on_news = plc, monitor, pace, on_news
        self._stop = threading.Event()
        self._clock, self._wait = clock, wait or self._stop.wait
        self._ended: deque[float] = deque(maxlen=_TIMED)
        self._thread = threading.Thread(target=self.run, name="rounds", daemon=True)
        self.last: Round | None = None
        self.lost: LineError | None = None
        self.lost_since = ""
        self.is_over = False
        self.error: BaseException | None = None

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        self._thread.join()

    @property
    def rate(self) -> float:
        """Rounds a second, over the last ones."""
        ended = list(self._ended)
        spent = ended[-1] - ended[0] if len(ended) > 1 else 0.0
        return (len(ended) - 1) / spent if spent else 0.0

    @property
    def news(self) -> News:
        """What the screen shows; of a line that is lost no states."""
        program = self._monitor.program
        words = "" if program.is_certain or self.last is None else program_words(program)
        lost = self.lost
        if lost is not None:
            return News(
                None, lost=f"LINE LOST since {self.lost_since}: {lost.message}; trying again", program=words
            )
        return News(self.last, self.rate, program=words)

    def run(self) -> None:
        """Read rounds until the end; errors are kept."""
        try:
            rounds = paced_rounds(
                self._plc,
                self._read,
                self._pace,
                failed=self._failed,
                voice=None,
                sleep=self._sleep,
                clock=self._clock,
            )
            for found in rounds:
                self._ended.append(self._clock())
                self.last, self.lost = found, None
                self._on_news()
        except _Stopped:
            pass
        except BaseException as error:  # noqa: BLE001  # who waits for rounds raises it
            self.error = error
        self.is_over = True
        self._on_news()

    def _read(self) -> Round:
        self._end_if_stopped()
        return self._monitor.read()

    def _failed(self, error: LineError) -> None:
        """Say so, and go on; but for the first round of all, which shows that nothing is right yet.

        Raises:
            LineError: it was the first.
            _Stopped: this was the last.
        """
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
            raise _Stopped
