"""Elements as atoms on lines, and answers back to values.

::

    X16         discretes  X: 16
    WX8, DWX8   discretes  X: 8..23, 8..39, wanted in one request
    R12         registers  R: 12
    DR2         registers  R: 2, 3, wanted in one request
    DRC0        registers  DRC: 0, a line of their own, two of them, by even and odd address

Timers' and counters' 32-bit registers are read as such: a counter may have 32 bits of its own.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from fatektool.protocol.commands import ReadDiscretes, ReadMixed, ReadRegisters, Request
from fatektool.protocol.elements import KINDS, Element

if TYPE_CHECKING:
    from collections.abc import Iterable

_WHOLE_32: Final = {"DRT", "DRC"}

Atom = tuple[str, int]
"""Symbol of the line, address."""


def atoms_of(element: Element) -> list[Atom]:
    """The atoms that hold an element, the lowest first."""
    symbol, address, bits = element.symbol, element.address, element.kind.bits
    if bits > 1 and symbol.startswith(("W", "DW")):
        return [(symbol[-1], address + place) for place in range(bits)]
    if bits == 32 and symbol not in _WHOLE_32:
        return [(symbol[1:], address), (symbol[1:], address + 1)]
    return [(symbol, address)]


@dataclass(slots=True)
class Line:
    """The wanted atoms of one symbol, in order.

    Attributes:
        symbol: ``X``, ``R``, ``DRC``, …
        stride: how far apart neighbours are.
        addresses: sorted.
        start: the node of the first atom.
        joined: places that belong together with the one before them, in one request.
    """

    symbol: str
    stride: int
    addresses: list[int]
    start: int = 0
    joined: set[int] = field(default_factory=set)
    ends: list[int] = field(default_factory=list)

    def finish(self, start: int) -> None:
        """Find the ends of the stretches of neighbours: the places behind which there is a gap."""
        self.start = start
        last = len(self.addresses) - 1
        self.ends = [
            place
            for place, address in enumerate(self.addresses)
            if place == last or self.addresses[place + 1] != address + self.stride
        ]

    def end_from(self, place: int) -> int:
        """The end of the stretch that a place is in."""
        return self.ends[bisect_left(self.ends, place)]

    def items(self, place: int, to: int) -> list[Element]:
        """The registers of a stretch as mixed items, neighbours in pairs where a pair is one element."""
        pairs = f"D{self.symbol}" in KINDS and f"D{self.symbol}" not in _WHOLE_32
        found: list[Element] = []
        at = place
        while at < to:
            double = pairs and at + 1 < to and at + 2 not in self.joined
            found.append(Element(f"D{self.symbol}" if double else self.symbol, self.addresses[at]))
            at += 2 if double else 1
        return found

    def cut_before(self, place: int, least: int) -> int:
        """The nearest place up to this one before which a request may end, past ``least``."""
        at = place
        while at > least and at in self.joined:
            at -= 1
        return at if at > least else place


def lines_of(elements: Iterable[Element]) -> list[Line]:
    """The lines on which the elements' atoms lie, one behind the other."""
    wanted: dict[tuple[str, int], set[int]] = {}
    together: dict[tuple[str, int], set[int]] = {}
    for element in elements:
        atoms = atoms_of(element)
        stride = KINDS[atoms[0][0]].stride
        key = (atoms[0][0], atoms[0][1] % stride)
        wanted.setdefault(key, set()).update(address for _, address in atoms)
        together.setdefault(key, set()).update(address for _, address in atoms[1:])
    lines = []
    start = 0
    for (symbol, parity), addresses in sorted(wanted.items()):
        line = Line(symbol, KINDS[symbol].stride, sorted(addresses))
        line.joined = {
            place for place, address in enumerate(line.addresses) if address in together[symbol, parity]
        }
        line.finish(start)
        start += len(line.addresses)
        lines.append(line)
    return lines


class Values:
    """Answers to planned reads, and the values of the elements in them."""

    def __init__(self) -> None:
        self._atoms: dict[Atom, int] = {}

    def take(self, request: Request[Any], answer: tuple[Any, ...]) -> None:
        """Keep what a request's answer tells."""
        if isinstance(request, ReadMixed):
            for element, value in zip(request.elements, answer, strict=True):
                self._keep(element, value)
        elif isinstance(request, ReadDiscretes | ReadRegisters):
            for place, value in enumerate(answer):
                self._keep(request.first.after(place), int(value))

    def _keep(self, element: Element, value: int) -> None:
        atoms = atoms_of(element)
        if len(atoms) == 1:
            self._atoms[atoms[0]] = value
            return
        width = element.kind.bits // len(atoms)
        mask = (1 << width) - 1
        for place, atom in enumerate(atoms):
            self._atoms[atom] = value >> (place * width) & mask

    def __contains__(self, element: object) -> bool:
        return isinstance(element, Element) and all(atom in self._atoms for atom in atoms_of(element))

    def value(self, element: Element) -> int:
        """The value of an element, unsigned; a discrete is 0 or 1.

        Raises:
            KeyError: no answer told of it.
        """
        atoms = atoms_of(element)
        width = element.kind.bits // len(atoms)
        return sum(self._atoms[atom] << (place * width) for place, atom in enumerate(atoms))
