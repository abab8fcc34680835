"""Reads the fields of a FACON request's data one after the other, and says no as a PLC does.

::

    n        2 hex digits       00 is 256 where 256 is allowed
    element  X0016  WY0008  DWM0000  RT0000  R00012  DR00002
    value    1, 4 or 8 characters by the element's width

Which error a bad field is (FACON paper, section 3 gives the words, the examples are in brackets):

* **4, illegal format**: too few or too many characters, an unknown symbol, a register where a
  discrete is due or the other way round.
* **2, illegal value**: a character that is no digit of its field ('decimal format contains
  hexadecimal number'), and an n or control code out of its range ('over range of value').
* **A, illegal address**: every element of the right form that this PLC does not have.
"""

from __future__ import annotations

import re

from fatektool.simulator.elements import KINDS, Kind
from fatektool.simulator.refusal import Refusal, RefusalCode
from fatektool.simulator.slaves.facon.frame import BYTE_OF

_HEX_DIGITS = b"0123456789ABCDEF"
_LETTERS = re.compile(rb"[A-Z]*")
_WIDE_AREAS = ("R", "D", "F")
_BY_SYMBOL = {
    symbol.encode("ascii"): (kind, 5 if kind.area in _WIDE_AREAS else 4) for symbol, kind in KINDS.items()
}
"""R, D and F addresses have 5 digits, all others 4 (FACON paper, section 4.1)."""

VALUE_CHARACTERS = {1: 1, 16: 4, 32: 8}
"""Characters of one value by the element's bits."""


def hex_value(text: bytes) -> int:
    """Upper-case hex digits as a number."""
    if text.translate(None, _HEX_DIGITS):
        raise Refusal(RefusalCode.ILLEGAL_VALUE)
    return int(text, 16)


class Fields:
    """A cursor over the data of one request."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._position = 0

    def take(self, count: int) -> bytes:
        """The next ``count`` characters."""
        start = self._position
        self._position = end = start + count
        if end > len(self._data):
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        return self._data[start:end]

    def end(self) -> None:
        """Refuses anything that is left."""
        if self._position != len(self._data):
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)

    def count(self, limit: int) -> int:
        """n, 1 to ``limit``; 00 means 256 if that is the limit."""
        value = BYTE_OF.get(self.take(2))
        if value == 0 and limit == 256:
            return limit
        if value is None or not 1 <= value <= limit:
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return value

    def code(self, first: int, last: int) -> int:
        """A control code of one digit."""
        digit = self.take(1)
        if not digit.isdigit() or not first <= int(digit) <= last:
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return int(digit)

    def element(self, *widths: int) -> tuple[Kind, int]:
        """An element of one of ``widths`` bits: its kind and address."""
        # All letters are the symbol: DX is no D, though D is one.
        end = _letters_end(self._data, self._position)
        found = _BY_SYMBOL.get(self._data[self._position : end])
        if found is None:
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        kind, digits = found
        if kind.bits not in widths:
            raise Refusal(RefusalCode.ILLEGAL_FORMAT)
        self._position = end
        address = self.take(digits)
        if not address.isdigit():
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return kind, int(address)

    def values(self, kind: Kind, count: int) -> list[int]:
        """``count`` values of a register's width."""
        width = VALUE_CHARACTERS[kind.bits]
        text = self.take(width * count)
        return [hex_value(text[at : at + width]) for at in range(0, len(text), width)]

    def states(self, count: int) -> bytes:
        """``count`` states of discretes as bytes 0 or 1."""
        text = self.take(count)
        if text.translate(None, b"01"):
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return text.translate(_STATE_OF_CHARACTER)


def _letters_end(data: bytes, start: int) -> int:
    letters = _LETTERS.match(data, start)
    return letters.end() if letters else start


_STATE_OF_CHARACTER = bytes.maketrans(b"01", b"\x00\x01")
