"""Reads: the requests, and nothing past what the PLC has."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.planner.atoms import lines_of
from fatektool.planner.costs import Costs
from fatektool.planner.edges import Edges
from fatektool.planner.paths import Run, least_path
from fatektool.protocol.commands import ReadDiscretes, ReadMixed, ReadRegisters, Request
from fatektool.protocol.elements import Element, Stretch

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from fatektool.planner.atoms import Line
    from fatektool.protocol.codec import Codec


def plan_reads(
    elements: Iterable[Element | Stretch],
    codec: Codec,
    *,
    turnaround: float = 0.0,
    limits: Mapping[str, int] | None = None,
) -> list[Request[Any]]:
    """The requests that read these elements with the least line time.

    Args:
        elements: of any kind, in any order, also twice; stretches of them are planned much faster.
        codec: the protocol.
        turnaround: the PLC's time to answer, in bytes at this baud.
        limits: how many of a kind the PLC has, by symbol, where that is known; beyond what is wanted nothing
            is read past it.

    Raises:
        UsageError: the protocol cannot name one of the elements.
    """
    costs = Costs(codec, turnaround, writes=False)
    requests: list[Request[Any]] = []
    for some in neighbourhoods(elements, codec, writes=False):
        requests += _plan(lines_of(some, limits or {}), costs)
    return requests


def neighbourhoods(
    elements: Iterable[Element | Stretch], codec: Codec, *, writes: bool
) -> list[list[Element | Stretch]]:
    """Elements by what can share a run; a stretch that cannot, in its elements.

    Raises:
        UsageError: the protocol cannot name one of them.
    """
    found: dict[int, list[Element | Stretch]] = {}
    for each in elements:
        if isinstance(each, Stretch):
            number = codec.neighbourhood(each.first, writes=writes)
            if number == codec.neighbourhood(each.last, writes=writes):
                found.setdefault(number, []).append(each)
                continue
        for element in each if isinstance(each, Stretch) else [each]:
            found.setdefault(codec.neighbourhood(element, writes=writes), []).append(element)
    return [found[number] for number in sorted(found)]


def _plan(lines: list[Line], costs: Costs) -> list[Request[Any]]:
    edges = Edges(lines, costs)
    requests: list[Request[Any]] = []
    mixed: list[Element] = []
    for piece in least_path(edges.end, edges.of, costs.mixed_base, max(1, costs.mixed_words)):
        if isinstance(piece, Run):
            requests.append(_read(piece))
        else:
            mixed += piece
    return requests + [ReadMixed(tuple(items)) for items in packed(mixed, costs.mixed_words)]


def _read(run: Run) -> Request[Any]:
    element = Element(run.symbol, run.first)
    if element.kind.bits == 1:
        return ReadDiscretes(element, run.length)
    return ReadRegisters(element, run.length)


def packed(elements: Iterable[Element], capacity: int) -> list[list[Element]]:
    """Mixed items in as few requests as their words allow: the double ones first, so that none is lost."""
    requests: list[list[Element]] = []
    space = 0
    for element in sorted(elements, key=lambda element: -element.kind.words):
        if space < element.kind.words:
            requests.append([])
            space = capacity
        requests[-1].append(element)
        space -= element.kind.words
    return requests
