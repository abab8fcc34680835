"""What a plain client would send: the planner is measured against it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.protocol.commands import ReadDiscretes, ReadRegisters, Request
from fatektool.protocol.elements import KINDS, Element
from tests.planner.exhaustive import places

if TYPE_CHECKING:
    from collections.abc import Iterable

GAP: Final = 16


def one_each(elements: Iterable[Element]) -> list[Request[Any]]:
    """A request for each element."""
    return [_read(element, 1) for element in sorted(set(elements))]


def merged(elements: Iterable[Element]) -> list[Request[Any]]:
    """Runs that go on over gaps of 16: registers by 46, discretes by 44."""
    runs: list[tuple[str, int, int]] = []
    for area, begin, end in sorted({places(element.symbol, element.address) for element in elements}):
        most = 256 if area in "XYMSTC" else 64 // KINDS[area.partition(" ")[0]].words
        if runs:
            before, first, last = runs[-1]
            if before == area and begin - last <= GAP and max(end, last) - first <= most:
                runs[-1] = (area, first, max(end, last))
                continue
        runs.append((area, begin, end))
    return [_run(*run) for run in runs]


def _run(area: str, begin: int, end: int) -> Request[Any]:
    symbol, _, parity = area.partition(" ")
    return _read(Element(symbol, 2 * begin + (parity == "odd") if parity else begin), end - begin)


def _read(first: Element, count: int) -> Request[Any]:
    return ReadDiscretes(first, count) if first.kind.bits == 1 else ReadRegisters(first, count)
