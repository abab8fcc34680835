"""Writes: the requests, which write each given atom once, and no others.

A value that is written twice may have its effect in the program twice, so no two requests overlap.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.planner.atoms import Atom, lines_of, parts_of, value_of
from fatektool.planner.costs import costs_of
from fatektool.planner.edges import Edges
from fatektool.planner.paths import Run, least_path
from fatektool.planner.reads import neighbourhoods, packed
from fatektool.protocol.commands import Request, WriteDiscretes, WriteMixed, WriteRegisters
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.planner.atoms import AtomLine
    from fatektool.planner.costs import Costs
    from fatektool.protocol.codec import Codec


def plan_writes(
    items: Iterable[tuple[Element, int]], codec: Codec, *, turnaround: float = 0.0
) -> list[Request[None]]:
    """The requests that write these values with the least line time.

    Args:
        items: elements with their values, unsigned; no two may share an atom.
        codec: the protocol.
        turnaround: the PLC's time to answer, in bytes at this baud.

    Raises:
        UsageError: the protocol does not have one of the elements, or cannot write it.
    """
    wanted = list(items)
    parts: dict[Atom, int] = {}
    for element, value in wanted:
        parts |= parts_of(element, value)
    costs = costs_of(codec, turnaround, writes=True)
    requests: list[Request[None]] = []
    for some in neighbourhoods((element for element, _ in wanted), codec, writes=True):
        requests += _plan(lines_of(some, None), parts, costs)
    return requests


def _plan(lines: list[AtomLine], parts: dict[Atom, int], costs: Costs) -> list[Request[None]]:
    edges = Edges(lines, costs)
    requests: list[Request[None]] = []
    mixed: list[Element] = []
    for piece in least_path(edges.end, edges.of, costs.mixed_base, max(1, costs.mixed_words)):
        if isinstance(piece, Run):
            requests.append(_write(parts, piece))
        else:
            mixed += piece
    return requests + [
        WriteMixed(tuple((element, value_of(element, parts)) for element in some))
        for some in packed(mixed, costs.mixed_words)
    ]


def _write(parts: dict[Atom, int], run: Run) -> Request[None]:
    element = Element(run.symbol, run.first)
    values = [value_of(element.after(place), parts) for place in range(run.length)]
    if element.kind.bits == 1:
        return WriteDiscretes(element, tuple(map(bool, values)))
    return WriteRegisters(element, tuple(values))
