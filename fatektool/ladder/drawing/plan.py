"""Where the parts of a circuit stand: rows and columns, wires along the rows, links from row to row.

::

    column     0         1       2
    row 0   ├──┤ ├──┬────┤ ├────( )       cells: a sign each
    row 1   ├──┤ ├──┘                     a link at the place where column 1 begins, from row 0 to row 1

A wire or link is what carries one signal: that of the leaves before it, whose numbers are its net; it carries
where one of them does. The rail has the net of no leaf. So what conducts can be shown for any drawing of it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from fatektool.ladder.circuit.nodes import Leaf

Net: TypeAlias = tuple[int, ...]
RAIL: Net = ()


@dataclass(frozen=True, slots=True)
class Cell:
    """A sign.

    Attributes:
        row: from 0.
        column: from 0.
        leaf: what stands there.
        net: what leads to it.
        ends: nothing leads on from it.
    """

    row: int
    column: int
    leaf: Leaf
    net: Net
    ends: bool = False


@dataclass(frozen=True, slots=True)
class Wire:
    """A wire through columns ``first`` to ``end``, that not included."""

    row: int
    first: int
    end: int
    net: Net


@dataclass(frozen=True, slots=True)
class Link:
    """A wire from one row down to another, where a column begins."""

    column: int
    first: int
    last: int
    net: Net


@dataclass(frozen=True, slots=True)
class Pin:
    """Where a line enters or leaves a box.

    Attributes:
        row: the drawing's.
        number: which input or output.
        net: what it carries; None where nothing leads to or from it.
    """

    row: int
    number: int
    net: Net | None


@dataclass(frozen=True, slots=True)
class BoxCell:
    """A function's box, one column wide.

    Attributes:
        row: its first.
        rows: how many.
        column: from 0.
        leaf: the function.
        inputs: its inputs.
        outputs: its outputs, those that are used and those that have names.
    """

    row: int
    rows: int
    column: int
    leaf: Leaf
    inputs: tuple[Pin, ...]
    outputs: tuple[Pin, ...]


@dataclass
class Plan:
    """A circuit, laid out.

    Attributes:
        cells: the signs.
        boxes: the functions.
        wires: along the rows.
        links: from row to row.
        begins: the rows that begin at the rail.
    """

    cells: list[Cell] = field(default_factory=list)
    boxes: list[BoxCell] = field(default_factory=list)
    wires: list[Wire] = field(default_factory=list)
    links: list[Link] = field(default_factory=list)
    begins: set[int] = field(default_factory=set)

    @property
    def columns(self) -> int:
        """How many columns it has."""
        ends = [cell.column + 1 for cell in self.cells] + [box.column + 1 for box in self.boxes]
        return max([*ends, *(wire.end for wire in self.wires)], default=0)

    @property
    def rows(self) -> int:
        """How many rows it has."""
        ends = [cell.row + 1 for cell in self.cells] + [box.row + box.rows for box in self.boxes]
        return max([*ends, *(wire.row + 1 for wire in self.wires)], default=0)


def net_at(plan: Plan, row: int, column: int) -> Net | None:
    """What the wire carries that goes through a row before a column; None if there is none."""
    for wire in plan.wires:
        if wire.row == row and wire.first <= column <= wire.end:
            return wire.net
    for cell in plan.cells:
        if cell.row == row and cell.column == column:
            return cell.net
        if cell.row == row and cell.column + 1 == column and not cell.ends:
            return (cell.leaf.number,)
    for box in plan.boxes:
        pins = box.inputs if box.column == column else box.outputs if box.column + 1 == column else ()
        for pin in pins:
            if pin.row == row:
                return pin.net
    return None
