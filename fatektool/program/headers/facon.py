"""The header of the FACON paper (command 4F): FB, FBE and FBN.

::

    page 0   'F' · 'B' or 'M' · digit · digit · ladder size high, low · FF to the end

The pages of the ladder follow, as many as its size needs.
"""

from __future__ import annotations

import re
from typing import Final

from fatektool.program.headers.header import FACON, PAGE_BYTES, PAGE_WORDS, Header, printable

_SIGNATURE: Final = re.compile(rb"F[BM]\d\d")


def is_facon(page: bytes) -> bool:
    """True if page 0 has this family's signature."""
    return _SIGNATURE.match(page) is not None


def facon_header(page: bytes, byte_order: str, ladder_words: int) -> Header:
    """Parse page 0 of this family.

    Args:
        page: 128 bytes, in the paper's order.
        byte_order: of the image.
        ladder_words: the ladder size that the PLC reports (53).
    """
    size = int.from_bytes(page[4:6], "big")
    return Header(
        FACON,
        printable(page[:4]),
        byte_order,
        size,
        size_faults(size, ladder_words),
        page[6:] == b"\xff" * (PAGE_BYTES - 6),
        announced_pages=1 + -(-size // PAGE_WORDS),
    )


def foreign_header(page: bytes, ladder_words: int) -> Header:
    """Page 0 of an unknown family: its faults, compared with the paper.

    Args:
        page: 128 bytes.
        ladder_words: the ladder size that the PLC reports (53).
    """
    size = int.from_bytes(page[4:6], "big")
    faults = (*signature_faults(page), *size_faults(size, ladder_words))
    return Header(None, printable(page[:4]), None, size, faults, filled=False)


def signature_faults(page: bytes) -> tuple[str, ...]:
    """The faults of the first four bytes."""
    first, second, *digits = page[:4]
    faults = []
    if first != ord("F"):
        faults.append(f"byte 0: expected F (46), got {_shown(first)}")
    if second not in b"BM":
        faults.append(f"byte 1: expected B (42) or M (4D), got {_shown(second)}")
    for place, byte in enumerate(digits, 2):
        if not 0x30 <= byte <= 0x39:
            faults.append(f"byte {place}: expected a digit, got {_shown(byte)}")
    return tuple(faults)


def size_faults(size: int, ladder_words: int) -> tuple[str, ...]:
    """The faults of the ladder size, for a PLC with this size."""
    if size == ladder_words:
        return ()
    expected = f"expected the ladder size {ladder_words} ({ladder_words:04X})"
    return (f"bytes 4 and 5: {expected}, got {size} ({size:04X})",)


def _shown(byte: int) -> str:
    return f"{chr(byte)} ({byte:02X})" if 0x20 < byte < 0x7F else f"{byte:02X}"
