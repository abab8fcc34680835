"""The two address spaces of a program, and the elements in them, both ways.

A contact or coil names a **bit address** of 12 bits, an operand of a function a **byte address** of 16 bits::

    bit    000 X   100 Y   200 T   300 C   400 TR   428 S   810 M   FE2-FFB drawing
           FFC-FFE outputs of a function
    byte   0100 R3840   0390 T   0590 C   0720 C200   0800 the bits, 8 a byte   0A00 R0   2800 R5000   4000 D
           7000 pointers   75ab D by two pointers   8000 + address: by pointer V

Each row of the tables carries its grade (see ``grades``).
"""

from __future__ import annotations

import re
from bisect import bisect_right
from enum import Enum
from typing import Final, NamedTuple

from fatektool.ladder.grades import Grade

LAST_BIT: Final = 0xFFF
BITS_AT: Final = 0x0800
"""The byte address of bit address 0; eight bits in each byte."""


class Area(Enum):
    """The address spaces."""

    BITS = "bits"
    BYTES = "bytes"


class Span(NamedTuple):
    """The memory of an element: from ``first`` to before ``end``, in the unit of its area."""

    area: Area
    first: int
    end: int

    def meets(self, other: Span) -> bool:
        """True if both have common memory."""
        return self.area is other.area and self.first < other.end and other.first < self.end


class Name(NamedTuple):
    """The name of an address.

    Attributes:
        text: as the vendor prints it: ``M310``, ``TR 0``, ``R8``; ``@6000`` if not known.
        grade: the certainty of the name.
        element: the element of a PLC; None if the address is not one.
    """

    text: str
    grade: Grade
    element: str | None


class _Row(NamedTuple):
    first: int
    size: int
    symbol: str
    number: int = 0
    stride: int = 1
    step: int = 1
    grade: Grade = Grade.A

    @property
    def end(self) -> int:
        return self.first + self.size * self.stride

    def number_at(self, address: int) -> int | None:
        """The number of the element at this address; None between two elements or past the last."""
        place, rest = divmod(address - self.first, self.stride)
        return self.number + place * self.step if not rest and place < self.size else None

    def address_of(self, number: int) -> int | None:
        place, rest = divmod(number - self.number, self.step)
        return self.first + place * self.stride if not rest and 0 <= place < self.size else None


_BITS: Final = (
    _Row(0x000, 256, "X"),
    _Row(0x100, 256, "Y"),
    _Row(0x200, 256, "T"),
    _Row(0x300, 256, "C"),
    _Row(0x400, 40, "TR"),
    _Row(0x428, 1000, "S"),
    _Row(0x810, 2002, "M"),
)
_BYTES: Final = (
    _Row(0x0100, 328, "R", number=3840, stride=2, grade=Grade.B),
    _Row(0x0390, 256, "T", stride=2),
    _Row(0x0590, 200, "C", stride=2),
    _Row(0x0720, 56, "C", number=200, stride=4, grade=Grade.C),
    _Row(0x0800, 32, "WX", step=8, grade=Grade.B),
    _Row(0x0820, 32, "WY", step=8, grade=Grade.B),
    _Row(0x0885, 125, "WS", step=8, grade=Grade.B),
    _Row(0x0902, 251, "WM", step=8, grade=Grade.B),
    _Row(0x0A00, 3840, "R", stride=2),
    _Row(0x2800, 3072, "R", number=5000, stride=2, grade=Grade.B),
    _Row(0x4000, 4096, "D", stride=2),
)
_BIT_STARTS: Final = [row.first for row in _BITS]
_BYTE_STARTS: Final = [row.first for row in _BYTES]

STORES: Final = range(0x400, 0x428)
"""Bit addresses of TR: OUT stores the state of a line, LD uses it again."""
DRAWING: Final = range(0xFE2, 0xFFC)
"""Bit addresses of a wire (``SHORT``) or a gap (``OPEN``); the address only affects the drawing."""
_SURE_DRAWING: Final = range(0xFE2, 0xFF0)
OUTPUTS: Final = range(0xFFC, 0xFFF)
"""Bit addresses that with LD are the outputs of the function before: ``FO 0`` to ``FO 2``."""

