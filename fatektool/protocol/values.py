"""Raw bits as typed values and back: ``u16``, ``i16``, ``bcd``, ``hex``, ``u32``, ``i32``, ``f32``, ``str``.

A PLC has only bits; the author of its program decides their type. So the user gives a type with the element.
By default a register is a signed number, as for the PLC's own functions; a word of discretes (``WM8``) is
unsigned, and a discrete a bool.
"""

from __future__ import annotations

import math
import re
import struct
from enum import Enum
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError, UsageError
from fatektool.protocol.texts import characters, text_bits

if TYPE_CHECKING:
    from fatektool.protocol.elements import ElementKind
    from fatektool.protocol.texts import Order

Value = bool | int | float | str


class ValueType(Enum):
    """The type of a value."""

    BOOL = "bool"
    U16 = "u16"
    I16 = "i16"
    U32 = "u32"
    I32 = "i32"
    F32 = "f32"
    BCD = "bcd"
    HEX = "hex"
    STR = "str"
    STR_HIGH = "strh"

    @property
    def bits(self) -> int | None:
        """Its number of bits; None for that of the element."""
        return _BITS[self]


_BITS: Final = {
    ValueType.BOOL: 1,
    ValueType.U16: 16,
    ValueType.I16: 16,
    ValueType.U32: 32,
    ValueType.I32: 32,
    ValueType.F32: 32,
    ValueType.BCD: None,
    ValueType.HEX: None,
    ValueType.STR: None,
    ValueType.STR_HIGH: None,
}
TEXTS: Final[dict[ValueType | None, Order]] = {
    ValueType.STR: "little",
    ValueType.STR_HIGH: "big",
}
"""Characters, two in a register: the first is in the low byte, or in the high one."""
NUMBERS: Final = frozenset(ValueType) - {ValueType.BOOL, ValueType.HEX, *TEXTS}
"""The types whose values are numbers, which can be scaled."""
_ON: Final = {"on": 1, "true": 1, "1": 1, "off": 0, "false": 0, "0": 0}
_INTEGER: Final = re.compile(r"[+-]?(0[xX][0-9A-Fa-f]+|0[bB][01]+|[0-9]+)", re.ASCII)
_HEX: Final = re.compile(r"(0[xX])?[0-9A-Fa-f]+", re.ASCII)
_LONGEST: Final = 1000
_REAL: Final = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?", re.ASCII)


def default_type(kind: ElementKind) -> ValueType:
    """The default type of an element of this kind."""
    if kind.bits == 1:
        return ValueType.BOOL
    of_discretes = "W" in kind.symbol
    if kind.bits == 16:
        return ValueType.U16 if of_discretes else ValueType.I16
    return ValueType.U32 if of_discretes else ValueType.I32


def decode(raw: int, kind: ValueType, bits: int) -> Value:
    """Bits as a value.

    Args:
        raw: unsigned.
        kind: its type.
        bits: the element's width.

    Raises:
        DataError: not a value of this type: a digit above 9 in BCD, a float that is not a number.
    """
    match kind:
        case ValueType.BOOL:
            return bool(raw)
        case ValueType.I16 | ValueType.I32:
            return raw - (1 << bits) if raw >> (bits - 1) else raw
        case ValueType.F32:
            return _float_of(raw)
        case ValueType.BCD:
            digits = raw_text(raw, bits)
            if not digits.isdecimal():
                raise DataError(f"{digits} is not a BCD number")
            return int(digits)
        case ValueType.HEX:
            return raw_text(raw, bits)
        case _:
            return characters(raw, bits, TEXTS[kind]) if kind in TEXTS else raw


def _float_of(raw: int) -> float:
    number: float = struct.unpack(">f", raw.to_bytes(4, "big"))[0]
    if not math.isfinite(number):
        raise DataError(f"{raw:08X} is not a number as f32")
    return number


def raw_text(raw: int, bits: int) -> str:
    """Raw bits in hex; 0 or 1 for a discrete."""
    return f"{raw:0{max(1, bits // 4)}X}"


def encode(text: str, kind: ValueType | None, bits: int) -> int:
    """A value in a text, as unsigned bits.

    Args:
        text: ``4261``, ``-1``, ``0x5555``, ``1.5``, ``on``.
        kind: its type; None for the default, which accepts signed and unsigned numbers.
        bits: the element's width.

    Raises:
        UsageError: not a value of this type, or out of range.
    """
    return text_bits(text, bits, TEXTS[kind]) if kind in TEXTS else _encode(text.strip(), kind, bits)


def _encode(text: str, kind: ValueType | None, bits: int) -> int:
    if bits == 1:
        if text.lower() not in _ON:
            raise UsageError(f"value {text!r}: expected on or off, true or false, 1 or 0")
        return _ON[text.lower()]
    if kind is ValueType.F32:
        return _float_bits(text)
    if kind is ValueType.HEX:
        if not _HEX.fullmatch(text):
            raise UsageError(f"value {text!r}: expected hex digits such as 10A5 or 0x10A5")
        base = 16
    elif _INTEGER.fullmatch(text):
        base = 10 if text.lstrip("+-").isdecimal() else 0
    else:
        raise UsageError(f"value {text!r}: expected a whole number such as 4261, -1 or 0x10A5")
    least, most = _range(kind, bits)
    if len(text) > _LONGEST:
        raise UsageError(f"value {text[:20]}…: expected {least} to {most}")
    number = int(text, base)
    if not least <= number <= most:
        raise UsageError(
            f"value {text}: expected {least} to {most} for {kind.value if kind else f'{bits} bits'}"
        )
    if kind is ValueType.BCD:
        return int(str(number), 16)
    return number & ((1 << bits) - 1)


def _range(kind: ValueType | None, bits: int) -> tuple[int, int]:
    match kind:
        case None:
            return -(1 << (bits - 1)), (1 << bits) - 1
        case ValueType.I16 | ValueType.I32:
            return -(1 << (bits - 1)), (1 << (bits - 1)) - 1
        case ValueType.BCD:
            return 0, 10 ** (bits // 4) - 1
        case _:
            return 0, (1 << bits) - 1


def _float_bits(text: str) -> int:
    if not _REAL.fullmatch(text):
        raise UsageError(f"value {text!r}: expected a number such as 1.5 or -3e-2")
    number = float(text)
    try:
        if math.isfinite(number):
            return int.from_bytes(struct.pack(">f", number), "big")
    except OverflowError:
        pass
    raise UsageError(f"value {text:.60}: too large for f32")
