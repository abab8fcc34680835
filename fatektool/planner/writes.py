"""Writes: the ways to cover the atoms of a line, as edges, without touching what was not asked.

As for reads, but a run ends where its stretch ends, and discretes are packed only where all sixteen of a word
are written. A stretch of discretes may begin as such up to the next multiple of 8, go on packed, and end as
such.
"""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING, Any, Final

from fatektool.planner.atoms import Atom, Line, atoms_of, lines_of
from fatektool.planner.costs import Costs
from fatektool.planner.paths import Edge, least_path
from fatektool.planner.reads import STEP, WORD, packed
from fatektool.protocol.commands import (
    MAX_DISCRETES,
    MAX_MIXED_WRITE_WORDS,
    MAX_READ_WORDS,
    Request,
    WriteDiscretes,
    WriteMixed,
    WriteRegisters,
)
from fatektool.protocol.elements import KINDS, Element

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fatektool.protocol.codec import Codec

_DOUBLE: Final = 2 * WORD


def plan_writes(
    items: Iterable[tuple[Element, int]], codec: Codec, *, turnaround: float = 0.0
) -> list[Request[None]]:
    """The requests that write these values with the least line time.

    Args:
        items: elements with their values, unsigned; no two may share an atom.
        codec: the protocol.
        turnaround: the PLC's time to answer, in bytes at this baud.
    """
    wanted = list(items)
    values: dict[Atom, int] = {}
    for element, value in wanted:
        atoms = atoms_of(element)
        width = element.kind.bits // len(atoms)
        for place, atom in enumerate(atoms):
            values[atom] = value >> (place * width) & ((1 << width) - 1)
    lines = lines_of(element for element, _ in wanted)
    if not lines:
        return []
    costs = Costs(codec, turnaround, writes=True)
    reach = _Reach(lines, costs)
    pieces = least_path(reach.end, reach.edges, costs.mixed_base, MAX_MIXED_WRITE_WORDS)
    requests: list[Request[None]] = []
    mixed: list[Element] = []
    for piece in pieces:
        if isinstance(piece, list):
            mixed += piece
        elif isinstance(piece, tuple):
            requests.append(_run(values, *piece))
    return requests + [
        WriteMixed(tuple((element, _value(values, element)) for element in some))
        for some in packed(mixed, MAX_MIXED_WRITE_WORDS)
    ]


def _value(values: dict[Atom, int], element: Element) -> int:
    atoms = atoms_of(element)
    width = element.kind.bits // len(atoms)
    return sum(values[atom] << (place * width) for place, atom in enumerate(atoms))


def _run(values: dict[Atom, int], symbol: str, first: int, count: int) -> Request[None]:
    element = Element(symbol, first)
    found: list[Any] = [_value(values, element.after(place)) for place in range(count)]
    if element.kind.bits == 1:
        return WriteDiscretes(element, tuple(bool(value) for value in found))
    return WriteRegisters(element, tuple(found))


class _Reach:
    """The edges from each atom."""

    def __init__(self, lines: list[Line], costs: Costs) -> None:
        self._lines = lines
        self._starts = [line.start for line in lines]
        self._costs = costs
        self.end = lines[-1].start + len(lines[-1].addresses)

    def edges(self, node: int) -> Iterator[Edge]:
        """All edges from an atom."""
        line = self._lines[bisect_right(self._starts, node) - 1]
        place = node - line.start
        if KINDS[line.symbol].bits == 1:
            yield from self._discretes(line, place)
        else:
            yield from self._registers(line, place)

    def _edge(self, line: Line, place: int, to: int, symbol: str, count: int) -> Edge:
        cost = self._costs.run_base(symbol) + self._costs.run_value(symbol) * count
        return Edge(line.start + to, cost, 0, (symbol, line.addresses[place], count))

    def _item(self, line: Line, place: int, to: int, symbol: str) -> Edge:
        item = Element(symbol, line.addresses[place])
        return Edge(line.start + to, self._costs.mixed_item(symbol), item.kind.words, [item])

    def _registers(self, line: Line, place: int) -> Iterator[Edge]:
        kind = KINDS[line.symbol]
        behind = line.end_from(place) + 1
        to = min(behind, place + MAX_READ_WORDS // kind.words)
        if to < behind:
            to = line.cut_before(to, place)
        yield self._edge(line, place, to, line.symbol, to - place)
        words = (behind - place) * kind.words
        if words <= MAX_MIXED_WRITE_WORDS:
            items = line.items(place, behind)
            cost = sum(self._costs.mixed_item(item.symbol) for item in items)
            yield Edge(line.start + behind, cost, words, items)

    def _discretes(self, line: Line, place: int) -> Iterator[Edge]:
        address = line.addresses[place]
        behind = line.end_from(place) + 1
        left = behind - place
        yield self._edge(line, place, place + min(left, MAX_DISCRETES), line.symbol, min(left, MAX_DISCRETES))
        to_step = -address % STEP
        if to_step:
            if to_step < left:
                yield self._edge(line, place, place + to_step, line.symbol, to_step)
        elif left >= WORD:
            words = min(left // WORD, MAX_READ_WORDS)
            yield self._edge(line, place, place + words * WORD, f"W{line.symbol}", words)
            yield self._item(line, place, place + WORD, f"W{line.symbol}")
            if left >= _DOUBLE:
                yield self._item(line, place, place + _DOUBLE, f"DW{line.symbol}")
        yield self._item(line, place, place + 1, line.symbol)
