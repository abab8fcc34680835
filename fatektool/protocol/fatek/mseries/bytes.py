"""The pieces of an M-series data field: counts, elements, values, in binary (M-series paper, section 2.4).

::

    n        one byte, 00 means 256 where 256 is allowed
    element  symbol, 1 to 3 letters · address, 2 bytes, high byte first: 58 00 10 is X16
    value    a discrete 00 or 01 · 16 bits 2 bytes · 32 bits 4 bytes, high byte first

Nothing says how long a symbol is: ``44 57 58`` begins DWX, or is D22360. The longest symbol that matches is
taken. An address whose high byte is a letter may so be read another way: R17152 is ``52 43 00``, which begins
as RC does. Such an element is never sent.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Final

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.commands import MAX_DISCRETES
from fatektool.protocol.elements import KINDS, Element

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

ADDRESS_BYTES: Final = 2
VALUE_BYTES: Final = {1: 1, 16: 2, 32: 4}
"""Bytes of one value, by the element's bits."""

_SYMBOLS: Final = {symbol.encode(): symbol for symbol in KINDS}
_LONGEST: Final = max(map(len, _SYMBOLS))
_FIRST_LETTER: Final = ord("A") << 8
"""Below this an address has no letter for its high byte."""


def element_size(element: Element) -> int:
    """How many bytes an element takes."""
    return len(element.symbol) + ADDRESS_BYTES


def element_bytes(element: Element) -> bytes:
    """An element as it is sent: ``52 00 0C``.

    Raises:
        UsageError: the receiver would take it for another.
    """
    data = element.symbol.encode() + element.address.to_bytes(ADDRESS_BYTES, "big")
    if element.address < _FIRST_LETTER:
        return data
    seen = _symbol_at(data, 0)
    if seen != element.symbol:
        raise UsageError(
            f"{element} cannot be named in mseries: its bytes {data.hex(' ').upper()} begin as {seen} does",
            hint="read or write it in a run that begins below it",
            element=str(element),
        )
    return data


def take_element(data: bytes, at: int) -> tuple[Element, int]:
    """Read one element; give it and the place behind it.

    Raises:
        FrameError: there is none.
    """
    symbol = _symbol_at(data, at)
    if symbol is None:
        raise FrameError(f"no element at byte {at} of the data", raw=data)
    place = at + len(symbol)
    address = data[place : place + ADDRESS_BYTES]
    if len(address) != ADDRESS_BYTES:
        raise FrameError(f"{symbol}: expected an address of {ADDRESS_BYTES} bytes", raw=data)
    try:
        return Element(symbol, int.from_bytes(address, "big")), place + ADDRESS_BYTES
    except UsageError as error:
        raise FrameError(error.message, raw=data) from error


def _symbol_at(data: bytes, at: int) -> str | None:
    """The longest symbol that begins here, None for none."""
    for size in range(_LONGEST, 0, -1):
        symbol = _SYMBOLS.get(data[at : at + size])
        if symbol is not None:
            return symbol
    return None


def count_byte(number: int) -> bytes:
    """A number of elements, 1 to 256, as one byte; 256 is 00."""
    return bytes([number & 0xFF])


def take_count(data: bytes) -> int:
    """Read the byte of a number of elements, 0 to 255."""
    if not data:
        raise FrameError("expected a number of elements", raw=data)
    return data[0]


def take_run(data: bytes, *, zero_is_256: bool) -> tuple[Element, int, bytes]:
    """Read number and first element of a run; give element, number and the rest."""
    count = take_count(data)
    if not count and zero_is_256:
        count = MAX_DISCRETES
    element, at = take_element(data, 1)
    return element, count, data[at:]


def value_bytes(element: Element, value: int) -> bytes:
    """One value, in the bytes that its element's width takes."""
    return value.to_bytes(VALUE_BYTES[element.kind.bits], "big")


def take_value(element: Element, data: bytes) -> int:
    """Read one value of an element's width."""
    if element.kind.bits == 1:
        return int(take_bits(data)[0])
    return int.from_bytes(data, "big")


def take_bits(data: bytes) -> tuple[bool, ...]:
    """Read discretes, a byte each."""
    if data.translate(None, b"\0\1"):
        raise FrameError("expected 00 or 01 for each discrete", raw=data)
    return tuple(map(bool, data))


def words_bytes(values: Sequence[int], bits: int) -> bytes:
    """Unsigned values of 16 or 32 bits."""
    return struct.pack(f">{len(values)}{'I' if bits == 32 else 'H'}", *values)


def take_words(data: bytes, bits: int) -> tuple[int, ...]:
    """Read unsigned values of 16 or 32 bits."""
    size, code = (4, "I") if bits == 32 else (2, "H")
    if len(data) % size:
        raise FrameError(f"expected values of {bits} bits", raw=data)
    return struct.unpack(f">{len(data) // size}{code}", data)


def take_values(elements: Iterable[Element], data: bytes) -> tuple[int, ...]:
    """Read a value for each of these elements, as many bytes as they take."""
    values = []
    at = 0
    for element in elements:
        end = at + VALUE_BYTES[element.kind.bits]
        values.append(take_value(element, data[at:end]))
        at = end
    return tuple(values)


def nothing_after(rest: bytes) -> None:
    """Refuse bytes that no field accounts for."""
    if rest:
        raise FrameError(f"{len(rest)} bytes too many", raw=rest)
