"""Reads: the ways to cover the atoms of a line, as edges.

Exchange arguments keep the edges few without losing the least path:

- A run that ends inside a stretch of neighbours short of its limit can take the next atom over from whatever
  covers it, at no more cost: so a run ends at the end of a stretch or at its limit.
- It goes on over a gap that costs no more than what lies behind it would cost as a mixed item.
- A register that is mixed just before a run can be swapped into the run, whose last one then falls out: so
  what is mixed of registers is the whole rest of a stretch.
- Discretes can be read as such (44, a byte each), or packed (46, sixteen in the bytes of one register) from a
  multiple of 8: the cheaper of the two that reach as far is enough.

A packed word may reach past the last discrete wanted, but not past ``limits``.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from typing import TYPE_CHECKING, Any, Final

from fatektool.planner.atoms import Line, lines_of
from fatektool.planner.costs import Costs
from fatektool.planner.paths import Edge, least_path
from fatektool.protocol.commands import (
    MAX_DISCRETES,
    MAX_READ_WORDS,
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    Request,
)
from fatektool.protocol.elements import KINDS, Element

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from fatektool.protocol.codec import Codec

WORD: Final = 16
STEP: Final = 8


def plan_reads(
    elements: Iterable[Element],
    codec: Codec,
    *,
    turnaround: float = 0.0,
    limits: Mapping[str, int] | None = None,
) -> list[Request[Any]]:
    """The requests that read these elements with the least line time.

    Args:
        elements: of any kind, in any order, also twice.
        codec: the protocol.
        turnaround: the PLC's time to answer, in bytes at this baud.
        limits: how many of a kind the PLC has, by symbol, where that is known; beyond what is wanted nothing
            is read past it.
    """
    lines = lines_of(elements)
    if not lines:
        return []
    costs = Costs(codec, turnaround, writes=False)
    reach = _Reach(lines, costs, limits or {})
    pieces = least_path(reach.end, reach.edges, costs.mixed_base, MAX_READ_WORDS)
    requests: list[Request[Any]] = []
    mixed: list[Element] = []
    for piece in pieces:
        if isinstance(piece, list):
            mixed += piece
        elif isinstance(piece, tuple):
            requests.append(_run(*piece))
    return requests + [ReadMixed(tuple(items)) for items in packed(mixed, MAX_READ_WORDS)]


def _run(symbol: str, first: int, count: int) -> Request[Any]:
    element = Element(symbol, first)
    if element.kind.bits == 1:
        return ReadDiscretes(element, count)
    return ReadRegisters(element, count)


def packed(elements: Iterable[Element], capacity: int) -> list[list[Element]]:
    """Mixed items in as few requests as their words allow: the double ones first, so that no room is lost."""
    requests: list[list[Element]] = []
    room = 0
    for element in sorted(elements, key=lambda element: -element.kind.words):
        if room < element.kind.words:
            requests.append([])
            room = capacity
        requests[-1].append(element)
        room -= element.kind.words
    return requests


class _Reach:
    """The edges from each atom."""

    def __init__(self, lines: list[Line], costs: Costs, limits: Mapping[str, int]) -> None:
        self._lines = lines
        self._starts = [line.start for line in lines]
        self._costs = costs
        self._limits = limits
        self.end = lines[-1].start + len(lines[-1].addresses)

    def edges(self, node: int) -> Iterator[Edge]:
        """All edges from an atom."""
        line = self._lines[bisect_right(self._starts, node) - 1]
        place = node - line.start
        if KINDS[line.symbol].bits == 1:
            packed_runs = list(self._packed_runs(line, place))
            yield from packed_runs
            yield from self._discrete_runs(line, place, packed_runs)
            yield from self._mixed_discretes(line, place)
        else:
            yield from self._register_runs(line, place)
            yield from self._mixed_registers(line, place)

    def _register_runs(self, line: Line, place: int) -> Iterator[Edge]:
        kind = KINDS[line.symbol]
        most = MAX_READ_WORDS // kind.words
        base, value = self._costs.run_base(line.symbol), self._costs.run_value(line.symbol)
        first = line.addresses[place]
        past = first + most * kind.stride
        near = self._costs.mixed_item(line.symbol) // value * kind.stride
        for to in self._run_ends(line, place, past):
            last = line.addresses[to - 1]
            if to < len(line.addresses) and line.addresses[to] <= min(last + near, past - kind.stride):
                continue
            count = (last - first) // kind.stride + 1
            yield Edge(line.start + to, base + value * count, 0, (line.symbol, first, count))

    def _run_ends(self, line: Line, place: int, past: int) -> Iterator[int]:
        """Where a run from a place may end that reaches up to the address ``past``: the place behind it."""
        addresses = line.addresses
        limit = bisect_left(addresses, past, place)
        for at in range(bisect_left(line.ends, place), len(line.ends)):
            to = line.ends[at] + 1
            if to >= limit:
                break
            yield to
        yield line.cut_before(limit, place) if limit < len(addresses) else limit

    def _mixed_registers(self, line: Line, place: int) -> Iterator[Edge]:
        """The whole rest of the stretch as items, neighbours in pairs."""
        kind = KINDS[line.symbol]
        to = line.end_from(place) + 1
        words = (to - place) * kind.words
        if words > MAX_READ_WORDS:
            return
        items = line.items(place, to)
        cost = sum(self._costs.mixed_item(item.symbol) for item in items)
        yield Edge(line.start + to, cost, words, items)

    def _discrete_runs(self, line: Line, place: int, packed_runs: list[Edge]) -> Iterator[Edge]:
        base, value = self._costs.run_base(line.symbol), self._costs.run_value(line.symbol)
        first = line.addresses[place]
        for to in self._run_ends(line, place, first + MAX_DISCRETES):
            count = line.addresses[to - 1] - first + 1
            cost = base + value * count
            if not any(edge.to >= line.start + to and edge.cost <= cost for edge in packed_runs):
                yield Edge(line.start + to, cost, 0, (line.symbol, first, count))
            elif count > WORD * 2:  # longer ones cost more still
                return

    def _words_from(self, line: Line, place: int) -> tuple[int, int]:
        """Where the packed words begin that hold a place, and how many there may be."""
        first = line.addresses[place] // STEP * STEP
        limit = min(self._limits.get(line.symbol, 10000), 10000)
        return first, min((limit - first) // WORD, MAX_READ_WORDS)

    def _packed_runs(self, line: Line, place: int) -> Iterator[Edge]:
        symbol = f"W{line.symbol}"
        base, value = self._costs.run_base(symbol), self._costs.run_value(symbol)
        first, most = self._words_from(line, place)
        if most < 1:
            return
        near = self._costs.mixed_item(line.symbol) // value
        for to in self._run_ends(line, place, first + most * WORD):
            count = (line.addresses[to - 1] - first) // WORD + 1
            reached = bisect_left(line.addresses, first + count * WORD, to)
            if reached < len(line.addresses):
                if line.addresses[reached] < first + min(count + near, most) * WORD:
                    continue
                reached = line.cut_before(reached, place)
            yield Edge(line.start + reached, base + value * count, 0, (symbol, first, count))

    def _mixed_discretes(self, line: Line, place: int) -> Iterator[Edge]:
        first, most = self._words_from(line, place)
        for prefix, words in (("W", 1), ("DW", 2)):
            if most < words:
                continue
            to = bisect_left(line.addresses, first + words * WORD, place)
            if to < len(line.addresses):
                to = line.cut_before(to, place)
            item = Element(f"{prefix}{line.symbol}", first)
            yield Edge(line.start + to, self._costs.mixed_item(item.symbol), words, [item])
        if place + 1 not in line.joined or most < 1:
            alone = bisect_left(line.addresses, first + WORD, place) == place + 1
            if alone or most < 1:  # two in one word cost more than the word
                item = Element(line.symbol, line.addresses[place])
                yield Edge(line.start + place + 1, self._costs.mixed_item(item.symbol), 1, [item])
