"""The rounds of a series, of any length: numbers of all of them, points of some.

A night of ``watch`` has a hundred thousand rounds. Minimum, maximum, mean, last value, changes and gaps
include every round. Of the points for the charts, every second one is dropped when there are too many. So
memory and report are limited, and the numbers are still right.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

MOST_POINTS: Final = 2000
MOST_CELLS: Final = 400_000
MOST_GAPS: Final = 100
_LEAST_POINTS: Final = 2


@dataclass(slots=True)
class Track:
    """The values of one key so far.

    Attributes:
        part: element, type and unit in the last document.
        read: the number of rounds in which it was read.
        failed: the number of rounds in which it was not.
        least: the smallest number; None if there is none.
        most: the largest.
        mean: of the numbers; None if there is none.
        last: the last value that was read.
        changes: the number of values that differ from the one before.
    """

    part: Mapping[str, Any] = field(default_factory=dict)
    read: int = 0
    failed: int = 0
    least: float | None = None
    most: float | None = None
    mean: float | None = None
    last: Any = None
    changes: int = 0
    _numbers: int = 0

    def add(self, value: Any) -> None:
        """Add the value of a round; None for none."""
        if value is None:
            self.failed += 1
            return
        self.changes += self.read > 0 and value != self.last
        self.last = value
        self.read += 1
        if is_number(value):
            self._numbers += 1
            count = self._numbers
            self.least = value if self.least is None else min(self.least, value)
            self.most = value if self.most is None else max(self.most, value)
            # By parts: a sum of doubles may be larger than the largest double.
            self.mean = float(value) if self.mean is None else self.mean + (value / count - self.mean / count)


@dataclass(slots=True)
class Gap:
    """Rounds in a row without a value.

    Attributes:
        key: of the value; None for rounds of which nothing was read.
        first: time of the first round, UTC, RFC 3339.
        last: time of the last round.
        rounds: their number.
        reason: the same for all of them.
    """

    key: str | None
    first: str
    last: str
    rounds: int
    reason: str


@dataclass(frozen=True, slots=True)
class KeptRound:
    """A round that is kept for the charts; ``values`` is empty if nothing was read."""

    time_s: float
    values: Mapping[str, Any]


class Rounds:
    """A series, round by round.

    Args:
        most_points: the most rounds whose points are kept.
        most_cells: the most values of these rounds.

    Attributes:
        count: rounds that were read.
        lost: rounds of which nothing was read.
        tracks: by key, in the order in which the keys occurred first.
        gaps: the first ``MOST_GAPS``, by their beginning.
        gaps_in_all: their total number.
        stride: one of ``stride`` rounds is kept; 1 for all.
        last: the last document; None if there is none.
        first_time: the time of the first round, read or not; None if there is none.
        last_time: the same of the last.
        mode_changes: the number of changes between RUN and STOP.
    """

    def __init__(self, *, most_points: int = MOST_POINTS, most_cells: int = MOST_CELLS) -> None:
        self.count = self.lost = 0
        self.tracks: dict[str, Track] = {}
        self.gaps: list[Gap] = []
        self.gaps_in_all = 0
        self.stride = 1
        self.last: Mapping[str, Any] | None = None
        self.first_time: str | None = None
        self.last_time: str | None = None
        self.mode_changes = 0
        self._most_points, self._most_cells = most_points, most_cells
        self._kept: list[KeptRound] = []
        self._cells = 0
        self._newest: KeptRound | None = None
        self._open: dict[str | None, Gap] = {}

    def add(self, document: Mapping[str, Any]) -> None:
        """Add a round.

        Args:
            document: ``fatektool.snapshot/1``, or ``fatektool.watch/1``, which has no data of elements.
        """
        time, values, errors = document["time"], document["values"], document["errors"]
        self._open.pop(None, None)
        for key, value in values.items():
            track = self.tracks.setdefault(key, Track())
            track.add(value)
            track.part = document.get("elements", {}).get(key, track.part)
            if value is None:
                self._gap(key, time, errors.get(key, "no value"))
            else:
                self._open.pop(key, None)
        if self.last is not None:
            self.mode_changes += self.last["running"] != document["running"]
        self.last = document
        self._keep(time, values)
        self.count += 1

    def fail(self, time: str, reason: str) -> None:
        """Add a round of which nothing was read, with time and reason."""
        self._gap(None, time, reason)
        self._keep(time, {})
        self.lost += 1

    def kept(self) -> list[KeptRound]:
        """The rounds of which points are kept, in the order of their times, the newest among them.

        The time of a document has whole seconds. Rounds within one second are distributed evenly over it.
        """
        rounds = list(self._kept)
        if self._newest is not None and (not rounds or rounds[-1] is not self._newest):
            rounds.append(self._newest)
        rounds.sort(key=lambda each: each.time_s)
        return list(_spread(rounds))

    def _keep(self, time: str, values: Mapping[str, Any]) -> None:
        self.first_time = self.first_time or time
        self.last_time = time
        self._newest = KeptRound(seconds(time), values)
        if (self.count + self.lost) % self.stride == 0:
            self._kept.append(self._newest)
            self._cells += len(values)
        while self._too_many():
            self._kept = self._kept[::2]
            self._cells = sum(len(each.values) for each in self._kept)
            self.stride *= 2

    def _too_many(self) -> bool:
        count = len(self._kept)
        return count > self._most_points or (count > _LEAST_POINTS and self._cells > self._most_cells)

    def _gap(self, key: str | None, time: str, reason: str) -> None:
        gap = self._open.get(key)
        if gap is not None and gap.reason == reason:
            gap.last = time
            gap.rounds += 1
            return
        gap = self._open[key] = Gap(key, time, time, 1, reason)
        self.gaps_in_all += 1
        if len(self.gaps) < MOST_GAPS:
            self.gaps.append(gap)


def is_number(value: Any) -> bool:
    """True for a value that a line chart can show; a discrete is not a number."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def seconds(time: str) -> float:
    """RFC 3339 as seconds since 1970.

    Raises:
        ValueError: it is not a time, such as the 31st of April.
    """
    return datetime.fromisoformat(time).timestamp()


def _spread(rounds: list[KeptRound]) -> Iterable[KeptRound]:
    start = 0
    while start < len(rounds):
        time_s = rounds[start].time_s
        end = start
        while end < len(rounds) and rounds[end].time_s == time_s:
            end += 1
        for number in range(start, end):
            yield KeptRound(time_s + (number - start) / (end - start), rounds[number].values)
        start = end
