"""The operands of a function: the meaning of their words, their text, and their use by the function.

An operand has one or two words, high word first, and the bytes of each word are swapped::

    100A           -> 0A10          R8
    0000 3C00      -> 0000003C      60, of 32 bits
    7A44 0000      -> 447A0000      1000.0

The low nibble of the function's word has a bit for each of two sources, which is set for a constant.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import Enum, auto
from math import isfinite
from typing import TYPE_CHECKING, Final

from fatektool.ladder.addresses import (
    Name,
    Span,
    bit_name,
    bit_span,
    register_name,
    register_span,
    spans_of,
)
from fatektool.ladder.grades import Grade

if TYPE_CHECKING:
    from collections.abc import Sequence


class OperandKind(Enum):
    """The kind of an operand's value."""

    REGISTER = auto()  # a byte address, or a constant, by the nibble
    FLOAT = auto()  # the same, the constant a float
    NUMBER = auto()  # a byte address if it is large enough for one, else a number
    CODE = auto()  # always a number
    BIT = auto()  # a bit address
    TEXT = auto()  # two characters
    MUTE = auto()  # a word that is not printed


class OperandUse(Enum):
    """The use of an operand by the function."""

    READ = auto()
    WRITE = auto()
    CHANGE = auto()  # reads and writes
    READ_ON = auto()  # reads it and a number of registers after it
    WRITE_ON = auto()
    CHANGE_ON = auto()
    NOTHING = auto()

    @property
    def reads(self) -> bool:
        """True if the function's work depends on it."""
        return self in {OperandUse.READ, OperandUse.CHANGE, OperandUse.READ_ON, OperandUse.CHANGE_ON}

    @property
    def writes(self) -> bool:
        """True if the function writes it."""
        return self in {OperandUse.WRITE, OperandUse.CHANGE, OperandUse.WRITE_ON, OperandUse.CHANGE_ON}

    @property
    def goes_on(self) -> bool:
        """True if an unknown number of registers after the named one belong to it."""
        return self in {OperandUse.READ_ON, OperandUse.WRITE_ON, OperandUse.CHANGE_ON}


@dataclass(frozen=True, slots=True)
class OperandForm:
    """The form of one operand.

    Attributes:
        kind: of its value.
        use: by the function.
        constant: the bit of the low nibble that makes it a constant; 0 if there is none.
        words: its words of code, 1 or 2.
        registers: its registers, 1, 2 or 4.
    """

    kind: OperandKind = OperandKind.REGISTER
    use: OperandUse = OperandUse.READ
    constant: int = 0
    words: int = 1
    registers: int = 1


@dataclass(frozen=True, slots=True)
class Operand:
    """An operand of an instruction.

    Attributes:
        part: its form.
        value: its words with their bytes swapped, the first the high one.
        text: as the vendor prints it.
        grade: the certainty of the text.
        element: its element; None if it has none.
        spans: its memory; empty if not known, or for a constant.
    """

    part: OperandForm
    value: int
    text: str
    grade: Grade = Grade.A
    element: str | None = None
    spans: tuple[Span, ...] = ()

    def __str__(self) -> str:
        return self.text

    @property
    def high(self) -> int:
        """The high byte of a value of one word."""
        return self.value >> 8

    @property
    def low(self) -> int:
        """The low byte of a value of one word."""
        return self.value & 0xFF


_FIRST_ADDRESS: Final = 0x100  # the lowest byte address that is a register


def swapped(word: int) -> int:
    """A word with its bytes swapped."""
    return (word & 0xFF) << 8 | word >> 8


def value_of(words: Sequence[int]) -> int:
    """The value of an operand's words, the first the high one."""
    value = 0
    for word in words:
        value = value << 16 | swapped(word)
    return value


def words_of(value: int, count: int) -> tuple[int, ...]:
    """The words of an operand's value: what ``value_of`` reads."""
    return tuple(swapped(value >> 16 * place & 0xFFFF) for place in reversed(range(count)))


def operand(part: OperandForm, value: int, nibble: int) -> Operand:
    """The operand with its text.

    Args:
        part: its form.
        value: its words with their bytes swapped.
        nibble: the low nibble of the function's word.
    """
    if part.kind is OperandKind.BIT:
        return _bit(part, value)
    if part.kind is OperandKind.TEXT:
        text = characters(value)
        return Operand(part, value, text, Grade.C if "\\" in text else Grade.A)
    if part.kind in {OperandKind.MUTE, OperandKind.CODE}:
        return Operand(part, value, str(value))
    if part.kind is OperandKind.NUMBER and value < _FIRST_ADDRESS:
        return Operand(part, value, str(value), Grade.B)
    if nibble & part.constant:
        return _constant(part, value)
    return _register(part, value)


def number(value: int, bits: int) -> str:
    """A constant as text: decimal, or hex if the top bit is set, because its sign is not known."""
    return f"{value:0{bits // 4}X}H" if value >> bits - 1 else str(value)


def characters(value: int) -> str:
    """Two characters, packed as the first times 128 plus the second, without NUL.

    Characters that are not printable ASCII are shown as their code in hex.
    """
    return "".join(character(code) for code in (value >> 7, value & 0x7F) if code)


def character(code: int) -> str:
    """A character of a label or a text."""
    return chr(code) if 0x20 <= code < 0x7F else f"\\x{code:02X}"


def _constant(part: OperandForm, value: int) -> Operand:
    if part.kind is OperandKind.FLOAT:
        return Operand(part, value, _float(value), Grade.B)
    sure = value < 1 << 15
    return Operand(part, value, number(value, 16 * part.words), Grade.A if sure else Grade.B)


def _register(part: OperandForm, value: int) -> Operand:
    if value > 0xFFFF:
        return Operand(part, value, f"@{value:08X}", Grade.C)
    return _named(part, value, register_name(value), (register_span(value, part.registers),))


def _bit(part: OperandForm, value: int) -> Operand:
    name = bit_name(value) if value <= 0xFFF else None
    if name is None:
        return Operand(part, value, f"@{value:04X}", Grade.C)
    return _named(part, value, name, (bit_span(value),))


def _named(part: OperandForm, value: int, name: Name, spans: tuple[Span, ...]) -> Operand:
    if name.element is None:
        return Operand(part, value, name.text, name.grade)
    if name.element[0] in "TC":  # a timer is its contact and its value
        spans = spans_of(name.element)
    return Operand(part, value, name.text, name.grade, name.element, spans)


def _float(value: int) -> str:
    """A float of 32 bits, with the fewest digits that represent it."""
    raw = value.to_bytes(4, "big")
    (exact,) = struct.unpack(">f", raw)
    if not isfinite(exact):
        return f"{value:08X}H"
    for digits in range(6, 10):
        text = f"{exact:.{digits}g}"
        if struct.pack(">f", float(text)) == raw:
            return text if "." in text or "e" in text else f"{text}.0"
    return f"{value:08X}H"
