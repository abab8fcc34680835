"""What elements are for: which a PLC keeps without power, which are settings, which nothing may write.

The ranges are, as far as known, the defaults of the FBs-PLC User's Manual [E:kept] and of its chapter on
links; what is kept without power can be set up otherwise in the program. They decide what is read twice,
what is compared, and what a restore writes; so what is in no range is taken for kept.
"""

from __future__ import annotations

from enum import Enum
from functools import cache
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator


class Use(Enum):
    """What an element is for."""

    KEPT = "kept without power"
    WORKING = "lost without power"
    SETTING = "setting"
    INPUT = "input"
    OUTPUT = "output"
    CLOCK = "clock"
    STATUS = "status or command of the PLC"


CONSTANT: Final = frozenset({Use.KEPT, Use.SETTING})
"""What ought to be constant, or changes seldom: it is read twice, and ``verify`` compares it."""

WRITTEN: Final = frozenset({Use.KEPT, Use.WORKING})
"""What a restore of data writes; settings only if that is asked for."""


class UseSpan(NamedTuple):
    """Neighbours of one use, the last included."""

    first: int
    last: int
    use: Use


_SPANS: Final[dict[str, tuple[UseSpan, ...]]] = {
    "R": (
        UseSpan(3000, 3839, Use.WORKING),
        UseSpan(3840, 3903, Use.INPUT),
        UseSpan(3904, 3967, Use.OUTPUT),
        UseSpan(3968, 4057, Use.SETTING),
        UseSpan(4058, 4059, Use.STATUS),  # abnormal stations of the high-speed link
        UseSpan(4060, 4127, Use.SETTING),
        UseSpan(4128, 4135, Use.CLOCK),
        UseSpan(4136, 4167, Use.SETTING),
    ),
    "D": (
        UseSpan(4000, 4044, Use.SETTING),
        UseSpan(4045, 4052, Use.STATUS),  # results of the last transactions
        UseSpan(4053, 4095, Use.SETTING),
    ),
    "F": (),
    "RT": (UseSpan(0, 9999, Use.WORKING),),
    "RC": (UseSpan(140, 199, Use.WORKING), UseSpan(240, 255, Use.WORKING)),
    "M": (
        UseSpan(0, 799, Use.WORKING),
        UseSpan(1400, 1911, Use.WORKING),
        UseSpan(1912, 1955, Use.STATUS),
        UseSpan(1956, 1956, Use.SETTING),
        UseSpan(1957, 1957, Use.STATUS),
        UseSpan(1958, 1959, Use.SETTING),
        UseSpan(1960, 1966, Use.STATUS),
        UseSpan(1967, 1967, Use.SETTING),
        UseSpan(1968, 2001, Use.STATUS),
    ),
    "S": (UseSpan(0, 499, Use.WORKING),),
}

SYMBOLS: Final = tuple(_SPANS)
"""The kinds of elements whose values are kept, in the order of the file."""


def uses_of(symbol: str, count: int) -> Iterator[UseSpan]:
    """All elements of a kind from 0 on, in spans of one use.

    Args:
        symbol: one of ``SYMBOLS``.
        count: how many the PLC has.
    """
    at = 0
    for span in _SPANS[symbol]:
        if at < min(span.first, count):
            yield UseSpan(at, min(span.first, count) - 1, Use.KEPT)
        if span.first < count:
            yield UseSpan(span.first, min(span.last, count - 1), span.use)
        at = span.last + 1
    if at < count:
        yield UseSpan(at, count - 1, Use.KEPT)


@cache
def use_of(symbol: str, address: int) -> Use:
    """What one element is for."""
    spans = (span for span in _SPANS[symbol] if span.first <= address <= span.last)
    found = next(spans, None)
    return Use.KEPT if found is None else found.use
