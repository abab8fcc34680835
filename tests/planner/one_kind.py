"""The least that many registers of one kind can cost, by a table from the first to the last.

Registers of 16 bits of one kind, in order. A run that begins at one and ends at another holds all between
them, so what is best covers them in blocks, one behind the other: a run, an item, an item of two neighbours.
The table keeps, for the first so many registers, the least cost for each number of mixed words; all mixed
words of a plan together fill as few requests as they can. So it is exact, within the bytes that the codec
gives, for sets of hundreds, where trying everything ends with a dozen. It says nothing of several kinds, nor
of discretes.
"""

from __future__ import annotations

from math import ceil, inf
from typing import TYPE_CHECKING, Any

from fatektool.protocol.commands import ReadMixed, ReadRegisters, Request, WriteMixed, WriteRegisters
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.protocol.codec import Codec
    from tests.planner.exhaustive import Caps


class _Bytes:
    """What runs and items of one kind cost."""

    def __init__(self, symbol: str, codec: Codec, turnaround: float, caps: Caps, *, writes: bool) -> None:
        self._symbol = symbol
        self._codec = codec
        self._turnaround = turnaround
        self._writes = writes
        self.runs = [0.0] + [self._run(count) for count in range(1, caps.words + 1)]
        self.mixed = caps.mixed
        if caps.mixed:
            self.item, self.base = self._items(symbol)
            self.pair, _ = self._items(f"D{symbol}")

    def _wire(self, request: Request[Any]) -> float:
        return self._codec.request_bytes(request) + self._codec.answer_bytes(request)

    def _run(self, count: int) -> float:
        first = Element(self._symbol, 0)
        request = WriteRegisters(first, (0,) * count) if self._writes else ReadRegisters(first, count)
        return self._wire(request) + self._turnaround

    def _items(self, symbol: str) -> tuple[float, float]:
        """Bytes of an item, and of a request without any."""
        element = Element(symbol, 0)
        one, two = (
            self._wire(WriteMixed(((element, 0),) * count) if self._writes else ReadMixed((element,) * count))
            for count in (1, 2)
        )
        return two - one, 2 * one - two + self._turnaround


def least_of_registers(
    symbol: str,
    addresses: set[int],
    codec: Codec,
    turnaround: float,
    caps: Caps,
    *,
    writes: bool = False,
) -> float:
    """The cost of the cheapest reads of these registers, or of the cheapest writes."""
    size = _Bytes(symbol, codec, turnaround, caps, writes=writes)
    wanted = sorted(addresses)
    least: list[dict[int, float]] = [{} for _ in range(len(wanted) + 1)]
    least[0][0] = 0.0
    for place in range(len(wanted)):
        labels = _undominated(least[place])
        for to, cost, words in _blocks(wanted, place, size, writes=writes):
            after = least[to]
            for so_far, spent in labels:
                total = so_far + words
                if spent + cost < after.get(total, inf):
                    after[total] = spent + cost
    ends = _undominated(least[-1])
    if not size.mixed:
        return ends[0][1]
    return min(cost + size.base * ceil(words / size.mixed) for words, cost in ends)


def _blocks(wanted: list[int], place: int, size: _Bytes, *, writes: bool) -> Iterator[tuple[int, float, int]]:
    """What may begin at a place: where it ends, its bytes, its mixed words."""
    first = wanted[place]
    for to in range(place + 1, len(wanted) + 1):
        length = wanted[to - 1] - first + 1
        if length >= len(size.runs) or (writes and length > to - place):
            break
        yield to, size.runs[length], 0
    if size.mixed:
        yield place + 1, size.item, 1
        if place + 1 < len(wanted) and wanted[place + 1] == first + 1:
            yield place + 2, size.pair, 2


def _undominated(labels: dict[int, float]) -> list[tuple[int, float]]:
    kept: list[tuple[int, float]] = []
    for words in sorted(labels):
        if not kept or labels[words] < kept[-1][1]:
            kept.append((words, labels[words]))
    return kept
