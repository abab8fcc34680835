"""The pieces of a FACON data field: counts, elements, values, in strict capitals (paper, section 4.1).

::

    n        two hex digits, 00 means 256 where 256 is allowed
    element  symbol and decimal address of fixed width: X0016 · R00012 · DWM0000
    value    a discrete 0 or 1 · 16 bits 4 hex digits · 32 bits 8 hex digits
"""

from __future__ import annotations

import struct
from binascii import unhexlify
from typing import TYPE_CHECKING, Final

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.commands import MAX_DISCRETES
from fatektool.protocol.elements import KINDS, Element

if TYPE_CHECKING:
    from collections.abc import Iterable

HEX_DIGITS: Final = b"0123456789ABCDEF"
CHARS: Final = {1: 1, 16: 4, 32: 8}
"""Characters of one value, by the element's bits."""

_LETTERS: Final = b"ABCDEFGHIJKLMNOPQRSTUVWXYZ"


def element_text(element: Element) -> bytes:
    """An element as FACON writes it: ``R00012``, ``X0016``, ``DWM0000``."""
    return b"%b%0*d" % (element.symbol.encode(), element.kind.digits, element.address)


def take_element(data: bytes, at: int) -> tuple[Element, int]:
    """Read one element; give it and the place behind it.

    Raises:
        FrameError: there is none.
    """
    place = at
    while place < len(data) and data[place] in _LETTERS:
        place += 1
    kind = KINDS.get(data[at:place].decode("ascii"))
    if kind is None:
        raise FrameError(f"no element at character {at} of the data", raw=data)
    digits = data[place : place + kind.digits]
    if len(digits) != kind.digits or not digits.isdigit():
        raise FrameError(f"{kind.symbol}: expected {kind.digits} decimal digits", raw=data)
    try:
        return Element(kind.symbol, int(digits)), place + kind.digits
    except UsageError as error:
        raise FrameError(error.message, raw=data) from error


def unhex(chars: bytes) -> bytes:
    """Bytes of capital hex digits; anything else is a ``FrameError``."""
    try:
        if chars == chars.upper():
            return unhexlify(chars)
    except ValueError:
        pass
    raise FrameError("expected capital hex digits in pairs", raw=chars)


def to_hex(data: bytes) -> bytes:
    """Bytes as capital hex digits."""
    return data.hex().upper().encode()


def count_text(number: int) -> bytes:
    """A number of elements, 1 to 256, as two hex digits; 256 is ``00``."""
    return b"%02X" % (number & 0xFF)


def take_count(data: bytes) -> int:
    """Read the two digits of a number of elements, 0 to 255."""
    return unhex(data[:2].rjust(2, b"?"))[0]


def bits_text(values: Iterable[bool]) -> bytes:
    """Discretes as a character each."""
    return bytes(0x31 if value else 0x30 for value in values)


def take_bits(chars: bytes) -> tuple[bool, ...]:
    """Read discretes, a character each."""
    if chars.translate(None, b"01"):
        raise FrameError("expected 0 or 1 for each discrete", raw=chars)
    return tuple(char == 0x31 for char in chars)


def words_text(values: tuple[int, ...], bits: int) -> bytes:
    """Unsigned values of 16 or 32 bits as 4 or 8 digits each."""
    return to_hex(struct.pack(f">{len(values)}{'I' if bits == 32 else 'H'}", *values))


def take_words(chars: bytes, bits: int) -> tuple[int, ...]:
    """Read unsigned values of 16 or 32 bits."""
    data = unhex(chars)
    size, code = (4, "I") if bits == 32 else (2, "H")
    if len(data) % size:
        raise FrameError(f"expected values of {bits} bits", raw=chars)
    return struct.unpack(f">{len(data) // size}{code}", data)


def value_text(element: Element, value: int) -> bytes:
    """One value, in the characters that its element's width takes."""
    return b"%0*X" % (CHARS[element.kind.bits], value)


def take_value(element: Element, chars: bytes) -> int:
    """Read one value of an element's width."""
    if element.kind.bits == 1:
        return int(take_bits(chars)[0])
    return int.from_bytes(unhex(chars), "big")


def take_run(data: bytes, *, zero_is_256: bool) -> tuple[Element, int, bytes]:
    """Read number and first element of a run; give element, number and the rest."""
    count = take_count(data)
    if not count and zero_is_256:
        count = MAX_DISCRETES
    element, at = take_element(data, 2)
    return element, count, data[at:]


def nothing_after(rest: bytes) -> None:
    """Refuse characters that no field accounts for."""
    if rest:
        raise FrameError(f"{len(rest)} characters too many", raw=rest)
