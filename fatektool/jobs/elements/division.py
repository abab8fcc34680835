"""Which of many elements a PLC refuses, after it refused a request for all of them.

A refusal does not say for which element it is. So the elements are asked for again in parts: a part that is
refused is halved, after an answer the next part is twice as large, until each refused element was asked for
alone. Each refused element takes its own request, and refused neighbours a search: at most
``4 + 4 * log2(n)`` requests among the n elements of one request.

Thousands of such requests would take too long. After ``ROW`` neighbours that were each refused alone a *gap*
begins: there every ``STEP``-th element is asked for. Those between two refused ones are not asked for, and
their error says so; from the first answered one on, all are asked for again. So all elements that a PLC has
are read, except fewer than ``STEP`` in a row after ``ROW`` or more refused ones.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from fatektool.jobs.elements.extent import near

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from fatektool.protocol.elements import Element

ROW: Final = 128
STEP: Final = 16


@dataclass(slots=True)
class Refusals:
    """Elements without a value.

    Attributes:
        errors: the PLC's error for an element that it refused, or why it was not asked for.
        not_asked: those of them that were not asked.
    """

    errors: dict[Element, str] = field(default_factory=dict)
    not_asked: set[Element] = field(default_factory=set)

    def leave_out(self, elements: Iterable[Element], why: str) -> None:
        """Mark elements as not asked for, with the reason."""
        found = dict.fromkeys(elements, f"not asked: {why}")
        self.errors |= found
        self.not_asked |= found.keys()


class Division:
    """Finds the refused among many.

    Args:
        wanted: all elements that are asked for, in order of kind and address, those that were answered too.
        attempt: asks elements together, and gives those that are left to ask, in order.
        alone: asks one element; what the PLC said if it refused, else None.
        refusals: gets what is refused and what is not asked.
    """

    def __init__(
        self,
        wanted: Iterable[Element],
        attempt: Callable[[Sequence[Element]], list[Element]],
        alone: Callable[[Element], str | None],
        refusals: Refusals,
    ) -> None:
        self._places = {element: place for place, element in enumerate(wanted)}
        self._attempt = attempt
        self._alone = alone
        self._refusals = refusals
        self._row: list[Element] = []  # neighbours, each refused alone, up to ROW of them
        self._last: Element | None = None  # the last one refused; between the row and it none was answered

    def divide(self, elements: Sequence[Element]) -> None:
        """Ask elements that were refused together until it is known which are.

        Args:
            elements: in order of kind and address.
        """
        todo = list(elements)
        refused = size = len(todo)  # one of so many of the first is refused; 0 if that is not known
        looked = False
        while todo:
            if not looked and len(self._row) == ROW and self._goes_on(todo[0]):
                looked = True
                todo, refused, size = self._step_through(todo), 0, 1
                continue
            if refused and size >= refused:
                size = max(1, refused // 2)
            part = todo[:size]
            left = self._attempt(part) if len(part) > 1 else []
            todo[: len(part)] = left
            answered = not left if len(part) > 1 else self._ask(part[0])
            if answered:
                refused, size = max(0, refused - len(part)), 2 * size
            else:
                refused, size = len(left), max(1, len(left) // 2)
            if answered or 0 < len(left) < len(part):
                self._row, self._last = [], None

    def refuses(self, element: Element) -> bool:
        """Ask one element alone; True if it is refused."""
        said = self._alone(element)
        if said is not None:
            self._refusals.errors[element] = said
        return said is not None

    def _ask(self, element: Element) -> bool:
        """Ask the next element alone; True if it is answered."""
        if not self.refuses(element):
            return True
        if not self._goes_on(element):
            self._row = []
        if len(self._row) < ROW:
            self._row.append(element)
        self._last = element
        return False

    def _goes_on(self, element: Element) -> bool:
        """True if an element is the next neighbour of the last one refused."""
        return self._last is not None and self._adjoin(self._last, element)

    def _adjoin(self, before: Element, element: Element) -> bool:
        """True if two are neighbours, and none between them is wanted."""
        return self._places[element] == self._places[before] + 1 and near(before, element)

    def _step_through(self, elements: Sequence[Element]) -> list[Element]:
        """Ask some elements of a gap alone; give those that are to be asked all the same."""
        begin, end = self._row[0], self._row[-1]
        for at in range(0, len(elements), STEP):
            step = elements[at : at + STEP]
            if not self._goes_on(step[0]) or not all(map(self._adjoin, step, step[1:])):
                return [*elements[at:]]
            *between, asked = step
            if not self.refuses(asked):
                self._row, self._last = [], None
                return [*between, *elements[at + STEP :]]
            after = f"is {asked}" if self._last == end else f"are {self._last} and {asked}"
            self._refusals.leave_out(
                between, f"each of {begin} to {end} is refused, and so {after}: a gap, or past the end"
            )
            self._last = asked
        return []
