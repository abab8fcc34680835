"""A plan that is too wide, cut between columns into bands, one below the other.

Where a cut goes through a wire, a number stands at its end and again where it goes on. A cut is made where it
goes through the fewest wires; a link at that place belongs to the band in which that is so.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from fatektool.ladder.drawing.plan import Plan

MARK: Final = 4
"""The columns of a mark: ``►12``, ``12►``, and one more."""


@dataclass(frozen=True, slots=True)
class Cut:
    """Where a band ends and the next begins.

    Attributes:
        column: the first of the next band.
        rows: those whose wires are cut.
        links_before: the links there are drawn in the band that ends.
    """

    column: int
    rows: tuple[int, ...] = ()
    links_before: bool = True


def cuts_of(plan: Plan, widths: Sequence[int], columns: int) -> list[Cut]:
    """Where to cut a plan: the beginning, the cuts between, and the end.

    Args:
        plan: the plan.
        widths: the characters that each of its columns takes.
        columns: those that there are.
    """
    crossing = _Crossing(plan)
    cuts = [Cut(0)]
    while True:
        first = cuts[-1].column
        before = MARK if first else 0
        fits = [first + count for count in _fitting(widths[first:], columns - before - 1)]
        if not fits or fits[-1] == len(widths):
            return [*cuts, Cut(len(widths))]
        fits = [first + count for count in _fitting(widths[first:], columns - before - 1 - MARK)]
        last = fits[-1] if fits else first + 1
        cuts.append(crossing.best(range((first + last) // 2 + 1, last + 1)))


def _fitting(widths: Iterable[int], columns: int) -> Iterator[int]:
    """The counts of columns that fit, each with its place."""
    used = 0
    for count, width in enumerate(widths, 1):
        used += width + 1
        if used > columns:
            return
        yield count


class _Crossing:
    """Which rows lead to the place between two columns, and which on from it.

    Args:
        plan: the plan.
    """

    def __init__(self, plan: Plan) -> None:
        self._ends: dict[int, set[int]] = {}
        self._begins: dict[int, set[int]] = {}
        self._links: dict[int, set[int]] = {}
        for cell in plan.cells:
            self._add(cell.row, cell.column, leads_on=not cell.ends)
        for wire in plan.wires:
            for column in range(wire.first, wire.end):
                self._add(wire.row, column)
        for box in plan.boxes:
            for pin in box.inputs:
                if pin.net is not None:
                    self._begins.setdefault(box.column, set()).add(pin.row)
            for pin in box.outputs:
                if pin.net is not None:
                    self._ends.setdefault(box.column + 1, set()).add(pin.row)
        for link in plan.links:
            self._links.setdefault(link.column, set()).update(range(link.first, link.last + 1))

    def best(self, columns: range) -> Cut:
        """The cut through the fewest wires at one of these places, the last of equals."""
        return min((self._cut(column) for column in reversed(columns)), key=lambda cut: len(cut.rows))

    def _cut(self, column: int) -> Cut:
        ends, begins = self._ends.get(column, set()), self._begins.get(column, set())
        links = self._links.get(column, set())
        fed, feeding = begins, ends & (begins | links)
        if not links or len(fed) <= len(feeding):
            return Cut(column, tuple(sorted(fed)))
        return Cut(column, tuple(sorted(feeding)), links_before=False)

    def _add(self, row: int, column: int, *, leads_on: bool = True) -> None:
        self._begins.setdefault(column, set()).add(row)
        if leads_on:
            self._ends.setdefault(column + 1, set()).add(row)
