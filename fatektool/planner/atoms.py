"""Elements as atoms on lines, and answers back to values.

::

    X16         discretes  X: 16
    WX8, DWX8   discretes  X: 8..23, 8..39, wanted in one request
    R12         registers  R: 12
    DR2         registers  R: 2, 3, wanted in one request
    DRC0        registers  DRC: 0, a line of their own, two of them, by even and odd address

32-bit registers of timers and counters are read as such, because a counter may have 32 bits.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass, field
from itertools import islice
from operator import sub
from typing import TYPE_CHECKING, Any, Final

from fatektool.protocol.commands import ReadDiscretes, ReadMixed, ReadRegisters, Request
from fatektool.protocol.elements import KINDS, Element, ElementKind, Stretch

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

_WHOLE_32: Final = {"DRT", "DRC"}


def _line_of(kind: ElementKind) -> tuple[str, int]:
    """The line of a kind, and how many atoms an element has after its first."""
    symbol, bits = kind.symbol, kind.bits
    if bits > 1 and symbol.startswith(("W", "DW")):
        return symbol[-1], bits - 1
    if bits == 32 and symbol not in _WHOLE_32:
        return symbol[1:], 1
    return symbol, 0


_LINES: Final = {symbol: _line_of(kind) for symbol, kind in KINDS.items()}

Atom = tuple[str, int]
"""Symbol of the line, address."""


def atoms_of(element: Element) -> list[Atom]:
    """The atoms of an element, the lowest first."""
    symbol, first, last = _span(element)
    return [(symbol, address) for address in range(first, last + 1)]


def _span(element: Element) -> tuple[str, int, int]:
    """The line of an element, with its first and last address on it."""
    symbol, more = _LINES[element.symbol]
    return symbol, element.address, element.address + more


def parts_of(element: Element, value: int) -> dict[Atom, int]:
    """The part of a value in each of the element's atoms."""
    atoms = atoms_of(element)
    width = element.kind.bits // len(atoms)
    return {atom: value >> (place * width) & ((1 << width) - 1) for place, atom in enumerate(atoms)}


def value_of(element: Element, parts: Mapping[Atom, int]) -> int:
    """The value of an element from the parts in its atoms."""
    atoms = atoms_of(element)
    width = element.kind.bits // len(atoms)
    return sum(parts[atom] << (place * width) for place, atom in enumerate(atoms))


@dataclass(slots=True)
class AtomLine:
    """The elements of one symbol, in order, each as the span of its atoms.

    A span within another is omitted, so first and last addresses both ascend.

    Attributes:
        symbol: ``X``, ``R``, ``DRC``, …
        stride: the distance of consecutive elements.
        firsts: each span's first address.
        lasts: each span's last address.
        lowest: no request goes below this address,
        bound: nor to this one or past it.
        exact: all elements between lowest and bound are needed.
        start: the node of the first span.
        ends: the places after ranges of consecutive elements, before a gap.
        uneven: registers and pairs of them are side by side.
    """

    symbol: str
    stride: int
    firsts: Sequence[int]
    lasts: Sequence[int]
    lowest: int
    bound: int
    exact: bool
    start: int
    ends: list[int] = field(init=False)
    uneven: bool = field(init=False)

    def __post_init__(self) -> None:
        self.ends = _stretch_ends(self.firsts, self.lasts, self.stride)
        alike = isinstance(self.firsts, range)  # a stretch alone
        self.uneven = not alike and len(set(map(sub, self.lasts, self.firsts))) > 1

    def __len__(self) -> int:
        return len(self.firsts)

    def place_past(self, address: int, place: int) -> int:
        """The place after the last span that ends before this address, from a place on."""
        return bisect_left(self.lasts, address, place)

    def straddled(self, address: int, place: int) -> bool:
        """True if a span from a place on begins before this address and does not end there."""
        across = self.place_past(address, place)
        return across < len(self) and self.firsts[across] < address

    def rest_of_stretch(self, place: int) -> int:
        """The number of addresses from a place to the end of its range."""
        return self.lasts[self.ends[bisect_right(self.ends, place)] - 1] + self.stride - self.firsts[place]


