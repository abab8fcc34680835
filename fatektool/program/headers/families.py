"""The family of an image, by its signature in one byte order or the other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.program.headers.facon import (
    facon_header,
    foreign_header,
    is_facon,
    signature_faults,
    size_faults,
)
from fatektool.program.headers.fbs import fbs_header, is_fbs
from fatektool.program.headers.header import AS_PAPER, SWAPPED, Header, printable, swapped

if TYPE_CHECKING:
    from collections.abc import Sequence


def read_header(pages: Sequence[bytes], ladder_words: int) -> Header:
    """Parse the header of an image. Never raises: the faults are in ``faults``.

    Args:
        pages: one or more, 128 bytes each.
        ladder_words: the ladder size that the PLC reports (53).
    """
    for byte_order, page in ((AS_PAPER, pages[0]), (SWAPPED, swapped(pages[0]))):
        if is_fbs(page):
            return fbs_header(pages, page, byte_order)
        if is_facon(page):
            return facon_header(page, byte_order, ladder_words)
    return foreign_header(pages[0], ladder_words)


def short_document(page: bytes, ladder_words: int) -> dict[str, Any]:
    """The header of older backup files, without families: page 0 compared with the FACON paper."""
    size = int.from_bytes(page[4:6], "big")
    return {
        "valid": not signature_faults(page) and not size_faults(size, ladder_words),
        "signature": printable(page[:4]),
        "ladder_words": size,
    }


def fewest_pages(pages: Sequence[bytes], ladder_words: int, most: int) -> int:
    """The pages of a complete program, if the PLC refuses all further pages.

    All pages that the header announces; or one less, because in some PLCs the ladder size includes the header
    page.

    Args:
        pages: those that were read.
        ladder_words: the ladder size that the PLC reports (53).
        most: the number of pages for that size.
    """
    if not pages:
        return most
    announced = read_header(pages, ladder_words).announced_pages
    return max(2, min(most - 1, most if announced is None else announced))
