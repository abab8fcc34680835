"""What carries in a circuit, out of the states of its elements.

What one reading cannot say is not known: whether an edge was in the last scan, and the outputs of functions
but for those of timers and counters, which are their contacts. A rising edge needs its element on, so it is
open for certain while that is off; a falling one the other way round.
"""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Final

from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.power.logic import State, both, either, opposite
from fatektool.ladder.power.values import Reader, operand_number, output_contact, shown_bit
from fatektool.ladder.power.walk import Signals, Walk

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.ladder.circuit.nodes import Circuit, Leaf

_COMPARISONS: Final[dict[str, Callable[[float, float], bool]]] = {
    "=": operator.eq,
    ">": operator.gt,
    "<": operator.lt,
    "<>": operator.ne,
    ">=": operator.ge,
    "=<": operator.le,
}


class Power(Signals[State]):
    """A signal is whether there is power.

    Args:
        read: the raw value of an element by its name.
    """

    rail = True

    def __init__(self, read: Reader) -> None:
        self._read = read

    def contact(self, leaf: Leaf) -> State:
        """Whether it conducts."""
        if leaf.is_wire or leaf.is_gap:
            return leaf.is_wire
        if leaf.instruction.bit is None and leaf.role is not Role.STEP:
            return self._comparison(leaf)
        bit = shown_bit(leaf)
        on = self._bit(None if bit is None else bit.name)
        if leaf.edge:
            return _edge(leaf.edge, on)
        return opposite(on) if leaf.is_inverted else on

    def output(self, leaf: Leaf, function: Leaf) -> State:
        """Whether an output of a function is on."""
        return self._bit(output_contact(function, leaf.output))

    def of_line(self, leaf: Leaf, carried: State) -> State:
        """What TU, TD or INV makes of it."""
        kind = leaf.instruction.form.text
        return opposite(carried) if kind == "INV" else _edge(kind, carried)

    def unsure(self, leaf: Leaf) -> State:  # noqa: ARG002  # whichever it is
        """Not known."""
        return None

    def state(self, signal: State) -> State:
        """It is one."""
        return signal

    def both(self, one: State, other: State) -> State:
        """Two in series."""
        return both(one, other)

    def either(self, signals: Sequence[State]) -> State:
        """Several in parallel."""
        return either(signals)

    def _bit(self, name: str | None) -> State:
        raw = None if name is None else self._read(name)
        return None if raw is None else bool(raw)

    def _comparison(self, leaf: Leaf) -> State:
        sign = comparison_sign(leaf)
        a, b = (operand_number(leaf, operand, self._read) for operand in leaf.instruction.operands)
        return None if a is None or b is None else _COMPARISONS[sign](a, b)


def comparison_sign(leaf: Leaf) -> str:
    """The sign of a comparison: ``>=``."""
    return leaf.instruction.form.text.split()[2]


def power_of(circuit: Circuit, read: Reader) -> Walk[State]:
    """What carries in a circuit.

    Args:
        circuit: it.
        read: the raw value of an element by its name; None where it is not known.
    """
    return Walk(circuit, Power(read))


def _edge(kind: str, on: State) -> State:
    """An edge conducts for one scan only: it is open for certain where it cannot just have been."""
    return False if on is (kind == "TD") else None
