"""A circuit in lines of text, none wider than it may be."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Final

from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.drawing.layout import aligned, plan_of
from fatektool.ladder.drawing.text.band import Band
from fatektool.ladder.drawing.text.bands import MARK, cuts_of
from fatektool.ladder.drawing.text.canvas import Canvas
from fatektool.ladder.drawing.text.cells import Writer
from fatektool.ladder.drawing.text.pen import DOWN, UP, Pen
from fatektool.ladder.drawing.text.sheet import Sheet

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fatektool.ladder.circuit.nodes import Circuit
    from fatektool.ladder.drawing.text.states import LiveStates

NARROWEST: Final = 40
"""No drawing is made narrower than this."""


def is_empty(circuit: Circuit) -> bool:
    """True for a network without anything in it."""
    return all(leaf.is_gap or leaf.role is Role.MARK for leaf in circuit.leaves)


def draw(circuit: Circuit, comments: Mapping[str, str], columns: int, pen: Pen) -> Iterator[str]:
    """A circuit in lines of text.

    Args:
        circuit: it.
        comments: of elements, to stand under them.
        columns: how wide a line may be; at least ``NARROWEST``.
        pen: what it is drawn with.
    """
    if is_empty(circuit):
        yield f"{pen.line(UP | DOWN)} (empty)"
    for count, band in enumerate(bands_of(circuit, comments, columns, pen)):
        if count:
            yield ""
        canvas = Canvas(pen)
        band.draw_on(canvas)
        yield from canvas.lines()


def bands_of(
    circuit: Circuit,
    comments: Mapping[str, str],
    columns: int,
    pen: Pen,
    states: LiveStates | None = None,
) -> list[Band]:
    """A circuit in bands that are no wider than they may be; none of an empty network.

    Args:
        circuit: it.
        comments: of elements, to stand under them.
        columns: how wide a band may be; at least ``NARROWEST``.
        pen: what it will be drawn with.
        states: what is written beside the program; None for nothing.
    """
    if is_empty(circuit):
        return []
    columns = max(columns, NARROWEST)
    writer = Writer(pen, comments, columns - 2 * MARK - 2, states)
    plan = plan_of(circuit)
    sheet = Sheet(aligned(plan), writer)
    cuts = cuts_of(sheet.plan, sheet.widths, columns)
    if len(cuts) > 2:
        sheet = Sheet(plan, writer)
        cuts = cuts_of(sheet.plan, sheet.widths, columns)
    bands, number = [], 1
    for begin, end in pairwise(cuts):
        bands.append(Band(sheet, begin, end, number, pen.onward))
        number += len(begin.rows)
    return bands
