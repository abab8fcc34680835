"""The least that a set of elements can cost, found by trying everything: slow, and without an argument.

What requests may be is said anew here, from the protocol alone:

- a run of any kind from any place, or an item of any kind in a mixed request;
- each element wanted lies within one run or one item;
- a read may read more than is wanted, but past the PLC's end nothing that is not wanted;
- a write writes each discrete and register that is wanted once, and no other.

All sets of them that cover what is wanted are compared, by bytes that the codec really gives.
"""

from __future__ import annotations

from collections import defaultdict
from math import ceil, inf
from typing import TYPE_CHECKING, Any, NamedTuple

from fatektool.errors import UsageError
from fatektool.protocol.commands import (
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    Request,
    WriteDiscretes,
    WriteMixed,
    WriteRegisters,
)
from fatektool.protocol.elements import KINDS, Element

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from fatektool.protocol.codec import Codec


class Places(NamedTuple):
    """Places side by side on one line."""

    area: str
    begin: int
    end: int

    def each(self) -> Iterator[tuple[str, int]]:
        """One by one."""
        return ((self.area, place) for place in range(self.begin, self.end))


class Caps(NamedTuple):
    """What one request holds: discretes of 44 and 45, words of 46 and 47, words of 48 or 49, 0 for none."""

    discretes: int = 256
    words: int = 64
    mixed: int = 64
    packs: bool = False  # words of discretes are counted as their discretes


READ_CAPS = Caps()
WRITE_CAPS = Caps(mixed=32)


class Limited:
    """A codec whose requests hold less, so that a few elements meet every limit."""

    def __init__(self, codec: Codec, read: Caps, write: Caps) -> None:
        self._codec = codec
        self._caps = {False: read, True: write}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codec, name)

    def most(self, symbol: str, *, writes: bool) -> int:
        return most(symbol, self._caps[writes])

    def mixed_words(self, *, writes: bool) -> int:
        return self._caps[writes].mixed


def most(symbol: str, caps: Caps) -> int:
    """How many elements of a kind a run holds."""
    bits = KINDS[symbol].bits
    if bits == 1:
        return caps.discretes
    if caps.packs and "W" in symbol:
        return caps.discretes // bits
    return caps.words // (2 if bits == 32 else 1)


class Piece(NamedTuple):
    """A run or an item: which of the elements it holds, what it costs, its mixed words."""

    holds: int
    cost: float
    words: int


def wire_bytes(requests: Iterable[Request[Any]], codec: Codec, turnaround: float) -> float:
    """The cost of a plan."""
    return sum(len(codec.encode(1, one)) + codec.answer_bytes(one) + turnaround for one in requests)