def lines_of(elements: Iterable[Element | Stretch], limits: Mapping[str, int] | None) -> list[AtomLine]:
    """The lines of the elements, in sequence.

    Args:
        elements: of any kind, in any order, also twice; ranges of them are used as such.
        limits: the end of gaps that may be read, by symbol, if before the largest address; None if only the
            given elements may be accessed.
    """
    spans: dict[tuple[str, int], set[tuple[int, int]]] = {}
    stretches: dict[tuple[str, int], list[tuple[range, range]]] = {}
    for each in elements:
        if isinstance(each, Stretch):
            symbol, first, last = _span(each.first)
            past, stride = each.count * each.first.kind.stride, each.first.kind.stride
            ranges = range(first, first + past, stride), range(last, last + past, stride)
            stretches.setdefault((symbol, first % KINDS[symbol].stride), []).append(ranges)
        else:
            symbol, first, last = _span(each)
            spans.setdefault((symbol, first % KINDS[symbol].stride), set()).add((first, last))
    lines: list[AtomLine] = []
    for key in sorted(spans.keys() | stretches.keys()):
        symbol = key[0]
        kind = KINDS[symbol]
        limit = 0 if limits is None else min(limits.get(symbol, kind.last + 1), kind.last + 1)
        firsts, lasts = _in_order(spans.get(key, set()), stretches.get(key, []))
        begin = 0
        ends = _stretch_ends(firsts, lasts, kind.stride)
        for end, after in zip(ends, [*ends[1:], 0], strict=True):
            if after and limits is not None and firsts[end] <= limit:
                continue  # the gap after this stretch may be read over
            within = limits is not None and firsts[begin] <= limit
            past = lasts[end - 1] + kind.stride
            lines.append(
                AtomLine(
                    symbol,
                    kind.stride,
                    firsts[begin:end],
                    lasts[begin:end],
                    lowest=0 if within else firsts[begin],
                    bound=max(limit, past) if within else past,
                    exact=not within,
                    start=lines[-1].start + len(lines[-1]) if lines else 0,
                )
            )
            begin = end
    return lines


def _in_order(
    spans: set[tuple[int, int]], stretches: list[tuple[range, range]]
) -> tuple[Sequence[int], Sequence[int]]:
    """First and last addresses of all spans of a line; a single range is already in order."""
    if len(stretches) == 1 and not spans:
        return stretches[0]
    return _outermost(spans.union(*(zip(*ranges, strict=True) for ranges in stretches)))


def _outermost(spans: set[tuple[int, int]]) -> tuple[list[int], list[int]]:
    """First and last addresses of the spans that are not within another."""
    firsts: list[int] = []
    lasts: list[int] = []
    for first, last in sorted(spans, key=lambda span: (span[0], -span[1])):
        if not lasts or last > lasts[-1]:
            firsts.append(first)
            lasts.append(last)
    return firsts, lasts


def _stretch_ends(firsts: Sequence[int], lasts: Sequence[int], stride: int) -> list[int]:
    if isinstance(firsts, range):
        return [len(firsts)]
    neighbours = zip(islice(firsts, 1, None), lasts, strict=False)
    found = [place for place, (first, before) in enumerate(neighbours, 1) if first - before > stride]
    return [*found, len(firsts)]


class Values:
    """Answers to planned reads, and the values of the elements in them.

    Two answers may have one atom. An element's value is that of the last answer that has it completely, so
    that its parts are from one scan [E:one-scan].
    """

    def __init__(self) -> None:
        self._answers = 0
        self._atoms: dict[Atom, dict[int, int]] = {}  # by answer, the last one last

    def take(self, request: Request[Any], answer: tuple[Any, ...]) -> None:
        """Keep the values of a request's answer."""
        self._answers += 1
        if isinstance(request, ReadMixed):
            for element, value in zip(request.elements, answer, strict=True):
                self._keep(element, value)
        elif isinstance(request, ReadDiscretes | ReadRegisters):
            first = request.first
            symbol, at, last = _span(first)
            if at == last:  # an atom each
                stride = first.kind.stride
                for place, value in enumerate(answer):
                    self._atoms.setdefault((symbol, at + place * stride), {})[self._answers] = int(value)
                return
            for place, value in enumerate(answer):
                self._keep(first.after(place), int(value))

    def _keep(self, element: Element, value: int) -> None:
        for atom, bits in parts_of(element, value).items():
            self._atoms.setdefault(atom, {})[self._answers] = bits

    def __contains__(self, element: object) -> bool:
        return isinstance(element, Element) and bool(self._answers_with(element))

    def _answers_with(self, element: Element) -> set[int]:
        return set.intersection(*(set(self._atoms.get(atom, ())) for atom in atoms_of(element)))

    def value(self, element: Element) -> int:
        """The value of an element, unsigned; a discrete is 0 or 1.

        Raises:
            KeyError: it is in no answer.
        """
        symbol, first, last = _span(element)
        if first == last:
            values = self._atoms[symbol, first]
            return values[next(reversed(values))]
        answers = self._answers_with(element)
        if not answers:
            raise KeyError(element)
        newest = max(answers)
        return value_of(element, {atom: self._atoms[atom][newest] for atom in atoms_of(element)})
