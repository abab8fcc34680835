"""What a drawing joins, found from the drawing alone: by its plan, and by its characters.

Both give the same kind of answer: which places where a wire meets a sign or a box are joined. A place is the
number of an instruction and a side: ``(12, "left")``, ``(30, "input 1 2")``.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, TypeAlias

from fatektool.ladder.drawing.plan import RAIL, BoxCell, Pin, Plan
from fatektool.ladder.drawing.text.band import Band
from fatektool.ladder.drawing.text.bands import MARK, Cut
from fatektool.ladder.drawing.text.canvas import Canvas
from fatektool.ladder.drawing.text.letters import Letters, width_of
from fatektool.ladder.drawing.text.pen import _BOX, DOWN, LEFT, RIGHT, UP, Pen

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Iterator

    from fatektool.ladder.drawing.text.sheet import Sheet

Terminal: TypeAlias = tuple[int, str]
WAYS = {character: ways for ways, character in _BOX.items() if ways not in {LEFT, RIGHT, UP, DOWN}}
RAIL_END: Terminal = (-1, "rail")


class _Groups:
    """Things that are joined with one another."""

    def __init__(self) -> None:
        self._above: dict[Hashable, Hashable] = {}

    def of(self, thing: Hashable) -> Hashable:
        while thing in self._above:
            thing = self._above[thing]
        return thing

    def join(self, one: Hashable, other: Hashable) -> None:
        one, other = self.of(one), self.of(other)
        if one != other:
            self._above[one] = other


def _joined(groups: _Groups, terminals: Iterable[tuple[Terminal, Hashable]]) -> set[frozenset[Terminal]]:
    found: dict[Hashable, set[Terminal]] = defaultdict(set)
    for terminal, place in terminals:
        found[groups.of(place)].add(terminal)
    return {frozenset(each) for each in found.values()}


def by_plan(plan: Plan) -> set[frozenset[Terminal]]:
    """What the wires and links of a plan join; a place is a row and where a column begins."""
    groups = _Groups()
    for wire in plan.wires:
        groups.join((wire.row, wire.first), (wire.row, wire.end))
    for link in plan.links:
        for row in range(link.first, link.last):
            groups.join((row, link.column), (row + 1, link.column))
    for row in plan.begins:
        groups.join(RAIL, (row, 0))
    return _joined(groups, [*_terminals(plan), (RAIL_END, RAIL)])


def _terminals(plan: Plan) -> Iterator[tuple[Terminal, Hashable]]:
    for cell in plan.cells:
        yield (cell.leaf.number, "left"), (cell.row, cell.column)
        if not cell.ends:
            yield (cell.leaf.number, "right"), (cell.row, cell.column + 1)
    for box in plan.boxes:
        for side, pins, column in (
            ("input", box.inputs, box.column),
            ("output", box.outputs, box.column + 1),
        ):
            for pin in pins:
                place = (
                    (pin.row, column) if pin.net is not None else ("open", side, box.leaf.number, pin.number)
                )
                yield (box.leaf.number, f"{side} {pin.number} {pin.row}"), place


def by_characters(sheet: Sheet, cuts: list[tuple[Cut, Cut]]) -> set[frozenset[Terminal]]:
    """What the characters of all bands join; a place is a band, a line and a column of text."""
    groups, number = _Groups(), 1
    terminals: list[tuple[Terminal, Hashable]] = []
    for count, (begin, end) in enumerate(cuts):
        band, canvas = Band(sheet, begin, end, number, "►"), Canvas(Pen(Letters()))
        band.draw_on(canvas)
        lines = [_columns(line) for line in canvas.lines()]
        inside = set(_covered(band))
        for line, characters in enumerate(lines):
            for column, character in enumerate(characters):
                if (line, column) in inside or character not in WAYS:
                    continue
                here = (count, line, column)
                if WAYS[character] & RIGHT and _leads(lines, line, column + 1, LEFT, inside):
                    groups.join(here, (count, line, column + 1))
                if WAYS[character] & DOWN and _leads(lines, line + 1, column, UP, inside):
                    groups.join(here, (count, line + 1, column))
        for offset, row in enumerate(begin.rows):
            groups.join(("mark", number + offset), (count, band._line_of[row], MARK - 1))
        for offset, row in enumerate(end.rows):
            column = band._at[end.column]
            groups.join(("mark", number + len(begin.rows) + offset), (count, band._line_of[row], column))
        if begin.column == 0:
            groups.join(RAIL, (count, 0, 0))
        terminals += _text_terminals(band, count)
        number += len(begin.rows)
    return _joined(groups, [*terminals, (RAIL_END, RAIL)])


def _columns(line: str) -> str:
    """A line with one character a column."""
    return "".join(character * max(width_of(character), 0) for character in line)


def _leads(lines: list[str], line: int, column: int, way: int, inside: set[tuple[int, int]]) -> bool:
    if line >= len(lines) or column >= len(lines[line]) or (line, column) in inside:
        return False
    return bool(WAYS.get(lines[line][column], 0) & way)


def _covered(band: Band) -> Iterator[tuple[int, int]]:
    """The places of signs and boxes, edges included, and of names and comments: no wires."""
    for cell, sign in band._signs:
        line, left, right = band._line_of[cell.row], band._at[cell.column], band._at[cell.column + 1]
        start = left + 1 + (right - left - 1 - width_of(sign.sign)) // 2
        yield from ((line, column) for column in range(start, start + width_of(sign.sign)))
        beside = [*([line - 1] if sign.name else []), *range(line + 1, line + 1 + len(sign.below))]
        yield from ((each, column) for each in beside for column in range(left + 1, right))
    for box, text in band._boxes:
        lines = range(band._line_of[box.row] - 1, band._foot(box, text) + 1)
        columns = range(band._at[box.column] + 1, band._at[box.column + 1])
        yield from ((line, column) for line in lines for column in columns)


def _text_terminals(band: Band, count: int) -> Iterator[tuple[Terminal, Hashable]]:
    for cell, sign in band._signs:
        line, left, right = band._line_of[cell.row], band._at[cell.column], band._at[cell.column + 1]
        start = left + 1 + (right - left - 1 - width_of(sign.sign)) // 2
        yield (cell.leaf.number, "left"), (count, line, start - 1)
        if not cell.ends:
            yield (cell.leaf.number, "right"), (count, line, start + width_of(sign.sign))
    for box, _ in band._boxes:
        for terminal, pin, right in _pins(box):
            place = count, band._line_of[pin.row], band._at[box.column + right]
            yield terminal, place if pin.net is not None else ("open", terminal)


def _pins(box: BoxCell) -> Iterator[tuple[Terminal, Pin, int]]:
    """The pins of a box, with 0 for its left side and 1 for its right."""
    for right, (side, pins) in enumerate((("input", box.inputs), ("output", box.outputs))):
        for pin in pins:
            yield (box.leaf.number, f"{side} {pin.number} {pin.row}"), pin, right
