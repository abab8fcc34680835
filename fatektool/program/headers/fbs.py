"""The header of FBs images: the first four pages, in words of 16 bits, low byte first.

::

    word 0-3      FBS4 and four digits; FFFF to the end of page 0
         100      sum of the words 104 to 255
         101      sum of the code's n + 1 words from word 256 on
         102      sum of the label table, which ends at byte A7FF; FFFF if it is empty
         103      sum of the first words of the ROR area at byte A800; FFFF if there are none
         130      capacity, in words of code          131   n, words of code in use
         132      capacity - 1 - n                    133   0200H, the byte address where code begins
         134      0200H + 2(m + 1), after the m words of the main units
         135      0200H + 2(n + 1), after all code    138   byte address of the label table
         239      number of ROR words                 254   55 AA
         256      code: main units, one word FFFF, sub units, FFFF

Sums are modulo 65536. No paper describes this: it was found in images in project files, of 15 models (see
docs/program-images.md). The byte order of such an image on the line is not known, so both are accepted.
"""

from __future__ import annotations

import re
import struct
from typing import TYPE_CHECKING, Final

from fatektool.program.headers.header import FBS, PAGE_BYTES, PAGE_WORDS, SWAPPED, Header, Sum, printable

if TYPE_CHECKING:
    from collections.abc import Sequence

HEADER_PAGES: Final = 4
CODE: Final = HEADER_PAGES * PAGE_WORDS
_SIGNATURE: Final = re.compile(rb"FBS4\d{4}")
_START: Final = re.compile(rb"FBS4")
_SIGNATURE_BYTES: Final = 8
_CODE_ADDRESS: Final = 2 * CODE
_LABELS_END: Final = 0xA800
_ROR: Final = 0xA800
_ERASED: Final = 0xFFFF
_MARK: Final = 0xAA55


def is_fbs(page: bytes) -> bool:
    """True if page 0 has the signature of this family."""
    return _START.match(page) is not None


def fbs_header(pages: Sequence[bytes], first: bytes, byte_order: str) -> Header:
    """Parse the header of an image of this family.

    Args:
        pages: the image as read, 128 bytes each.
        first: page 0 in the order of the paper.
        byte_order: of the image.
    """
    signature = printable(first[:_SIGNATURE_BYTES])
    filled = first[_SIGNATURE_BYTES:] == b"\xff" * (PAGE_BYTES - _SIGNATURE_BYTES)
    faults = []
    if not _SIGNATURE.match(first):
        faults.append(f"bytes 4 to 7: expected four digits, got {first[4:8].hex(' ').upper()}")
    if len(pages) < HEADER_PAGES:
        faults.append(f"expected a header of {HEADER_PAGES} pages, got {len(pages)}")
        return Header(FBS, signature, byte_order, None, tuple(faults), filled)
    words = _words(pages, byte_order)
    faults += _faults(words)
    capacity, used = words[130:132]
    holds = not faults
    return Header(
        FBS,
        signature,
        byte_order,
        None,
        tuple(faults),
        filled,
        announced_pages=-(-(CODE + capacity) // PAGE_WORDS) if holds else None,
        code_words=used,
        capacity_words=capacity,
        checksum=Sum(words[101], _sum(words, CODE, used + 1) if holds else None),
        sums={
            "settings": Sum(words[100], _sum(words, 104, CODE - 104)),
            "labels": Sum(words[102], _sum_of_labels(words) if holds else None),
            "ror": Sum(words[103], _sum_of_ror(words) if holds else None),
        },
    )


def _faults(words: tuple[int, ...]) -> list[str]:
    """The contradictions between the words 130 to 135, and 254."""
    capacity, used, _, begin, main_end, end = words[130:136]
    faults = []

    def expect(word: int, what: str, expected: int) -> None:
        if words[word] != expected:
            faults.append(f"word {word}: expected {what} {expected:04X}, got {words[word]:04X}")

    if used >= capacity:
        faults.append(f"word 131: expected less code than the capacity of {capacity} words, got {used}")
    expect(132, "capacity less code in use,", (capacity - 1 - used) & 0xFFFF)
    expect(133, "the address of code,", _CODE_ADDRESS)
    expect(135, "the address after all code,", (_CODE_ADDRESS + 2 * (used + 1)) & 0xFFFF)
    if not begin < main_end <= end or main_end % 2:
        faults.append(
            f"word 134: expected an even address of {begin + 2:04X} to {end:04X} after the main units, "
            f"got {main_end:04X}"
        )
    expect(254, "the mark", _MARK)
    if not faults and CODE + used + 1 > len(words):
        faults.append(f"word 131: expected code that ends in the {len(words)} words of the image, got {used}")
    return faults


def _words(pages: Sequence[bytes], byte_order: str) -> tuple[int, ...]:
    order = ">" if byte_order == SWAPPED else "<"
    return struct.unpack(f"{order}{len(pages) * PAGE_WORDS}H", b"".join(pages))


def _sum(words: tuple[int, ...], first: int, count: int) -> int | None:
    part = words[first : first + count]
    return sum(part) & 0xFFFF if len(part) == count else None


def _sum_of_labels(words: tuple[int, ...]) -> int | None:
    begin = words[138]
    if begin >= _LABELS_END:
        return _ERASED
    if begin % 2 or begin < words[135]:
        return None
    return _sum(words, begin // 2, (_LABELS_END - begin) // 2)


def _sum_of_ror(words: tuple[int, ...]) -> int | None:
    count = words[239]
    if count in {0, _ERASED}:
        return _ERASED
    return _sum(words, _ROR // 2, count)