_WRITTEN: Final = re.compile(r"(D(?=[A-Z]))?([A-Z]+)([0-9]{1,5})", re.ASCII)


def bit_name(address: int) -> Name | None:
    """The name of a bit address of 12 bits; None for drawing, outputs of functions and FFF."""
    row = _BITS[bisect_right(_BIT_STARTS, address) - 1]
    number = row.number_at(address)
    if number is None:
        return None
    if address in STORES:  # no PLC can be asked for it
        return Name(f"TR {number}", row.grade, None)
    return Name(f"{row.symbol}{number}", row.grade, f"{row.symbol}{number}")


def drawing_grade(address: int) -> Grade:
    """The certainty that this address of ``DRAWING`` is a wire or a gap."""
    return Grade.A if address in _SURE_DRAWING else Grade.C


def register_name(address: int) -> Name:
    """The name of a byte address of 16 bits; ``@6000`` if not known."""
    if address & 0x8000:
        base = register_name(address & 0x7FFF)
        if base.element is not None and base.element.startswith(("R", "D")):
            return Name(f"{base.text}V", Grade.B, None)
    elif address & 0xFF00 == 0x7500:
        return Name(f"D0[P{address >> 4 & 15}+P{address & 15}]?", Grade.B, None)
    elif address & 0xFFF0 == 0x7000:
        return Name(f"P{address & 15}", Grade.B, None)
    elif address >= _BYTE_STARTS[0]:
        row = _BYTES[bisect_right(_BYTE_STARTS, address) - 1]
        number = row.number_at(address)
        if number is not None:
            return Name(f"{row.symbol}{number}", row.grade, f"{row.symbol}{number}")
    return Name(f"@{address:04X}", Grade.C, None)


def bit_address(name: str) -> int | None:
    """The bit address of ``M310`` or ``TR 0``; None if no such bit is known."""
    return _address(_BITS, name.replace(" ", ""))


def register_address(name: str) -> int | None:
    """The byte address of ``R8``, ``WM8`` or ``C200``; None if no such register is known."""
    return _address(_BYTES, name)


def _address(rows: tuple[_Row, ...], name: str) -> int | None:
    found = re.fullmatch(r"([A-Z]+)([0-9]{1,5})", name, re.ASCII)
    if not found:
        return None
    of_symbol = (row.address_of(int(found[2])) for row in rows if row.symbol == found[1])
    return next((address for address in of_symbol if address is not None), None)


def bit_span(address: int, bits: int = 1) -> Span:
    """The memory of a contact or coil."""
    return Span(Area.BITS, address, address + bits)


def register_span(address: int, words: int = 1) -> Span:
    """The memory of a register of one or two words; that of WX, WY, WS and WM is among the bits."""
    if BITS_AT <= address < BITS_AT + (LAST_BIT + 1) // 8:
        return bit_span((address - BITS_AT) * 8, 16 * words)
    return Span(Area.BYTES, address, address + 2 * words)


def spans_of(element: str) -> tuple[Span, ...]:
    """All memory of an element's name: ``T5`` its contact and its value, ``DR2`` two registers.

    ``RT5`` and ``RC5`` are only the values. Empty for names that this family does not have.
    """
    found = _WRITTEN.fullmatch(element)
    if not found:
        return ()
    words = 2 if found[1] else 1
    name = found[2] + found[3]
    value_only = bool(found[1]) or name.startswith(("RT", "RC"))
    bit, register = bit_address(name), register_address(name.removeprefix("R") if name[1] in "TC" else name)
    spans = [] if bit is None or value_only or name.startswith("TR") else [bit_span(bit)]
    return tuple(spans) if register is None else (*spans, register_span(register, words))
