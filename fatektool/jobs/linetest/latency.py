"""How long exchanges took, counted into buckets: after millions of them the memory is what it was after some.

A bucket is 2^(1/128) wide, half a per cent, so that a percentile is as good as the clock. Minimum, maximum
and mean are exact, and no percentile is outside of them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import ceil, floor, inf, log2
from typing import Final

PERCENTILES: Final = {"p50": 0.5, "p90": 0.9, "p99": 0.99, "p999": 0.999}
_PER_OCTAVE: Final = 128
_LEAST_S: Final = 1e-7
_MOST_BARS: Final = 20


@dataclass(frozen=True, slots=True)
class HistogramBar:
    """How many times were in ``from_s <= time < to_s``, in seconds."""

    from_s: float
    to_s: float
    count: int


@dataclass(slots=True)
class Times:
    """Times in seconds, from 0 up.

    Attributes:
        count: how many.
        least_s: the shortest.
        most_s: the longest.
        sum_s: all together.
    """

    count: int = 0
    least_s: float = inf
    most_s: float = 0.0
    sum_s: float = 0.0
    _buckets: dict[int, int] = field(default_factory=dict)

    def add(self, time_s: float) -> None:
        """Count one time; one below 0 counts as 0."""
        time_s = max(0.0, time_s)
        self.count += 1
        self.sum_s += time_s
        self.least_s = min(self.least_s, time_s)
        self.most_s = max(self.most_s, time_s)
        bucket = floor(log2(max(time_s, _LEAST_S)) * _PER_OCTAVE)
        self._buckets[bucket] = self._buckets.get(bucket, 0) + 1

    def percentile(self, share: float) -> float:
        """The time that this share of all, 0 to 1, does not pass; nearest rank.

        Raises:
            ValueError: there are none.
        """
        if not self.count:
            raise ValueError("no times")
        rank = max(1, ceil(share * self.count))
        for bucket in sorted(self._buckets):
            rank -= self._buckets[bucket]
            if rank <= 0:
                middle = 2 ** ((bucket + 0.5) / _PER_OCTAVE)
                return min(max(middle, self.least_s), self.most_s)
        raise AssertionError("buckets hold fewer than were counted")

    def summary_ms(self) -> dict[str, float | None]:
        """``min``, the percentiles, ``max`` and ``mean`` in milliseconds; null where there was nothing."""
        if not self.count:
            return dict.fromkeys(("min", *PERCENTILES, "max", "mean"))
        values = {
            "min": self.least_s,
            **{name: self.percentile(share) for name, share in PERCENTILES.items()},
            "max": self.most_s,
            "mean": self.sum_s / self.count,
        }
        return {name: round(value * 1000, 3) for name, value in values.items()}

    def bars(self) -> list[HistogramBar]:
        """At most 20 bars of equal ratio from the shortest to the longest, empty ones in between included."""
        if not self.count:
            return []
        first, last = min(self._buckets), max(self._buckets)
        width = -(-(last - first + 1) // _MOST_BARS)
        counts = [0] * (-(-(last - first + 1) // width))
        for bucket, count in self._buckets.items():
            counts[(bucket - first) // width] += count
        edges = [2 ** ((first + place * width) / _PER_OCTAVE) for place in range(len(counts) + 1)]
        return [HistogramBar(edges[place], edges[place + 1], count) for place, count in enumerate(counts)]
