"""One band of a sheet: where its wires, signs, boxes and texts are, in lines and columns of text.

::

            names                  the edge of a box
    wire ───┤ ├────────────────────┤EN  S:0
            comments               the box goes on, and ends

A row of the plan takes one line for its wire, those above and below that are needed, and no more. The place
where a column begins is a column of characters for itself, so that links and edges of boxes never meet.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.ladder.drawing.plan import RAIL, net_at
from fatektool.ladder.drawing.text.bands import MARK, Cut
from fatektool.ladder.drawing.text.letters import width_of
from fatektool.ladder.drawing.text.surface import Anchor

if TYPE_CHECKING:
    from fatektool.ladder.drawing.plan import BoxCell, Cell, Link
    from fatektool.ladder.drawing.text.cells import BoxText, SignText
    from fatektool.ladder.drawing.text.sheet import Sheet
    from fatektool.ladder.drawing.text.surface import Surface


class Band:
    """The columns between two cuts.

    Args:
        sheet: the sheet.
        begin: the first cut.
        end: the second.
        number: of the first wire that is cut at the first.
        onward: the mark of a wire that goes on below.
    """

    def __init__(self, sheet: Sheet, begin: Cut, end: Cut, number: int, onward: str) -> None:
        self._begin, self._end, self._number, self._onward = begin, end, number, onward
        self._plan = sheet.plan
        self._columns = range(begin.column, end.column)
        self._signs = [(cell, text) for cell, text in sheet.signs if cell.column in self._columns]
        self._boxes = [(box, text) for box, text in sheet.boxes if box.column in self._columns]
        self._wires = [
            (wire.row, max(wire.first, begin.column), min(wire.end, end.column), wire.net)
            for wire in sheet.plan.wires
            if wire.first < end.column and wire.end > begin.column
        ]
        self._links = [link for link in sheet.plan.links if self._has(link)]
        self._rail = sorted(sheet.plan.begins) if begin.column == 0 else []
        at = MARK if begin.column else 0
        self._at = {begin.column: at}
        for column in self._columns:
            at += 1 + sheet.widths[column]
            self._at[column + 1] = at
        self._line_of: dict[int, int] = {}
        self._height = self._lay_rows()

    @property
    def lines(self) -> int:
        """How many lines it takes."""
        return self._height

    def draw_on(self, surface: Surface) -> None:
        """Draw it."""
        for row, first, end, net in self._wires:
            surface.across(self._line_of[row], self._at[first], self._at[end], net)
        for link in self._links:
            first, last = self._line_of[link.first], self._line_of[link.last]
            surface.down(self._at[link.column], first, last, link.net)
        for cell, sign in self._signs:
            self._draw_sign(surface, cell, sign)
        for box, text in self._boxes:
            self._draw_box(surface, box, text)
        self._draw_ends(surface)

    def _has(self, link: Link) -> bool:
        if link.column == self._end.column:
            return self._end.links_before
        if link.column == self._begin.column:
            return not self._begin.links_before
        return link.column in self._columns

    def _lay_rows(self) -> int:
        """Give each row a line for its wire; give the number of lines in all."""
        above: set[int] = {cell.row for cell, sign in self._signs if sign.name}
        above |= {box.row for box, _ in self._boxes}
        rows = above | {cell.row for cell, _ in self._signs} | {row for row, _, _, _ in self._wires}
        rows |= {row for link in self._links for row in (link.first, link.last)}
        rows |= {*self._begin.rows, *self._end.rows}
        for box, _ in self._boxes:
            rows |= {pin.row for pin in (*box.inputs, *box.outputs)} | {box.row + box.rows - 1}
        line = 0
        for row in sorted(rows):
            line += row in above
            self._line_of[row] = line
            below = max((len(sign.below) for cell, sign in self._signs if cell.row == row), default=0)
            for box, text in self._boxes:
                if box.row + box.rows - 1 == row:
                    below = max(below, self._foot(box, text) - line)
            line += 1 + below
        return line

    def _foot(self, box: BoxCell, text: BoxText) -> int:
        """The line of a box's lower edge."""
        last = self._line_of[box.row + box.rows - 1]
        return max(last + 1, self._line_of[box.row] + len(text.settings))

    def _draw_sign(self, surface: Surface, cell: Cell, sign: SignText) -> None:
        line, left, right = self._line_of[cell.row], self._at[cell.column], self._at[cell.column + 1]
        first = left + 1 + (right - left - 1 - width_of(sign.sign)) // 2
        last = first + width_of(sign.sign) - 1
        surface.across(line, left, first, cell.net)
        if not cell.ends:
            surface.across(line, last, right, (cell.leaf.number,))
        surface.sign(line, first, sign, cell.leaf.number)
        for place, text in enumerate((sign.name, "", *sign.below), line - 1):
            if text:
                middle = left + 1 + (right - left - 1 - width_of(text)) // 2
                surface.write(place, middle, text, Anchor.MIDDLE, quiet=place > line)

    def _draw_box(self, surface: Surface, box: BoxCell, text: BoxText) -> None:
        left, right = self._at[box.column] + 1, self._at[box.column + 1] - 1
        top = self._line_of[box.row] - 1
        surface.frame((top, self._foot(box, text)), (left, right), text.title, box.leaf.number)
        for line, setting in enumerate(text.settings, top + 1):
            surface.write(line, left + 2 + text.before, setting)
        for pin, name in zip(box.inputs, text.inputs, strict=True):
            surface.write(self._line_of[pin.row], left + 1, name)
            if pin.net is not None:
                surface.across(self._line_of[pin.row], left - 1, left, pin.net)
        for pin, name in zip(box.outputs, text.outputs, strict=True):
            surface.write(self._line_of[pin.row], right - width_of(name), name, Anchor.END)
            if pin.net is not None:
                surface.across(self._line_of[pin.row], right, right + 1, pin.net)

    def _draw_ends(self, surface: Surface) -> None:
        """The rail, and the marks of wires that were cut."""
        if self._begin.column == 0:
            surface.rail(self._height)
            for row in self._rail:
                if row in self._line_of:
                    surface.across(self._line_of[row], 0, 1, RAIL)
        for number, row in enumerate(self._begin.rows, self._number):
            mark = f"{number:>{MARK - 2}}{self._onward}"
            net = net_at(self._plan, row, self._begin.column)
            surface.across(self._line_of[row], MARK - 1, MARK, net)
            surface.write(self._line_of[row], MARK - 1 - len(mark), mark, Anchor.END)
        after = self._at[self._end.column]
        for number, row in enumerate(self._end.rows, self._number + len(self._begin.rows)):
            net = net_at(self._plan, row, self._end.column)
            surface.across(self._line_of[row], after, after + 1, net)
            surface.write(self._line_of[row], after + 1, f"{self._onward}{number}")
