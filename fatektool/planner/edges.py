"""The ways to cover the elements of a line, as edges between its places.

Edges from each place to every place that one run or item can reach would be enough for the least path. Most
edges can be omitted without losing a least path:

- A run of registers ends after a range of consecutive elements or at its limit. If it ended earlier within
  the range, it could include the next one, at no more cost.
- Registers that are mixed before a run in the same range can be exchanged with the last ones of that run, if
  all have the same width. So they are mixed only if one request and the run after it can reach the end of the
  range (48 and 49 have no more than a run), or if the widths differ.
- A packed run begins at the last possible multiple of 8, and ends where the 8 discretes after it are not
  needed, or at its limit. Otherwise it could include one more word, and the next run would begin a word
  later, if no needed word crosses that place.
- Discretes are read as such (44, one byte each) only if a packed run costs more, or cannot reach them.
- A discrete is a single item only if it is alone among its 8: two cost more than their word.

If only the given elements may be accessed, as in writes, a packed run or word begins and ends with its
discretes. Between, before and after these, discretes are in runs or mixed, up to a multiple of 8 or the end
of the range.

A protocol may always transmit eight discretes in a byte (Modbus). Then there are only runs of discretes, and
an element that fits into the last byte of a run costs nothing. If the rest of the line fits into one run, it
ends only before a gap that costs more than another request: otherwise it could include the run after the gap.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from functools import cache
from typing import TYPE_CHECKING, Final

from fatektool.planner.costs import WORD
from fatektool.planner.paths import Edge, Run
from fatektool.protocol.elements import KINDS, Element

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.planner.atoms import AtomLine
    from fatektool.planner.costs import Costs

STEP: Final = 8


class Edges:
    """The edges from each place of each line; the places of all lines are nodes with consecutive numbers."""

    def __init__(self, lines: list[AtomLine], costs: Costs) -> None:
        self._lines = lines
        self._starts = [line.start for line in lines]
        self._costs = costs
        self._cuts = cache(self._find_cuts)
        self.end = lines[-1].start + len(lines[-1])

    def of(self, node: int) -> Iterator[Edge]:
        """All edges from a place."""
        number = bisect_right(self._starts, node) - 1
        line = self._lines[number]
        place = node - line.start
        mixed = self._costs.mixed_words
        if KINDS[line.symbol].bits > 1:
            yield from self._register_runs(line, place)
            if mixed:
                yield from self._register_items(line, place)
        elif self._costs.packs_discretes(line.symbol):
            yield from self._bit_runs(line, place)
        elif line.exact:
            yield from self._exact_runs(line, place)
            yield from self._exact_items(line, place)
        else:
            yield from self._packed_runs(number, place)
            yield from self._discrete_runs(line, place)
            yield from self._discrete_items(line, place)

    def _run(self, line: AtomLine, to: int, symbol: str, first: int, count: int) -> Edge:
        return Edge(line.start + to, self._costs.run(symbol, count), 0, Run(symbol, first, count))

    def _item(self, line: AtomLine, to: int, symbol: str, address: int) -> Edge:
        item = Element(symbol, address)
        return Edge(line.start + to, self._costs.mixed_item(symbol), item.kind.words, [item])

    # --- registers --------------------------------------------------------------------------------

    def _register_runs(self, line: AtomLine, place: int) -> Iterator[Edge]:
        kind = KINDS[line.symbol]
        first = line.firsts[place]
        to = line.place_past(first + self._costs.most(line.symbol) * kind.stride, place)
        ends = [to]
        if line.uneven and self._costs.one_is_cheap(line.symbol):
            ends += range(place + 1, to)
        while to < len(line) and to - 1 > place and line.firsts[to] <= line.lasts[to - 1]:
            to -= 1  # if elements overlap, the limit may not be a possible end
            ends.append(to)
        ends += line.ends[bisect_right(line.ends, place) : bisect_left(line.ends, to)]
        for end in ends:
            yield self._run(line, end, line.symbol, first, (line.lasts[end - 1] - first) // kind.stride + 1)

    def _register_items(self, line: AtomLine, place: int) -> Iterator[Edge]:
        kind = KINDS[line.symbol]
        first, last = line.firsts[place], line.lasts[place]
        # A full run of single registers costs no more than any other edge here: none of its words is
        # cheaper in a mixed request, and a mixed request has no more of them.
        near = self._costs.most(line.symbol) * kind.stride * (1 if first == last else 2)
        if not line.uneven and line.rest_of_stretch(place) >= near:
            return
        double = f"D{line.symbol}"
        if last > first:
            yield self._item(line, place + 1, double, first)
            return
        yield self._item(line, place + 1, line.symbol, first)
        paired = place + 1 < len(line) and line.lasts[place + 1] == first + 1
        if paired and kind.words == 1 and line.symbol in "RDF":
            yield self._item(line, place + 2, double, first)

    # --- discretes, read: gaps and the rest of a word may be included --------------------------------

    def _find_cuts(self, number: int, phase: int) -> list[tuple[int, int]]:
        """The possible ends of packed runs that begin at ``phase`` modulo 16: address, place after."""
        line = self._lines[number]
        cuts = []
        for place, last in enumerate(line.lasts, 1):
            end = last + 1 + (phase - last - 1) % WORD
            if place < len(line):
                if line.lasts[place] < end:
                    continue  # the word has the next one too
                if end <= line.firsts[place] < end + STEP and not line.straddled(end + WORD, place):
                    continue  # it could include the next word
            cuts.append((end, place))
        return cuts

    def _packed_runs(self, number: int, place: int) -> Iterator[Edge]:
        line = self._lines[number]
        symbol = f"W{line.symbol}"
        first = line.firsts[place] // STEP * STEP
        space = (line.bound - first) // WORD
        most = self._costs.most(symbol)
        limit = first + min(space, most) * WORD
        cuts = self._cuts(number, first % WORD)
        for at in range(bisect_left(cuts, (line.lasts[place] + 1, 0)), len(cuts)):
            end, to = cuts[at]
            if end >= limit:
                break
            yield self._run(line, to, symbol, first, (end - first) // WORD)
        to = line.place_past(limit, place)
        if to > place:
            yield self._run(line, to, symbol, first, -(-(line.lasts[to - 1] + 1 - first) // WORD))
        if space < most and limit + STEP <= line.bound and first >= STEP:
            beyond = line.place_past(limit + STEP, place)
            if beyond > to:  # reached by a run that begins 8 earlier, and ends at the end of the PLC's range
                yield self._run(line, beyond, symbol, first - STEP, space + 1)

    def _discrete_runs(self, line: AtomLine, place: int) -> Iterator[Edge]:
        symbol, packed = line.symbol, f"W{line.symbol}"
        value, word = self._costs.run_value(symbol), self._costs.run_value(packed)
        ahead = self._costs.run_base(packed) - self._costs.run_base(symbol)
        first = line.firsts[place]
        begin = first // STEP * STEP
        # Beyond so many discretes a packed run costs no more, and up to there it can reach.
        most = self._costs.most(symbol)
        dear = (ahead + word) / (value - word / WORD) if value * WORD > word else most
        near = line.place_past(first + min(int(dear) + 1, most), place)
        words_end = line.bound // STEP * STEP if line.bound >= WORD else 0
        unpacked = max(line.place_past(words_end, place), near)
        limit = line.place_past(first + most, place)
        for to in (*range(place + 1, near + 1), *range(unpacked + 1, limit + 1)):
            last = line.lasts[to - 1]
            if to < len(line) and line.firsts[to] == last + 1 and line.firsts[to] % STEP:
                continue  # it could include the next one
            words = (last - begin) // WORD + 1
            if begin + words * WORD > line.bound or value * (last + 1 - first) < ahead + word * words:
                yield self._run(line, to, symbol, first, last + 1 - first)

    def _discrete_items(self, line: AtomLine, place: int) -> Iterator[Edge]:
        symbol, first = line.symbol, line.firsts[place]
        begin = first // STEP * STEP
        reached = place
        for prefix, bits in (("W", WORD), ("DW", 2 * WORD)):
            address = min(begin, (line.bound - bits) // STEP * STEP)
            if begin - address > STEP or address < 0:
                continue
            to = line.place_past(address + bits, place)
            if to > reached:
                yield self._item(line, to, prefix + symbol, address)
                reached = to
        next_to = place + 1 < len(line) and line.firsts[place + 1] < min(
            begin + STEP, line.bound // STEP * STEP
        )
        item = self._costs.mixed_item
        if line.lasts[place] == first and not (next_to and 2 * item(symbol) >= item(f"W{symbol}")):
            yield self._item(line, place + 1, symbol, first)

    # --- discretes, if eight of them always take one byte ------------------------------------------------

    def _bit_runs(self, line: AtomLine, place: int) -> Iterator[Edge]:
        first, most = line.firsts[place], self._costs.most(line.symbol)
        limit = line.place_past(first + most, place)
        if limit == len(line):
            byte = self._costs.run(line.symbol, 2 * STEP) - self._costs.run(line.symbol, STEP)  # in ASCII 2
            request = self._costs.run(line.symbol, STEP) - byte
            ends = {
                end
                for end in line.ends[bisect_right(line.ends, place) : -1]
                if byte * -(-(line.firsts[end] - line.lasts[end - 1] - 1) // STEP) > request
            }
            ends.add(limit)
        else:
            ends = {line.place_past(first + bits, place) for bits in range(STEP, most, STEP)}
            ends |= {place + 1, limit}
        for to in sorted(ends, reverse=True):
            if to > place:
                yield self._run(line, to, line.symbol, first, line.lasts[to - 1] + 1 - first)

    # --- discretes, only the given ones ---------------------------------------------------------------

    def _exact_runs(self, line: AtomLine, place: int) -> Iterator[Edge]:
        first = line.firsts[place]
        most = self._costs.most(line.symbol)
        limit = line.place_past(first + most, place)
        ends = {limit}
        for address in range(first // STEP * STEP + STEP, min(first + most, line.bound), STEP):
            to = line.place_past(address, place)
            if to > place and line.lasts[to - 1] + 1 == address:
                ends.add(to)
        for to in ends:
            yield self._run(line, to, line.symbol, first, line.lasts[to - 1] + 1 - first)
        if first % STEP:
            return
        for words in range(min((line.bound - first) // WORD, self._costs.most(f"W{line.symbol}")), 0, -1):
            to = line.place_past(first + words * WORD, place)
            if to > place and line.lasts[to - 1] + 1 == first + words * WORD:
                yield self._run(line, to, f"W{line.symbol}", first, words)
                return

    def _exact_items(self, line: AtomLine, place: int) -> Iterator[Edge]:
        symbol, first = line.symbol, line.firsts[place]
        if first % STEP == 0:
            for prefix, bits in (("W", WORD), ("DW", 2 * WORD)):
                to = line.place_past(first + bits, place)
                if to > place and line.lasts[to - 1] + 1 == first + bits:
                    yield self._item(line, to, prefix + symbol, first)
        to = place
        while (
            to < len(line) and line.firsts[to] == line.lasts[to] and (to == place or line.firsts[to] % STEP)
        ):
            to += 1
        if to > place:
            cost = self._costs.mixed_item(symbol) * (to - place)
            items = [Element(symbol, line.firsts[at]) for at in range(place, to)]
            yield Edge(line.start + to, cost, to - place, items)
