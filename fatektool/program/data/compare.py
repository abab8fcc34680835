"""Two parts ``data``, compared element by element."""

from __future__ import annotations

from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, NamedTuple

from fatektool.program.data.uses import CONSTANT, SYMBOLS, Use, use_of
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


class DataComparison(NamedTuple):
    """Two parts ``data`` compared.

    Attributes:
        constant: values that ought to be constant and differ: kept without power, or settings.
        running: the other elements that differ: they change by themselves.
        disabled: discretes that are disabled, or in a state, on one side alone; None for enabled.
    """

    constant: tuple[ValueDifference, ...]
    running: tuple[Element, ...]
    disabled: dict[str, tuple[bool | None, bool | None]]

    @property
    def same(self) -> bool:
        """True if nothing differs that ought to be constant."""
        return not self.constant and not self.disabled


def compare_data(a: DataPart, b: DataPart, ignore: Iterable[str] = ()) -> DataComparison:
    """Compare what ought to be constant, and find what runs.

    Args:
        a: the first.
        b: the second.
        ignore: globs of elements that are not compared, such as ``D1??``.
    """
    globs = list(ignore)
    unsteady = elements_in(a.moving) | elements_in(b.moving)
    constant, running = [], []
    for each in compare_values(a, b):
        if any(fnmatchcase(str(each.element), glob) for glob in globs):
            continue
        if each.use in CONSTANT and each.element not in unsteady:
            constant.append(each)
        else:
            running.append(each.element)
    names = dict.fromkeys([*a.disabled, *b.disabled])
    disabled = {name: (a.disabled.get(name), b.disabled.get(name)) for name in names}
    return DataComparison(
        tuple(constant),
        tuple(running),
        {name: states for name, states in disabled.items() if states[0] is not states[1]},
    )


def elements_in(spans: Iterable[str]) -> set[Element]:
    """The elements of spans such as ``R0-R63``."""
    found = set()
    for span in spans:
        first, _, last = span.partition("-")
        begin, end = Element.parse(first), Element.parse(last or first)
        found |= {Element(begin.symbol, at) for at in range(begin.address, end.address + 1)}
    return found
