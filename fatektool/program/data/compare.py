"""Two parts ``data``, compared element by element."""

from __future__ import annotations

from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, NamedTuple

from fatektool.counts import counted
from fatektool.program.data.uses import CONSTANT, SYMBOLS, Use, use_of
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

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


def compare_data(
    a: DataPart, b: DataPart, ignore: Iterable[str] = (), keep: Sequence[str] = ()
) -> DataComparison:
    """Compare what ought to be constant, and find what runs.

    Args:
        a: the first.
        b: the second.
        ignore: globs of elements that are not compared, such as ``D1??``.
        keep: globs of the elements that ought to be constant; none for those that are kept without power and
            settings, unless they changed while they were read.
    """
    globs = list(ignore)
    unsteady = elements_in(a.moving) | elements_in(b.moving)
    constant, running = [], []
    for each in compare_values(a, b):
        if any(fnmatchcase(str(each.element), glob) for glob in globs):
            continue
        name = str(each.element)
        by_use = each.use in CONSTANT and each.element not in unsteady
        if any(fnmatchcase(name, glob) for glob in keep) if keep else by_use:
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


def data_change(old: DataPart | None, new: DataPart | None, keep: Sequence[str] = ()) -> str | None:
    """What changed from one backup to the next, in words; None if nothing that ought to be constant.

    Args:
        old: the data of the first; None if it has none.
        new: those of the second. Without any nothing is compared.
        keep: see ``compare_data``.
    """
    if new is None:
        return None
    if old is None:
        return "data saved for the first time"
    found = compare_data(old, new, keep=keep)
    counts = [(found.constant, "value"), (found.disabled, "disabled discrete")]
    words = [counted(len(each), noun) for each, noun in counts if each]
    return f"{' and '.join(words)} changed" if words else None


def elements_in(spans: Iterable[str]) -> set[Element]:
    """The elements of spans such as ``R0-R63``."""
    found = set()
    for span in spans:
        first, _, last = span.partition("-")
        begin, end = Element.parse(first), Element.parse(last or first)
        found |= {Element(begin.symbol, at) for at in range(begin.address, end.address + 1)}
    return found
