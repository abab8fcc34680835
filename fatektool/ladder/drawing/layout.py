"""A circuit -> its plan.

A line goes to the right from where it begins. What hangs on it at one place stands one below the other, in
the order of the instructions, and what goes on after it comes last. A line that takes up a stored signal
hangs where that was stored, if the way down is free; else the store is drawn as a coil, and what takes it up
as contacts of that name, which says the same.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, TypeGuard

from fatektool.ladder.circuit.nodes import Block, Box, Circuit, Leaf, Line, Node, Parallel, Part, Series
from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.drawing.plan import RAIL, BoxCell, Cell, Link, Net, Pin, Plan, Wire
from fatektool.ladder.drawing.signs import frame_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence


class _Place(NamedTuple):
    """Where a wire ends, and what it carries."""

    row: int
    column: int
    net: Net


def plan_of(circuit: Circuit) -> Plan:
    """Lay a circuit out."""
    heads = {line.head for line in _lines(circuit.lines)}
    recalls = {leaf for leaf in circuit.leaves if leaf.role is Role.RECALL}
    by_name = {leaf.store for leaf in recalls - heads}
    while True:
        layout = _Layout(by_name)
        for line in circuit.lines:
            layout.line(line)
        if layout.blocked <= by_name:
            return layout.plan
        by_name |= layout.blocked


def _lines(lines: Sequence[Line]) -> Iterator[Line]:
    """These lines, and those of the boxes on them."""
    for line in lines:
        yield line
        for part in line.parts:
            if isinstance(part, Box):
                yield from _lines((*part.inputs, *part.outputs))


def aligned(plan: Plan) -> Plan:
    """The same with the coils at the ends of lines in one column, the last."""
    last = plan.columns - 1
    taken = {(wire.row, column) for wire in plan.wires for column in range(wire.first, wire.end)}
    taken |= {(cell.row, cell.column) for cell in plan.cells}
    taken |= {(row, box.column) for box in plan.boxes for row in range(box.row, box.row + box.rows)}
    linked = {(row, link.column) for link in plan.links for row in range(link.first, link.last + 1)}
    cells, wires = [], list(plan.wires)
    for cell in plan.cells:
        way = {(cell.row, column) for column in range(cell.column + 1, last + 1)}
        if cell.ends and way and not way & (taken | linked):
            wires.append(Wire(cell.row, cell.column, last, cell.net))
            cells.append(replace(cell, column=last))
        else:
            cells.append(cell)
    return replace(plan, cells=cells, wires=wires)


class _Layout:
    """What has been laid so far.

    Args:
        by_name: the stores that are drawn as coils and contacts.
    """

    def __init__(self, by_name: set[int]) -> None:
        self.plan = Plan()
        self.blocked: set[int] = set()
        self._by_name = by_name
        self._bottom = 0  # the first row that is free in every column
        self._taps: dict[int, _Place] = {}
        self._filled: set[tuple[int, int]] = set()
        self._linked: dict[tuple[int, int], Net] = {}

    def line(self, line: Line) -> None:
        """A line below all others, from the rail or from where its signal was stored."""
        first = line.parts[0]
        if isinstance(first, Box):
            self._box(first, _Place(self._bottom, 0, RAIL), alone=True)
            return
        place, parts = self._start(line, self._bottom)
        self._row(parts, place)

    def _start(
        self, line: Line, row: int, beside: Sequence[_Place | None] = ()
    ) -> tuple[_Place, Sequence[Part]]:
        """Where a line begins, linked to where its signal comes from; and what of it is still to be laid.

        Args:
            line: it.
            row: where it is to be.
            beside: the ends of lines that will go on to the right as far as this one.
        """
        head = line.parts[0]
        if isinstance(head, Leaf) and head.role is Role.RECALL:
            tap = self._taps.get(head.store)
            rows = {end.row for end in beside if end is not None}
            if tap is not None and self._is_free(tap, row, rows):
                self._link(tap, row)
                return tap._replace(row=row), line.parts[1:]
            self.blocked.add(head.store)
            row = max(row, self._bottom)
        return _Place(row, 0, RAIL), line.parts

    def _row(self, parts: Sequence[Part], place: _Place) -> int:
        """What conducts, then what hangs there, then what goes on; give the next row that is free below."""
        parts = [part for part in parts if not (isinstance(part, Leaf) and part.role is Role.MARK)]
        below = place.row + 1
        while parts:
            count = next((number for number, part in enumerate(parts) if _hangs(part)), len(parts))
            start = place.column
            place, under = self._run([part for part in parts[:count] if not isinstance(part, Box)], place)
            if count == len(parts) and place.column == start:
                self._wire(place, start + 1)
            hanging = []
            while count < len(parts) and (_hangs(parts[count]) or _is_store(parts[count])):
                hanging.append(parts[count])
                count += 1
            parts = parts[count:]
            row, last = self._hanging(hanging, place)
            below = max(below, under, row)
            if parts and hanging:
                last = row
            self._link(place, last)
            place = place._replace(row=last)
        return max(below, place.row + 1)

    def _hanging(self, parts: Sequence[Part], place: _Place) -> tuple[int, int]:
        """Coils and boxes, one below the other; give the next free row below, and the row of the last."""
        row = last = place.row
        for part in parts:
            if _is_store(part) and part.store not in self._by_name:
                self._taps[part.store] = place
                continue
            last = row
            if isinstance(part, Box):
                row = self._box(part, place._replace(row=row))
            else:
                assert isinstance(part, Leaf)  # noqa: S101  # a coil, or a store that is drawn as one
                self._cell(part, place._replace(row=row), ends=True)
                row += 1
        return row, last

    def _run(self, nodes: Sequence[Node], place: _Place) -> tuple[_Place, int]:
        """What conducts, one after the other; give its end, and the next row that is free below."""
        below = place.row + 1
        for node in nodes:
            if _is_store(node) and node.store not in self._by_name:
                self._taps[node.store] = place
                continue
            place, under = self._node(node, place)
            below = max(below, under)
        return place, below

    def _node(self, node: Node, place: _Place) -> tuple[_Place, int]:
        match node:
            case Series(parts):
                return self._series(parts, place)
            case Parallel(branches):
                return self._parallel(branches, place)
            case Block(body):
                return self._node(body, place)
        if node.is_wire or node.role is Role.MARK:
            return place, place.row + 1
        self._cell(node, place)
        return _Place(place.row, place.column + 1, (node.number,)), place.row + 1

    def _series(self, parts: Sequence[Node], place: _Place) -> tuple[_Place, int]:
        below = place.row + 1
        for part in parts:
            place, under = self._node(part, place)
            below = max(below, under)
        return place, below

    def _parallel(self, branches: Sequence[Node], place: _Place) -> tuple[_Place, int]:
        ends: list[_Place] = []
        row = place.row
        for branch in branches:
            end, row = self._node(branch, place._replace(row=row))
            ends.append(end)
        column = max(place.column + 1, *(end.column for end in ends))
        for end in ends:
            self._wire(end, column)
        nets = [end.net for end in ends]
        either = tuple(dict.fromkeys(number for net in nets for number in net))
        joint = _Place(place.row, column, place.net if place.net in nets else either)  # past a branch of wire
        self._link(place, ends[-1].row)
        self._link(joint, ends[-1].row)
        return joint, row

    def _box(self, box: Box, place: _Place, *, alone: bool = False) -> int:
        """A function: first the lines that enter it, then its box, then the lines that leave it."""
        ends: list[_Place | None] = [None if alone else place]
        rows = [place.row]
        for line in box.inputs:
            row = max(rows[-1] + 1, self._bottom)
            start, parts = self._start(line, row, ends)
            rows.append(start.row)
            if [part.is_gap for part in parts if isinstance(part, Leaf)] == [True] and len(parts) == 1:
                ends.append(None)  # nothing leads to it
                continue
            nodes = [part for part in parts if not isinstance(part, Box)]
            place_of_end, below = self._run(nodes, start)
            self._bottom = max(self._bottom, below)
            ends.append(place_of_end)
        column = max([place.column, *(end.column for end in ends if end is not None)])
        for end in ends:
            if end is not None:
                self._wire(end, column)
        nets = [None if end is None else end.net for end in ends]
        inputs = tuple(
            Pin(row, number, net) for number, (row, net) in enumerate(zip(rows, nets, strict=True))
        )
        outputs, below = self._outputs(box, place.row, column + 1)
        last = max(pin.row for pin in (*inputs, *outputs))
        self.plan.boxes.append(
            BoxCell(place.row, last - place.row + 1, column, box.function, inputs, tuple(outputs))
        )
        if column == 0:
            self.plan.begins |= {pin.row for pin in inputs if pin.net == RAIL}
        self._fill(range(place.row, last + 1), range(column, column + 1))
        return max(below, last + 1)

    def _outputs(self, box: Box, row: int, column: int) -> tuple[list[Pin], int]:
        """The lines that leave a function, one below the other; and the outputs that are not used."""
        pins: list[Pin] = []
        below = row
        for line in box.outputs:
            head = line.parts[0]
            if isinstance(head, Leaf) and head.role is Role.MARK:
                continue
            if isinstance(head, Leaf) and head.role is Role.OUTPUT:
                pin = Pin(max(below, row + head.output), head.output, (head.number,))
                pins.append(pin)
                below = self._row(line.parts[1:], _Place(pin.row, column, (head.number,)))
            else:
                start, parts = self._start(line, below)
                below = self._row(parts, start)
        used = {pin.number for pin in pins}
        taken = {pin.row for pin in pins}
        named = range(len(frame_of(box.function).outputs))
        free = [number for number in named if number not in used and row + number not in taken]
        pins += [Pin(row + number, number, None) for number in free]
        return sorted(pins, key=lambda pin: pin.row), below

    def _cell(self, leaf: Leaf, place: _Place, *, ends: bool = False) -> None:
        self.plan.cells.append(Cell(place.row, place.column, leaf, place.net, ends))
        self._fill(range(place.row, place.row + 1), range(place.column, place.column + 1))
        self._begin(place)

    def _wire(self, end: _Place, column: int) -> None:
        if end.column < column:
            self.plan.wires.append(Wire(end.row, end.column, column, end.net))
            self._fill(range(end.row, end.row + 1), range(end.column, column))
            self._begin(end)

    def _begin(self, place: _Place) -> None:
        if place.column == 0 and place.net == RAIL:
            self.plan.begins.add(place.row)

    def _link(self, place: _Place, row: int) -> None:
        """A wire down to a row; at the rail there is one already."""
        if row > place.row and (place.column or place.net != RAIL):
            self.plan.links.append(Link(place.column, place.row, row, place.net))
            self._linked |= {(each, place.column): place.net for each in range(place.row, row)}

    def _fill(self, rows: range, columns: range) -> None:
        self._filled |= {(row, column) for row in rows for column in columns}
        self._bottom = max(self._bottom, rows.stop)

    def _is_free(self, tap: _Place, row: int, taken: set[int]) -> bool:
        """True if a wire from here down to a row meets nothing on its way but what carries the same.

        Args:
            tap: where it begins.
            row: where it ends.
            taken: rows through which a wire will go.
        """
        for each in range(tap.row + 1, row + 1):
            beside = {(each, tap.column - 1), (each, tap.column)} & self._filled or each in taken
            if beside and self._linked.get((each - 1, tap.column)) != tap.net:
                return False
        return True


def _hangs(part: Part) -> bool:
    """True for what takes what a line carries, and leaves it there."""
    return isinstance(part, Box) or (isinstance(part, Leaf) and part.role is Role.COIL)


def _is_store(part: Part) -> TypeGuard[Leaf]:
    return isinstance(part, Leaf) and part.role is Role.STORE
