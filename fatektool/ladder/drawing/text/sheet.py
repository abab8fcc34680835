"""A plan with its texts: what is written at each of its signs and boxes, and how wide each column is."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fatektool.ladder.drawing.plan import BoxCell, Cell, Plan
    from fatektool.ladder.drawing.text.cells import BoxText, SignText, Writer


class Sheet:
    """A plan with its texts.

    Args:
        plan: it.
        writer: writes its signs and boxes.

    Attributes:
        plan: it.
        signs: its signs.
        boxes: its boxes.
        widths: the characters that each column takes.
    """

    def __init__(self, plan: Plan, writer: Writer) -> None:
        self.plan = plan
        self.signs: list[tuple[Cell, SignText]] = [(cell, writer.sign(cell.leaf)) for cell in plan.cells]
        self.boxes: list[tuple[BoxCell, BoxText]] = [(box, writer.box(box)) for box in plan.boxes]
        self.widths = [1] * plan.columns
        for cell, sign in self.signs:
            self.widths[cell.column] = max(self.widths[cell.column], sign.width)
        for box, text in self.boxes:
            self.widths[box.column] = max(self.widths[box.column], text.width)
