"""The elements that an instruction's drawing shows, and the values of its operands.

::

    AND NOT M421             M421
    ANDF 171 > Sa:R6 Sb:T5   R6, RT5
    T30 .01 R8               R8, RT30, and its contact T30
    FUN 08D MOV S:R0 D:R2    DR0, DR2

A number is signed [E:signed-numbers]. The results and operands of
functions of floats are floats.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.ladder.circuit.roles import Role
from fatektool.ladder.operands import OperandKind

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    from fatektool.ladder.circuit.nodes import Leaf
    from fatektool.ladder.operands import Operand

Reader: TypeAlias = "Callable[[str], int | None]"
"""The raw, unsigned value of an element by its name; None where it is not known."""

_TIMERS_AND_COUNTERS: Final = {0x80F0, 0x81F0, 0xBEF0, 0x40F0}
_FIRST_WIDE_COUNTER: Final = 200


class Shown(NamedTuple):
    """An element that is read to be shown.

    Attributes:
        name: as a PLC is asked for it: ``RT5`` for a timer's value.
        bits: 1, 16 or 32.
        is_float: its bits are a float.
    """

    name: str
    bits: int
    is_float: bool = False


def shown_bit(leaf: Leaf) -> Shown | None:
    """The bit that a contact, a coil or a step is of; None where it is of none."""
    if leaf.instruction.bit is not None:
        return None if leaf.element is None else Shown(leaf.element, 1)
    if leaf.role in {Role.STEP, Role.COIL}:
        (operand,) = leaf.instruction.operands
        if operand.element is not None and (
            operand.part.kind is OperandKind.BIT or operand.element[0] in "TC"
        ):
            return Shown(operand.element, 1)
    return None


def output_contact(function: Leaf, output: int) -> str | None:
    """The element whose contact is the same as an output of a function; None where there is none.

    Of a timer or counter the output TUP or CUP is on when its contact is [E:timer-output].
    """
    form = function.instruction.form
    if output or not form.fixed or form.fixed[0] not in _TIMERS_AND_COUNTERS:
        return None
    return function.instruction.operands[1].element


def shown_operand(leaf: Leaf, operand: Operand) -> Shown | None:
    """The element whose value an operand has; None for a constant, and where it is not known which it is."""
    if operand.element is None:
        return None
    if operand.part.kind is OperandKind.BIT:
        return Shown(operand.element, 1)
    symbol = operand.element.rstrip("0123456789")
    number = int(operand.element[len(symbol) :])
    if symbol == "C" and number >= _FIRST_WIDE_COUNTER:
        return Shown(f"DRC{number}", 32)
    if operand.part.registers == 1:
        return Shown(f"R{operand.element}" if symbol in {"T", "C"} else operand.element, 16)
    if operand.part.registers > 2 or symbol in {"T", "C"}:
        return None
    return Shown(f"D{operand.element}", 32, _is_float(leaf, operand))


def shown_of(leaf: Leaf) -> tuple[Shown, ...]:
    """All that is read for an instruction, each once."""
    found = [shown_bit(leaf), *(shown_operand(leaf, operand) for operand in leaf.instruction.operands)]
    if leaf.role is Role.FUNCTION:
        contact = output_contact(leaf, 0)
        found.append(None if contact is None else Shown(contact, 1))
    return tuple(dict.fromkeys(each for each in found if each is not None))


def number_of(raw: int, shown: Shown) -> int | float:
    """Raw bits as the number that is meant."""
    if shown.is_float:
        (value,) = struct.unpack(">f", raw.to_bytes(4, "big"))
        return float(value)
    return signed(raw, shown.bits) if shown.bits > 1 else raw


def signed(raw: int, bits: int) -> int:
    """Bits as a signed number."""
    return raw - (1 << bits) if raw >> bits - 1 else raw


def operand_number(leaf: Leaf, operand: Operand, read: Reader) -> int | float | None:
    """The number that an operand stands for: a constant, or what an element has; None if not known."""
    if operand.part.constant & leaf.instruction.free[0]:
        return signed(operand.value, 16 * operand.part.words)
    shown = shown_operand(leaf, operand)
    raw = None if shown is None else read(shown.name)
    return None if raw is None or shown is None else number_of(raw, shown)


def _is_float(leaf: Leaf, operand: Operand) -> bool:
    text = leaf.instruction.form.text
    if not text.startswith("FUN 20"):
        return operand.part.kind is OperandKind.FLOAT
    of_integer = {"I->F": 0, "F->I": 1}  # the operand that is no float
    place = leaf.instruction.operands.index(operand)
    return all(place != number for name, number in of_integer.items() if name in text)
