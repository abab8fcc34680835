"""A walk over a circuit along its lines, from left to right, with any kind of signal.

A block is evaluated for itself before it is joined to what is before it, as its instructions do it: what
``OUT TR n`` in a block stores is the block's own signal.

What INV and TD in a block act on is not known [E:ladder-block]: the block's own signal, or all that the line
carries up to there. Both are the same where the line carries up to the block. Elsewhere the result is not
known, unless another contact decides it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

from fatektool.ladder.circuit.nodes import (
    Block,
    Box,
    Circuit,
    Leaf,
    Line,
    Node,
    Parallel,
    Part,
    Series,
    leaves_of,
)
from fatektool.ladder.circuit.roles import Role

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.ladder.power.logic import State

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
    def unsure(self, leaf: Leaf) -> T:
        """What TD or INV in a block makes of a signal, where it is not known which signal that is."""

    @abstractmethod
    def state(self, signal: T) -> State:
        """Whether a signal is on."""

    @abstractmethod
    def both(self, one: T, other: T) -> T:
        """Two in series."""

    @abstractmethod
    def either(self, signals: Sequence[T]) -> T:
        """Several in parallel."""


@dataclass(frozen=True, slots=True)
class _Before(Generic[T]):
    """What comes to a block.

    Attributes:
        signal: it.
        is_doubtful: INV or TD in the block may act on it, and it is not on.
    """

    signal: T
    is_doubtful: bool = False


class Walk(Generic[T]):
    """A circuit's signals.

    Args:
        circuit: it.
        signals: what they are.

    Attributes:
        after: what is carried after each leaf, by its number: the net of a plan is made of these.
        reached: what reaches each coil, and each input of a function, by the number of its instruction.
    """

    def __init__(self, circuit: Circuit, signals: Signals[T]) -> None:
        self.after: dict[int, T] = {}
        self.reached: dict[int, tuple[T, ...]] = {}
        self._signals = signals
        self._stores: dict[int, T] = {}
        self._functions: dict[int, Leaf] = {}  # by the number of an output
        for line in circuit.lines:
            self._line(line)

    def _line(self, line: Line) -> T:
        return self._row(line.parts, self._signals.rail, _Before(self._signals.rail))

    def _row(self, parts: Sequence[Part], carried: T, before: _Before[T]) -> T:
        for part in parts:
            carried = self._part(part, carried, before)
        return carried

    def _part(self, part: Part, carried: T, before: _Before[T]) -> T:
        """What a part hands on.

        Args:
            part: it.
            carried: what comes to it, of its block.
            before: what comes to the block.
        """
        match part:
            case Box():
                self._box(part, carried)
                return carried
            case Series(parts):
                return self._row(parts, carried, before)
            case Parallel(branches):
                found = [self._part(each, carried, before) for each in branches]
                unsure = [each for each in found if self._signals.state(each) is None]
                return unsure[0] if unsure and before.is_doubtful else self._signals.either(found)
            case Block(body):
                return self._block(body, carried, before)
        return self._leaf(part, carried, before)

    def _block(self, body: Node, carried: T, before: _Before[T]) -> T:
        signals = self._signals
        signal = self._on_the_wire(carried, before)
        is_doubtful = signals.state(signal) is not True and any(map(_turns, leaves_of(body)))
        own = self._part(body, signals.rail, _Before(signal, is_doubtful))
        return own if is_doubtful and signals.state(own) is None else signals.both(carried, own)

    def _on_the_wire(self, carried: T, before: _Before[T]) -> T:
        """What the wire carries, with what comes to the block."""
        if before.is_doubtful and self._signals.state(carried) is None:
            return carried
        return self._signals.both(before.signal, carried)

    def _box(self, box: Box, carried: T) -> None:
        self.reached[box.function.number] = (carried, *map(self._line, box.inputs))
        for line in box.outputs:
            if line.head is not None and line.head.role is Role.OUTPUT:
                self._functions[line.head.number] = box.function
            self._line(line)

    def _leaf(self, leaf: Leaf, carried: T, before: _Before[T]) -> T:
        found = self._after(leaf, carried, before)
        self.after[leaf.number] = self._on_the_wire(found, before)
        return found

    def _after(self, leaf: Leaf, carried: T, before: _Before[T]) -> T:
        signals = self._signals
        match leaf.role:
            case Role.COIL:
                self.reached[leaf.number] = (carried,)
            case Role.STORE:
                self._stores[leaf.store] = carried
            case Role.RECALL:
                return signals.both(carried, self._stores[leaf.store])
            case Role.LINE if before.is_doubtful and _turns(leaf):
                return signals.unsure(leaf)
            case Role.LINE:
                return signals.of_line(leaf, carried)
            case Role.OUTPUT:
                return signals.both(carried, signals.output(leaf, self._functions[leaf.number]))
            case Role.MARK:
                pass
            case _:
                return signals.both(carried, signals.contact(leaf))
        return carried


def _turns(leaf: Leaf) -> bool:
    """True for INV and TD of a line: they may hand on a signal where none comes."""
    return leaf.role is Role.LINE and leaf.instruction.form.text != "TU"
