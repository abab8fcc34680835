"""The rounds of a series, however many: figures of all of them, points of some.

A night of ``watch`` is a hundred thousand rounds. Least, most, mean, last, changes and gaps are kept of every
round as it comes; of the points for the charts every second one is dropped, evenly, whenever there are too
many. So memory and report have a bound, and the figures hold none the less.
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
    """One key's values, as far as its rounds have come.

    Attributes:
        part: what the document says of its element: element, type, unit; the last that was said.
        read: in how many rounds it was read.
        failed: in how many it was not.
        least: the smallest number; None without any.
        most: the largest.
        mean: of the numbers; None without any.
        last: the last value that was read.
        changes: how often a value was another than the one before.
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
        """Take a round's value; None for none."""
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
            # By parts: a sum of doubles may be past the largest one.
            self.mean = float(value) if self.mean is None else self.mean + (value / count - self.mean / count)


@dataclass(slots=True)
class Gap:
    """Rounds in a row without a value.

    Attributes:
        key: whose; None for a round of which nothing was read.
        first: the first round's time, UTC, RFC 3339.
        last: the last round's.
        rounds: how many.
        reason: why, of all of them.
    """

    key: str | None
    first: str
    last: str
    rounds: int
    reason: str


@dataclass(frozen=True, slots=True)
class KeptRound:
    """A round that is kept for the charts; ``values`` is empty for one of which nothing was read."""

    time_s: float
    values: Mapping[str, Any]


class Rounds:
    """A series, round by round.

    Args:
        most_points: of so many rounds points are kept.
        most_cells: of so few rounds that their values are no more than this.

    Attributes:
        count: rounds that were read.
        lost: rounds of which nothing was read.
        tracks: by key, in the order in which the keys came.
        gaps: the first ``MOST_GAPS``, in the order of their beginning.
        gaps_in_all: how many there were.
        stride: every so manieth round is kept; 1 for all.
        last: the last document, None without any.
        first_time: when the first round was, read or not; None without any.
        last_time: the same of the last.
        mode_changes: how often RUN and STOP changed.
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
        """Take a round.

        Args:
            document: ``fatektool.snapshot/1``, or ``fatektool.watch/1``, which says nothing of elements.
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
        """Take a round of which nothing was read: when, and why."""
        self._gap(None, time, reason)
        self._keep(time, {})
        self.lost += 1

    def kept(self) -> list[KeptRound]:
        """The rounds of which points are kept, in the order of their times, the newest among them.

        A document's time is to the second. Rounds of one second are put evenly into it.
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
    """True for what a line can show; a discrete is no number."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def seconds(time: str) -> float:
    """RFC 3339 as seconds since 1970.

    Raises:
        ValueError: it is no time, such as the 31st of April.
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
