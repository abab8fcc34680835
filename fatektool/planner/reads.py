"""Reads: the requests, within the ranges of the PLC.

A plan is made while it is executed. Runs of registers in the middle of a long range are known without a
search, because there is no alternative: they come first, and the search for the rest continues by a step with
each of them. So the first request is known at once, and a search among thousands of elements is done while
the line is busy. The plan does not depend on when its requests are taken.
"""

from __future__ import annotations

from functools import cache
from itertools import chain
from typing import TYPE_CHECKING, Any

from fatektool.planner.atoms import lines_of
from fatektool.planner.costs import costs_of
from fatektool.planner.edges import Edges
from fatektool.planner.paths import Run, Search
from fatektool.protocol.commands import ReadDiscretes, ReadMixed, ReadRegisters, Request
from fatektool.protocol.elements import Element, Stretch

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from fatektool.planner.atoms import AtomLine
    from fatektool.planner.costs import Costs
    from fatektool.planner.paths import Edge
    from fatektool.protocol.codec import Codec


def plan_reads(
    elements: Iterable[Element | Stretch],
    codec: Codec,
    *,
    turnaround: float = 0.0,
    limits: Mapping[str, int] | None = None,
) -> list[Request[Any]]:
    """The requests of ``planned_reads``, all at once."""
    return list(planned_reads(elements, codec, turnaround=turnaround, limits=limits))


def planned_reads(
    elements: Iterable[Element | Stretch],
    codec: Codec,
    *,
    turnaround: float = 0.0,
    limits: Mapping[str, int] | None = None,
) -> Iterator[Request[Any]]:
    """The requests that read these elements with the least line time, one by one, as soon as they are known.

    Args:
        elements: of any kind, in any order, also twice; ranges of them are planned much faster.
        codec: the protocol.
        turnaround: the PLC's time to answer, in bytes at this baud.
        limits: the number of elements of each symbol in the PLC, if known; gaps are not read above it.

    Raises:
        UsageError: the protocol does not have one of the elements.
    """
    costs = costs_of(codec, turnaround, writes=False)
    groups = neighbourhoods(elements, codec, writes=False)
    return chain.from_iterable(_plan(lines_of(some, limits or {}), costs) for some in groups)


def neighbourhoods(
    elements: Iterable[Element | Stretch], codec: Codec, *, writes: bool
) -> list[list[Element | Stretch]]:
    """Elements in groups that can be in one run; a range that cannot, as single elements.

    Raises:
        UsageError: the protocol does not have one of them.
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


def _plan(lines: list[AtomLine], costs: Costs) -> Iterator[Request[Any]]:
    edges = Edges(lines, costs)
    edges_of = cache(lambda node: list(edges.of(node)))
    search = Search(edges.end, edges_of, costs.mixed_base, max(1, costs.mixed_words))
    steps = search.steps()
    certain: set[Run] = set()
    for run in _certain(lines, edges_of):
        certain.add(run)
        yield _read(run)
        next(steps, None)
    for _ in steps:
        pass
    mixed: list[Element] = []
    for piece in search.pieces:
        if not isinstance(piece, Run):
            mixed += piece
        elif piece not in certain:
            yield _read(piece)
    for items in packed(mixed, costs.mixed_words):
        yield ReadMixed(tuple(items))


def _certain(lines: list[AtomLine], edges_of: Callable[[int], list[Edge]]) -> Iterator[Run]:
    """The runs of all paths: from the beginning of a line to the first place with an alternative."""
    for line in lines:
        node = line.start
        while node < line.start + len(line):
            edge, *others = edges_of(node)
            if others or not isinstance(edge.piece, Run):
                break
            yield edge.piece
            node = edge.to


def _read(run: Run) -> Request[Any]:
    element = Element(run.symbol, run.first)
    if element.kind.bits == 1:
        return ReadDiscretes(element, run.length)
    return ReadRegisters(element, run.length)


def packed(elements: Iterable[Element], capacity: int) -> list[list[Element]]:
    """Mixed items in as few requests as their words allow: double words first, so that no space is lost."""
    requests: list[list[Element]] = []
    space = 0
    for element in sorted(elements, key=lambda element: -element.kind.words):
        if space < element.kind.words:
            requests.append([])
            space = capacity
        requests[-1].append(element)
        space -= element.kind.words
    return requests
