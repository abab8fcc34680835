"""What a PLC has now, as it stands in a drawing beside the program.

::

    X0=1 over a contact      the state of its element        T30=12      the value of an operand
    7 > 0 over a comparison  what is compared                ?           not known
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.drawing.plan import RAIL
from fatektool.ladder.power.flow import Power, comparison_sign, power_of
from fatektool.ladder.power.logic import State, either
from fatektool.ladder.power.values import Reader, Shown, number_of, operand_number, shown_bit, shown_operand

if TYPE_CHECKING:
    from fatektool.ladder.circuit.nodes import Circuit, Leaf
    from fatektool.ladder.drawing.plan import Net
    from fatektool.ladder.drawing.signs import Frame
    from fatektool.ladder.operands import Operand

_WIDTHS: Final = {1: 1, 16: 6, 32: 11}
"""Characters of the longest value, by bits: a drawing keeps its width while values change."""
_FLOAT: Final = 13


class LiveStates:
    """What a PLC has now.

    Args:
        circuit: the network that is drawn.
        read: the raw value of an element by its name; None where it is not known.
    """

    def __init__(self, circuit: Circuit, read: Reader) -> None:
        self._read = read
        self._leaves = {leaf.number: leaf for leaf in circuit.leaves}
        self._walk = power_of(circuit, read)
        self._power = Power(read)

    def of_net(self, net: Net | None) -> State:
        """Whether a wire carries; None where it is not known. What has no net is no wire."""
        if net is None:
            return False
        return True if net == RAIL else either(self._walk.after[number] for number in net)

    def of_sign(self, number: int) -> State:
        """Whether a contact conducts, or a coil is on."""
        leaf = self._leaves[number]
        if leaf.role in {Role.LINE, Role.STORE, Role.RECALL}:
            return self._walk.after[leaf.number]
        if leaf.role is not Role.COIL:
            return self._power.contact(leaf)
        bit = shown_bit(leaf)
        raw = None if bit is None else self._read(bit.name)
        return None if raw is None else bool(raw)

    def name(self, leaf: Leaf, name: str) -> tuple[str, int]:
        """``X0=1``, of a comparison ``7 > 0``; of what has no element, its name."""
        bit = shown_bit(leaf)
        if bit is not None:
            return f"{name}={self._value(bit).strip()}", 0
        if leaf.role not in _CONTACTS or leaf.instruction.bit is not None:
            return name, 0
        a, b = leaf.instruction.operands
        widest = sum(self._width(leaf, each) for each in (a, b))
        sign = comparison_sign(leaf)
        return f"{self._number(leaf, a)} {sign} {self._number(leaf, b)}", widest + 2 + len(sign)

    def setting(self, leaf: Leaf, elements: tuple[str, ...]) -> str:
        """``=12``."""
        shown = [shown_operand(leaf, each) for each in leaf.instruction.operands if each.element in elements]
        return f"={self._value(shown[0])}" if len(shown) == 1 and shown[0] is not None else ""

    def of_title(self, leaf: Leaf, frame: Frame) -> list[str]:
        """``T30=12``: the values of operands that stand in the title of a box, a line each."""
        elements = [element for setting in frame.settings for element in setting.elements]
        operands = [each for each in leaf.instruction.operands if each.element not in elements]
        found = [(each.element, shown_operand(leaf, each)) for each in operands]
        return [f"{element}={self._value(shown)}" for element, shown in found if shown is not None]

    def _value(self, shown: Shown) -> str:
        raw = self._read(shown.name)
        width = _FLOAT if shown.is_float else _WIDTHS[shown.bits]
        return f"{'?' if raw is None else value_text(raw, shown):<{width}}"

    def _number(self, leaf: Leaf, operand: Operand) -> str:
        number = operand_number(leaf, operand, self._read)
        return "?" if number is None else str(number)

    def _width(self, leaf: Leaf, operand: Operand) -> int:
        shown = shown_operand(leaf, operand)
        return len(self._number(leaf, operand)) if shown is None else _WIDTHS[shown.bits]


def value_text(raw: int, shown: Shown) -> str:
    """Raw bits as they are shown: a number, of a float six digits."""
    value = number_of(raw, shown)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


_CONTACTS: Final = {Role.ORG, Role.LD, Role.AND, Role.OR}