def places(symbol: str, address: int, count: int = 1) -> Places:
    """What so many elements are: discretes, registers, double registers of timers and counters."""
    if symbol in {"DRT", "DRC"}:  # the next one is two on
        return Places(f"{symbol} {'odd' if address % 2 else 'even'}", address // 2, address // 2 + count)
    for prefix, width in (("DW", 32), ("W", 16)):
        if symbol.startswith(prefix):
            return Places(symbol[-1], address, address + width * count)
    if symbol in {"DR", "DD", "DF"}:
        return Places(symbol[1], address, address + 2 * count)
    return Places(symbol, address, address + count)


def places_of(elements: Iterable[Element]) -> set[tuple[str, int]]:
    """What all of these are, one by one."""
    return {place for element in elements for place in places(element.symbol, element.address).each()}


def kinds_over(area: str) -> list[str]:
    """The kinds of element that lie over a line of places."""
    if area in "XYMSTC":
        return [area, f"W{area}", f"DW{area}"]
    return [area, f"D{area}"] if area in "RDF" else [area.partition(" ")[0]]


class _World:
    """Everything that a request may be, for one set of elements."""

    def __init__(
        self,
        elements: Iterable[Element],
        codec: Codec,
        turnaround: float,
        caps: Caps,
        *,
        writes: bool,
        limits: Mapping[str, int],
    ) -> None:
        self._codec = codec
        self._turnaround = turnaround
        self._caps = caps
        self._writes = writes
        self._limits = limits
        self._each = sorted({places(element.symbol, element.address) for element in elements})
        self._all = {place for one in self._each for place in one.each()}
        self._sizes: dict[tuple[str, int], float] = {}
        self.everything = (1 << len(self._each)) - 1
        self.mixed_base = 0.0
        if caps.mixed:
            self.mixed_base = self._wire(self._mixed("R", 1)) - self._item("R") + turnaround

    def _wire(self, request: Request[Any]) -> float:
        return self._codec.request_bytes(request) + self._codec.answer_bytes(request)

    def _mixed(self, symbol: str, count: int) -> Request[Any]:
        element = Element(symbol, 0)
        return WriteMixed(((element, 0),) * count) if self._writes else ReadMixed((element,) * count)

    def _item(self, symbol: str) -> float:
        return self._wire(self._mixed(symbol, 2)) - self._wire(self._mixed(symbol, 1))

    def _run(self, symbol: str, count: int) -> float:
        first = Element(symbol, 0)
        request: Request[Any]
        if first.kind.bits == 1:
            request = WriteDiscretes(first, (False,) * count) if self._writes else ReadDiscretes(first, count)
        else:
            request = WriteRegisters(first, (0,) * count) if self._writes else ReadRegisters(first, count)
        return self._wire(request) + self._turnaround

    def _size(self, symbol: str, count: int) -> float:
        """Bytes of a run; of an item for a count of 0."""
        key = (symbol, count)
        if key not in self._sizes:
            self._sizes[key] = self._run(symbol, count) if count else self._item(symbol)
        return self._sizes[key]

    def _holds(self, covered: Places) -> int:
        """Which elements lie within; 0 if it may not be."""
        area, begin, end = covered
        held = [
            n for n, one in enumerate(self._each) if one.area == area and begin <= one.begin <= one.end <= end
        ]
        if self._writes:  # nothing else, and not a part of an element that lies across either
            size = sum(self._each[n].end - self._each[n].begin for n in held)
            return sum(1 << n for n in held) if size == end - begin else 0
        past = range(max(begin, self._limits.get(area, end)), end)
        return sum(1 << n for n in held) if all((area, place) in self._all for place in past) else 0

    def pieces(self) -> list[Piece]:
        """All runs and items; of those that hold the same, the cheapest of each number of words."""
        best: dict[tuple[int, int], float] = {}
        for area in {one.area for one in self._each}:
            last = max(one.end for one in self._each if one.area == area)
            for symbol in kinds_over(area):
                for first in self._starts(symbol, area):
                    for piece in self._from(symbol, first, last):
                        key = (piece.holds, piece.words)
                        best[key] = min(piece.cost, best.get(key, inf))
        return [Piece(holds, cost, words) for (holds, words), cost in best.items()]

    def _starts(self, symbol: str, area: str) -> Iterable[int]:
        """Where a run or item may begin: earlier ones hold no more."""
        found = {place for where, place in self._all if where == area}
        if symbol in {"DRT", "DRC"}:
            return {2 * place + area.endswith("odd") for place in found}
        if "W" in symbol:
            return {
                place // 8 * 8 - back for place in found for back in range(0, 40, 8) if place // 8 * 8 >= back
            }
        return found | {place - 1 for place in found if place and symbol in {"DR", "DD", "DF"}}

    def _from(self, symbol: str, first: int, last: int) -> Iterator[Piece]:
        words = 2 if symbol in {"DRT", "DRC", "DR", "DD", "DF"} or symbol.startswith("DW") else 1
        for count in range(1, most(symbol, self._caps) + 1):
            try:
                Element(symbol, first).after(count - 1)
            except UsageError:
                return
            covered = places(symbol, first, count)
            holds = self._holds(covered)
            if holds and count == 1 and self._caps.mixed:
                yield Piece(holds, self._size(symbol, 0), words)
            if holds:
                yield Piece(holds, self._size(symbol, count), 0)
            if covered.end >= last:
                return


def least_read(
    elements: Iterable[Element],
    codec: Codec,
    turnaround: float,
    *,
    caps: Caps = READ_CAPS,
    limits: Mapping[str, int] | None = None,
) -> float:
    """The cost of the cheapest reads."""
    world = _World(elements, codec, turnaround, caps, writes=False, limits=limits or {})
    return _least(world, caps.mixed, once=False)


def least_write(
    elements: Iterable[Element], codec: Codec, turnaround: float, *, caps: Caps = WRITE_CAPS
) -> float:
    """The cost of the cheapest writes."""
    world = _World(elements, codec, turnaround, caps, writes=True, limits={})
    return _least(world, caps.mixed, once=True)


def _least(world: _World, capacity: int, *, once: bool) -> float:
    """Cover what is lowest in every way, then what is lowest of the rest; of equal sets keep the cheapest."""
    by_lowest: dict[int, list[Piece]] = defaultdict(list)
    for piece in world.pieces():
        rest = piece.holds
        while rest:
            lowest = rest & -rest
            if not once or lowest == piece.holds & -piece.holds:
                by_lowest[lowest].append(piece)
            rest ^= lowest
    found: dict[int, dict[int, float]] = {0: {0: 0.0}}
    todo = {0}
    while todo:
        covered = min(todo, key=lambda mask: ~mask & (mask + 1))  # the one whose lowest gap is lowest
        todo.remove(covered)
        if covered == world.everything:
            continue
        labels = _worth_keeping(found.pop(covered))
        for piece in by_lowest[~covered & (covered + 1)]:
            if once and piece.holds & covered:
                continue
            after = found.setdefault(covered | piece.holds, {})
            todo.add(covered | piece.holds)
            for words, cost in labels:
                total = words + piece.words
                after[total] = min(cost + piece.cost, after.get(total, inf))
    return min(
        cost + world.mixed_base * ceil(words / max(1, capacity))
        for words, cost in found[world.everything].items()
    )


def _worth_keeping(labels: dict[int, float]) -> list[tuple[int, float]]:
    """Those that cost less than all with fewer words."""
    kept: list[tuple[int, float]] = []
    for words in sorted(labels):
        if not kept or labels[words] < kept[-1][1]:
            kept.append((words, labels[words]))
    return kept
