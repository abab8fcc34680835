"""A circuit in lines of text, none wider than it may be."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Final

from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.drawing.layout import aligned, plan_of
from fatektool.ladder.drawing.text.band import Band
from fatektool.ladder.drawing.text.bands import MARK, cuts_of
from fatektool.ladder.drawing.text.canvas import DOWN, UP
from fatektool.ladder.drawing.text.cells import Writer
from fatektool.ladder.drawing.text.sheet import Sheet

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fatektool.ladder.circuit.nodes import Circuit
    from fatektool.ladder.drawing.text.canvas import Pen

NARROWEST: Final = 40
"""No drawing is made narrower than this."""


def draw(circuit: Circuit, comments: Mapping[str, str], columns: int, pen: Pen) -> Iterator[str]:
    """A circuit in lines of text.

    Args:
        circuit: it.
        comments: of elements, to stand under them.
        columns: how wide a line may be; at least ``NARROWEST``.
        pen: what it is drawn with.
    """
    if all(leaf.is_gap or leaf.role is Role.MARK for leaf in circuit.leaves):
        yield f"{pen.line(UP | DOWN)} (empty)"
        return
    columns = max(columns, NARROWEST)
    writer = Writer(pen, comments, columns - 2 * MARK - 2)
    plan = plan_of(circuit)
    sheet = Sheet(aligned(plan), writer)
    cuts = cuts_of(sheet.plan, sheet.rooms, columns)
    if len(cuts) > 2:
        sheet = Sheet(plan, writer)
        cuts = cuts_of(sheet.plan, sheet.rooms, columns)
    number = 1
    for begin, end in pairwise(cuts):
        if begin.column:
            yield ""
        yield from Band(sheet, begin, end, number, pen).lines()
        number += len(begin.rows)
