"""A walk over a circuit along its lines, from left to right, with any kind of signal.

A block is worked out for itself before it is joined to what is before it, as its instructions do it: what
``INV`` in a block turns round, and what ``OUT TR n`` there stores, is the block's own signal.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Generic, TypeVar

from fatektool.ladder.circuit.nodes import Block, Box, Circuit, Leaf, Line, Parallel, Part, Series
from fatektool.ladder.circuit.roles import Role

if TYPE_CHECKING:
    from collections.abc import Sequence

T = TypeVar("T")


class Signals(ABC, Generic[T]):
    """What a signal is, and what becomes of it.

    Attributes:
        rail: the signal of the rail.
    """

    rail: T

    @abstractmethod
    def contact(self, leaf: Leaf) -> T:
        """What a contact, a comparison or a step hands on from the rail."""

    @abstractmethod
    def output(self, leaf: Leaf, function: Leaf) -> T:
        """What an output of a function carries."""

    @abstractmethod
    def of_line(self, leaf: Leaf, carried: T) -> T:
        """What TU, TD or INV makes of a signal."""

    @abstractmethod
    def both(self, one: T, other: T) -> T:
        """Two in series."""

    @abstractmethod
    def either(self, signals: Sequence[T]) -> T:
        """Several in parallel."""


class Walk(Generic[T]):
    """A circuit's signals.

    Args:
        circuit: it.
        signals: what they are.

    Attributes:
        behind: what goes on behind each leaf, by its number: the net of a plan is made of these.
        reached: what reaches each coil, and each input of a function, by the number of its instruction.
    """

    def __init__(self, circuit: Circuit, signals: Signals[T]) -> None:
        self.behind: dict[int, T] = {}
        self.reached: dict[int, tuple[T, ...]] = {}
        self._signals = signals
        self._stores: dict[int, T] = {}
        self._functions: dict[int, Leaf] = {}  # by the number of an output
        for line in circuit.lines:
            self._line(line)

    def _line(self, line: Line) -> T:
        return self._row(line.parts, self._signals.rail, self._signals.rail)

    def _row(self, parts: Sequence[Part], carried: T, before: T) -> T:
        for part in parts:
            carried = self._part(part, carried, before)
        return carried

    def _part(self, part: Part, carried: T, before: T) -> T:
        """What a part hands on.

        Args:
            part: it.
            carried: what comes to it, of its block.
            before: what comes to the block.
        """
        signals = self._signals
        match part:
            case Box():
                self._box(part, carried)
                return carried
            case Series(parts):
                return self._row(parts, carried, before)
            case Parallel(branches):
                return signals.either([self._part(each, carried, before) for each in branches])
            case Block(body):
                own = self._part(body, signals.rail, signals.both(before, carried))
                return signals.both(carried, own)
        found = self._leaf(part, carried)
        self.behind[part.number] = signals.both(before, found)
        return found

    def _box(self, box: Box, carried: T) -> None:
        self.reached[box.function.number] = (carried, *map(self._line, box.inputs))
        for line in box.outputs:
            if line.head is not None and line.head.role is Role.OUTPUT:
                self._functions[line.head.number] = box.function
            self._line(line)

    def _leaf(self, leaf: Leaf, carried: T) -> T:
        signals = self._signals
        match leaf.role:
            case Role.COIL:
                self.reached[leaf.number] = (carried,)
            case Role.STORE:
                self._stores[leaf.store] = carried
            case Role.RECALL:
                return signals.both(carried, self._stores[leaf.store])
            case Role.LINE:
                return signals.of_line(leaf, carried)
            case Role.OUTPUT:
                return signals.both(carried, signals.output(leaf, self._functions[leaf.number]))
            case Role.MARK:
                pass
            case _:
                return signals.both(carried, signals.contact(leaf))
        return carried
