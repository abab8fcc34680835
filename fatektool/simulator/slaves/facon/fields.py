"""The notation of fields in FACON requests: characters.

::

    n        2 hex digits       00 is 256 where 256 is allowed
    element  X0016  WY0008  DWM0000  RT0000  R00012  DR00002
    value    1, 4 or 8 characters by the element's width

A character that is no digit of its field is error 2, illegal value ('decimal format contains hexadecimal
number'); so is an n or a control code out of its range ('over range of value'; FACON paper, section 3).
"""

from __future__ import annotations

import re

from fatektool.simulator.elements import KINDS, SymbolKind
from fatektool.simulator.refusal import Refusal, RefusalCode
from fatektool.simulator.slaves.facon.frame import BYTE_OF
from fatektool.simulator.slaves.fatek.fields import Fields

_HEX_DIGITS = b"0123456789ABCDEF"
_LETTERS = re.compile(rb"[A-Z]*")
_WIDE_AREAS = ("R", "D", "F")
_BY_SYMBOL = {
    symbol.encode("ascii"): (kind, 5 if kind.area in _WIDE_AREAS else 4) for symbol, kind in KINDS.items()
}
"""R, D and F addresses have 5 digits, all others 4 (FACON paper, section 4.1)."""

_STATE_OF_CHARACTER = bytes.maketrans(b"01", b"\x00\x01")
_CHARACTER_OF_STATE = bytes.maketrans(b"\x00\x01", b"01")


def require_hex(text: bytes) -> None:
    """Refuse anything except upper-case hex digits."""
    if text.translate(None, _HEX_DIGITS):
        raise Refusal(RefusalCode.ILLEGAL_VALUE)


def to_hex(content: bytes) -> bytes:
    """Bytes as upper-case hex digits."""
    return content.hex().upper().encode("ascii")


class FaconFields(Fields):
    """A cursor over characters."""

    def take_number(self) -> int | None:
        """Two hex digits."""
        return BYTE_OF.get(self.take(2))

    def take_digit(self) -> int | None:
        """One decimal digit."""
        digit = self.take(1)
        return int(digit) if digit.isdigit() else None

    def take_content(self, count: int) -> bytes:
        """Two hex digits for each byte."""
        text = self.take(2 * count)
        require_hex(text)
        return bytes.fromhex(text.decode("ascii"))

    def element(self, *widths: int) -> tuple[SymbolKind, int]:
        """All letters are the symbol: DX is not D, although D is a symbol."""
        letters = _LETTERS.match(self._data, self._position)
        end = letters.end() if letters else self._position
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

    def states(self, count: int) -> bytes:
        """One character each."""
        text = self.take(count)
        if text.translate(None, b"01"):
            raise Refusal(RefusalCode.ILLEGAL_VALUE)
        return text.translate(_STATE_OF_CHARACTER)

    def written(self, content: bytes) -> bytes:
        """Two hex digits for each byte."""
        return to_hex(content)

    def written_states(self, states: bytes) -> bytes:
        """One character each."""
        return states.translate(_CHARACTER_OF_STATE)
