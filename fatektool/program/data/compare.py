"""Two parts ``data``, compared element by element."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fatektool.program.data.uses import SYMBOLS, Use, use_of
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fatektool.program.data.part import DataPart


class ValueDifference(NamedTuple):
    """An element whose values differ; None where one has no value, or no such element."""

    element: Element
    use: Use
    a: int | None
    b: int | None


def compare_values(a: DataPart, b: DataPart) -> Iterator[ValueDifference]:
    """The elements whose values differ, in order."""
    for symbol in SYMBOLS:
        ours, theirs = a.values[symbol], b.values[symbol]
        if ours == theirs:
            continue
        for at in range(max(len(ours), len(theirs))):
            one = ours[at] if at < len(ours) else None
            other = theirs[at] if at < len(theirs) else None
            if one != other:
                yield ValueDifference(Element(symbol, at), use_of(symbol, at), one, other)


def elements_in(spans: Iterable[str]) -> set[Element]:
    """The elements of spans such as ``R0-R63``."""
    found = set()
    for span in spans:
        first, _, last = span.partition("-")
        begin, end = Element.parse(first), Element.parse(last or first)
        found |= {Element(begin.symbol, at) for at in range(begin.address, end.address + 1)}
    return found
