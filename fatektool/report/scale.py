"""Scales of charts: the place of a value, round numbers for the ticks, times of day.

Values may be any double, so differences are computed with halves: a difference may be larger than the largest
double.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Sequence

_SMALLEST: Final = 1e-290
_LARGEST: Final = sys.float_info.max
_STEPS: Final = (1.0, 2.0, 5.0, 10.0)
_PLAIN: Final = 1e8
_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)
_DAY: Final = 86400
_TIME_STEPS: Final = (
    *(1, 2, 5, 10, 15, 30),
    *(60 * minutes for minutes in (1, 2, 5, 10, 15, 30)),
    *(3600 * hours for hours in (1, 2, 3, 6, 12)),
    *(_DAY * days for days in (1, 2, 7, 14, 30, 90, 180, 365)),
)


@dataclass(frozen=True, slots=True)
class Scale:
    """Values from ``low`` to ``high`` on a line from ``start`` to ``end``."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: float) -> float:
        """The place of a value."""
        half = self.high / 2 - self.low / 2
        share = (value / 2 - self.low / 2) / half if half > 0 else 0.5
        return self.start + (self.end - self.start) * share


def ends(values: Sequence[float], *, zero: bool = False) -> tuple[float, float]:
    """The ends of a scale for these values, at least one; they are never equal.

    Args:
        values: finite numbers.
        zero: the scale begins at zero.
    """
    low, high = min(values), max(values)
    if zero:
        low = min(low, 0.0)
    if high / 2 - low / 2 < _SMALLEST:
        space = max(1.0, abs(low) / 10)
        return (0.0, 1.0) if zero else (max(low - space, -_LARGEST), min(high + space, _LARGEST))
    return low, high


def ticks(low: float, high: float, most: int = 5) -> list[float]:
    """Round numbers between two ends, about ``most``; the ends themselves if there are none."""
    rough = (high / 2 - low / 2) / most * 2
    if not _SMALLEST < rough < math.inf:
        return [low, high]
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * each for each in _STEPS if power * each >= rough * 0.999 or each == _STEPS[-1])
    first, last = math.ceil(low / step), math.floor(high / step)
    found = [number * step for number in range(first, last + 1)]
    return [each for each in found if low <= each <= high] or [low, high]


def labels(values: Sequence[float]) -> list[str]:
    """Numbers as text, with as many digits as are needed to distinguish them."""
    for digits in range(3, 18):
        shown = [_plain(value, digits) for value in values]
        if len(set(shown)) == len(set(values)) and all(
            math.isclose(float(text), value, rel_tol=1e-9, abs_tol=1e-300)
            for text, value in zip(shown, values, strict=True)
        ):
            return shown
    return [f"{value:.17g}" for value in values]


def _plain(value: float, digits: int) -> str:
    text = f"{value + 0.0:.{digits}g}"  # + 0.0 makes 0 of -0
    return f"{value:.0f}" if "e+" in text and abs(value) < _PLAIN else text


def time_ticks(first_s: float, last_s: float, most: int = 5) -> list[tuple[float, str]]:
    """Round times between two times, with their labels.

    Args:
        first_s: seconds since 1970, UTC.
        last_s: the same, not earlier.
        most: the most of them.
    """
    span = max(1.0, last_s - first_s)
    step = next((each for each in _TIME_STEPS if span / each <= most), 0)
    if not step:
        step = math.ceil(span / most / (_DAY * 365)) * _DAY * 365
    begin = math.ceil(first_s / step) * step
    return [(float(each), _label(each, step)) for each in range(begin, math.floor(last_s) + 1, step)]


def _label(seconds: int, step: int) -> str:
    form = (
        "%H:%M:%S" if step < 60 else "%H:%M" if step < _DAY else "%d %b" if step < 90 * _DAY else "%Y-%m-%d"
    )
    if step < _DAY and seconds % _DAY == 0:
        form = "%d %b"
    return moment(seconds).strftime(form)


def moment(seconds: float) -> datetime:
    """Seconds since 1970 as a time, UTC."""
    return _EPOCH + timedelta(seconds=seconds)


def stamp(seconds: float) -> str:
    """A time as text, in whole seconds: ``2026-11-22 03:15:00``."""
    return moment(seconds).strftime("%Y-%m-%d %H:%M:%S")
