"""The notation of FACON data fields: characters (FACON paper, section 4.1).

Symbols have only capital letters. Hex digits are written as capitals; small ones are read too.

::

    n        two hex digits, 00 means 256 where 256 is allowed
    element  symbol and decimal address of fixed width: X0016 · R00012 · DWM0000
    value    a discrete 0 or 1 · 16 bits 4 hex digits · 32 bits 8 hex digits
"""

from __future__ import annotations

from binascii import unhexlify
from typing import TYPE_CHECKING, ClassVar, Final

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.fatek.notation import Notation

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

HEX_DIGITS: Final = b"0123456789ABCDEFabcdef"
_LETTERS: Final = b"ABCDEFGHIJKLMNOPQRSTUVWXYZ"


class TextNotation(Notation):
    """Characters."""

    unit = "characters"
    octet = 2
    value_sizes: ClassVar[Mapping[int, int]] = {1: 1, 16: 4, 32: 8}
    no_error = b"0"
    error_name = "error character"
    bit_alphabet = b"01"
    value_alphabet = HEX_DIGITS

    def octets(self, data: bytes) -> bytes:
        """Bytes as capital hex digits."""
        return data.hex().upper().encode()

    def take_octets(self, raw: bytes) -> bytes:
        """Bytes of hex digits; anything else is a ``FrameError``."""
        try:
            return unhexlify(raw)
        except ValueError:
            raise FrameError("expected hex digits in pairs", raw=raw) from None

    def bits(self, values: Iterable[bool]) -> bytes:
        """Discretes, one character each."""
        return bytes(0x31 if value else 0x30 for value in values)

    def take_bits(self, raw: bytes) -> tuple[bool, ...]:
        """Parse discretes, one character each."""
        if raw.translate(None, b"01"):
            raise FrameError("expected 0 or 1 for each discrete", raw=raw)
        return tuple(char == 0x31 for char in raw)

    def digit(self, value: int) -> bytes:
        """A control or error code as one hex digit."""
        return b"%X" % value

    def shown(self, value: int) -> str:
        """One hex digit."""
        return f"{value:X}"

    def count(self, number: int) -> bytes:
        """A number of elements, 1 to 256, as two hex digits; 256 is ``00``."""
        return b"%02X" % (number & 0xFF)

    def take_count(self, data: bytes) -> int:
        """Parse the two digits of a number of elements, 0 to 255."""
        return self.take_octets(data[:2].rjust(2, b"?"))[0]

    def element(self, element: Element) -> bytes:
        """``R00012``, ``X0016``, ``DWM0000``."""
        return b"%b%0*d" % (element.symbol.encode(), element.kind.digits, element.address)

    def element_size(self, element: Element) -> int:
        """Symbol and digits."""
        return len(element.symbol) + element.kind.digits

    def take_element(self, data: bytes, at: int) -> tuple[Element, int]:
        """Parse one element: all letters are the symbol."""
        place = at
        while place < len(data) and data[place] in _LETTERS:
            place += 1
        kind = KINDS.get(data[at:place].decode("ascii"))
        if kind is None:
            raise FrameError(f"expected an element at character {at} of the data", raw=data)
        digits = data[place : place + kind.digits]
        if len(digits) != kind.digits or not digits.isdigit():
            raise FrameError(f"{kind.symbol}: expected {kind.digits} decimal digits", raw=data)
        try:
            return Element(kind.symbol, int(digits)), place + kind.digits
        except UsageError as error:
            raise FrameError(error.message, raw=data) from error

    def error_code(self, data: bytes) -> int | None:
        """One hex digit, 1 to F."""
        return int(data, 16) if len(data) == 1 and data != b"0" and data in HEX_DIGITS else None

    def wrong_error(self, data: bytes) -> FrameError:
        """The error for an answer of the right length that does not begin with 0."""
        return FrameError(f"expected the error character 0 before the data, got {data[:1]!r}", raw=data)


TEXT: Final = TextNotation()
