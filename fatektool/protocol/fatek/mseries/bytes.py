"""The notation of M-series data fields: bytes (M-series paper, section 2.4).

::

    n        one byte, 00 means 256 where 256 is allowed
    element  symbol, 1 to 3 letters · address, 2 bytes, high byte first: 58 00 10 is X16
    value    a discrete 00 or 01 · 16 bits 2 bytes · 32 bits 4 bytes, high byte first

There is no length of a symbol: ``44 57 58`` is the beginning of DWX, or D22360. The longest symbol that
matches is used. So an address whose high byte is a letter may be read as something else: R17152 is ``52 43
00``, which begins like RC. Such an element is never sent.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Final

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.fatek.notation import Notation

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_ADDRESS_BYTES: Final = 2
_SYMBOLS: Final = {symbol.encode(): symbol for symbol in KINDS}
_LONGEST: Final = max(map(len, _SYMBOLS))
_FIRST_LETTER: Final = ord("A") << 8
"""Below this an address has no letter for its high byte."""


class BinaryNotation(Notation):
    """Bytes."""

    unit = "bytes"
    octet = 1
    value_sizes: ClassVar[Mapping[int, int]] = {1: 1, 16: 2, 32: 4}
    no_error = b"\0"
    error_name = "error byte"
    bit_alphabet = bytes(range(256))
    value_alphabet = bytes(range(256))

    def octets(self, data: bytes) -> bytes:
        """The same bytes."""
        return data

    def take_octets(self, raw: bytes) -> bytes:
        """The same bytes."""
        return raw

    def bits(self, values: Iterable[bool]) -> bytes:
        """Discretes, one byte each."""
        return bytes(values)

    def take_bits(self, raw: bytes) -> tuple[bool, ...]:
        """Parse discretes, one byte each."""
        if raw.translate(None, b"\0\1"):
            raise FrameError("expected 00 or 01 for each discrete", raw=raw)
        return tuple(map(bool, raw))

    def digit(self, value: int) -> bytes:
        """A control code as one byte."""
        return bytes([value])

    def shown(self, value: int) -> str:
        """One byte in hex."""
        return f"{value:02X}"

    def count(self, number: int) -> bytes:
        """A number of elements, 1 to 256, as one byte; 256 is 00."""
        return bytes([number & 0xFF])

    def take_count(self, data: bytes) -> int:
        """Read the byte of a number of elements, 0 to 255."""
        if not data:
            raise FrameError("expected a number of elements", raw=data)
        return data[0]

    def element(self, element: Element) -> bytes:
        """``52 00 0C``; refused if the receiver would read another element."""
        data = element.symbol.encode() + element.address.to_bytes(_ADDRESS_BYTES, "big")
        if element.address < _FIRST_LETTER:
            return data
        seen = _symbol_at(data, 0)
        if seen != element.symbol:
            raise UsageError(
                f"{element} cannot be sent in mseries: its bytes {data.hex(' ').upper()} begin like {seen}",
                hint="read or write it in a run that begins below it",
                element=str(element),
            )
        return data

    def element_size(self, element: Element) -> int:
        """Symbol and address."""
        return len(element.symbol) + _ADDRESS_BYTES

    def take_element(self, data: bytes, at: int) -> tuple[Element, int]:
        """Parse one element: the longest symbol that matches."""
        symbol = _symbol_at(data, at)
        if symbol is None:
            raise FrameError(f"expected an element at byte {at} of the data", raw=data)
        place = at + len(symbol)
        address = data[place : place + _ADDRESS_BYTES]
        if len(address) != _ADDRESS_BYTES:
            raise FrameError(f"{symbol}: expected an address of {_ADDRESS_BYTES} bytes", raw=data)
        try:
            return Element(symbol, int.from_bytes(address, "big")), place + _ADDRESS_BYTES
        except UsageError as error:
            raise FrameError(error.message, raw=data) from error

    def error_code(self, data: bytes) -> int | None:
        """One byte, 01 to FF."""
        return data[0] if len(data) == 1 and data[0] else None

    def wrong_error(self, data: bytes) -> FrameError:
        """The error for an answer of the right length that does not begin with 00."""
        return FrameError(f"expected the error byte 00 before the data, got {data[0]:02X}", raw=data)


def _symbol_at(data: bytes, at: int) -> str | None:
    """The longest symbol at this place; None if there is none."""
    for size in range(_LONGEST, 0, -1):
        symbol = _SYMBOLS.get(data[at : at + size])
        if symbol is not None:
            return symbol
    return None


BINARY: Final = BinaryNotation()
