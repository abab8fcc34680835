"""Neighbours on a terminal: registers as a grid, discretes as rows of bits below a ruler, text as one text.

::

           +0  +1  +2  +3  +4                 +0         +10               R100-R104  PRESS 4
    R10    -5   0  12   0   0                 0123456789 0123456789
    R15     7   0                         X0  1000000000 000000

Columns and ruler are steps from the element that the row begins with. What has no neighbours, or a comment,
is on a line of its own. A pipe gets each value on a line.
"""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Final

from fatektool.cli.elements.values import shown, value_lines
from fatektool.protocol.texts import text_of
from fatektool.protocol.values import TEXTS, ValueType

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from fatektool.jobs.elements.items import ItemValues
    from fatektool.jobs.elements.selection import Item
    from fatektool.protocol.values import Value

_FEWEST: Final = 8
"""Fewer neighbours than this are a list."""

_TEN: Final = 10
_ACROSS: Final = (10, 5, 2)
"""How many registers a row has, as far as they fit. The addresses are decimal."""

_MOST_TENS: Final = 5
_EMPTY: Final = '""'


def terminal_lines(found: ItemValues, comments: Mapping[str, str], columns: int) -> Iterator[str]:
    """What was read, for a terminal of so many columns."""
    items = [item for item in found.items if item.key not in comments]
    runs = {run[0].key: run for run in _runs(items)}
    in_runs = {item.key for run in runs.values() for item in run}
    before = False
    for together, group in groupby(found.items, lambda item: item.key in in_runs):
        listed = {item.key: found.values[item.key] for item in group}
        blocks = [_run_lines(runs[key], found, columns) for key in listed if key in runs]
        for block in blocks if together else [value_lines(listed, comments)]:
            yield from [""] * before
            yield from block
            before = True


def _runs(items: Sequence[Item]) -> Iterator[list[Item]]:
    """Neighbours of one kind and type that are shown together, in the order asked for."""

    def line_of(pair: tuple[int, Item]) -> tuple[str, ValueType, int]:
        place, item = pair
        element = item.element
        return element.symbol, item.type, element.address - place * element.kind.stride

    for (_, kind, _), group in groupby(enumerate(items), line_of):
        run = [item for _, item in group]
        if len(run) >= (2 if kind in TEXTS else _FEWEST):
            yield run


def _run_lines(run: Sequence[Item], found: ItemValues, columns: int) -> Iterator[str]:
    if run[0].type in TEXTS and all(found.raw[item.key] for item in run):
        words = [(int(found.raw[item.key] or "0", 16), item.element.kind.bits) for item in run]
        yield f"{run[0].key}-{run[-1].key}  {shown(text_of(words, TEXTS[run[0].type])) or _EMPTY}"
    elif run[0].type is ValueType.BOOL:
        yield from _bits(run, found.values, columns)
    else:
        yield from _grid(run, found.values, columns)


def _grid(run: Sequence[Item], values: Mapping[str, Value | None], columns: int) -> Iterator[str]:
    texts = {item.element.address: shown(values[item.key]) for item in run}
    stride = run[0].element.kind.stride
    label = _width(run)
    steps = [f"+{place * stride}" for place in range(_TEN)]
    width = max(*map(len, texts.values()), *map(len, steps))
    forms = ((across, gap) for across in _ACROSS for gap in (2, 1))
    fits = ((across, width + gap) for across, gap in forms if label + across * (width + gap) <= columns)
    across, width = next(fits, (1, width + 2))
    yield " " * label + "".join(f"{step:>{width}}" for step in steps[:across])
    first = run[0].element.address
    first -= first // stride % across * stride
    for base in range(first, run[-1].element.address + 1, across * stride):
        cells = (texts.get(base + place * stride, "") for place in range(across))
        yield f"{_name(run, base):<{label}}" + "".join(f"{cell:>{width}}" for cell in cells).rstrip()


def _bits(run: Sequence[Item], values: Mapping[str, Value | None], columns: int) -> Iterator[str]:
    bits = {item.element.address: _bit(values[item.key]) for item in run}
    label = _width(run)
    fits = max(1, min(_MOST_TENS, (columns - label - 1) // (_TEN + 1)))
    first = run[0].element.address // _TEN
    tens = min(fits, run[-1].element.address // _TEN - first + 1)
    yield (" " * label + "  " + " ".join(f"{f'+{_TEN * ten}':<{_TEN}}" for ten in range(tens))).rstrip()
    yield " " * label + "  " + " ".join(["0123456789"] * tens)
    for base in range(first * _TEN, run[-1].element.address + 1, tens * _TEN):
        rows = (range(start, start + _TEN) for start in range(base, base + tens * _TEN, _TEN))
        text = " ".join("".join(bits.get(address, " ") for address in row) for row in rows)
        yield f"{_name(run, base):<{label}}  {text}".rstrip()


def _bit(value: Value | None) -> str:
    return "-" if value is None else "1" if value else "0"


def _name(run: Sequence[Item], address: int) -> str:
    return f"{run[0].key.rstrip('0123456789')}{address}"


def _width(run: Sequence[Item]) -> int:
    return len(run[-1].key)
