"""The program image of a PLC: header and ladder in pages of 64 words, 128 bytes (FACON paper, command 4F).

::

    facon    page 0 the header, 1..N the ladder; N = ladder size / 64 rounded up
    fbs      pages 0..3 the header, the code from page 4 on, labels and more behind it

The ladder size that the PLC says it has (53) asks for N + 1 pages. A PLC that refuses the pages past its end
gave its whole program with less: all that the header announces, or all but the very last. An image is what
the PLC holds, no more: not a project file of the vendor's program, no comments that the PLC does not keep, no
register values.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError
from fatektool.program.headers.families import fewest_pages, read_header
from fatektool.program.headers.header import PAGE_BYTES, PAGE_WORDS

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fatektool.program.headers.header import Header

LAST_LADDER_WORDS: Final = 0xFFFF


def page_count(ladder_words: int) -> int:
    """How many pages a ladder size asks for, the header included: 8192 words are 129."""
    return 1 + -(-ladder_words // PAGE_WORDS)


def is_whole(pages: Sequence[bytes], ladder_words: int) -> bool:
    """True if these pages are a whole program where the PLC refuses all that follow."""
    most = page_count(ladder_words)
    return len(pages) == most or fewest_pages(pages, ladder_words, most) <= len(pages) < most


@dataclass(frozen=True, slots=True)
class Program:
    """A whole program image.

    Attributes:
        ladder_words: the ladder size that the PLC reports (53), 1 to 65535.
        pages: 128 bytes each, page 0 first; as many as the ladder size asks for, or as ``is_whole`` allows.

    Raises:
        DataError: a wrong number or length of pages, or no ladder.
    """

    ladder_words: int
    pages: tuple[bytes, ...]

    def __post_init__(self) -> None:
        if not 1 <= self.ladder_words <= LAST_LADDER_WORDS:
            raise DataError(f"ladder size: expected 1 to {LAST_LADDER_WORDS} words, got {self.ladder_words}")
        for number, page in enumerate(self.pages):
            if len(page) != PAGE_BYTES:
                raise DataError(f"page {number}: expected {PAGE_BYTES} bytes, got {len(page)}", page=number)
        if not is_whole(self.pages, self.ladder_words):
            raise DataError(
                f"a ladder of {self.ladder_words} words has {page_count(self.ladder_words)} pages, "
                f"got {len(self.pages)}"
            )

    @property
    def header(self) -> Header:
        """What the first pages say."""
        return read_header(self.pages, self.ladder_words)

    @property
    def header_faults(self) -> tuple[str, ...]:
        """What does not hold of the header; empty for a header that holds."""
        return self.header.faults

    @property
    def pages_asked_for(self) -> int:
        """How many pages the ladder size asks for; more than there are if the PLC refused some."""
        return page_count(self.ladder_words)

    @property
    def data(self) -> bytes:
        """All pages' bytes in order."""
        return b"".join(self.pages)

    @property
    def sha256(self) -> str:
        """The hash by which two people can see whether they hold the same program."""
        return hashlib.sha256(self.data).hexdigest()

    def require_header(self, hint: str | None = None) -> None:
        """Raise unless the header holds.

        Args:
            hint: the next step.

        Raises:
            DataError: it does not; says what.
        """
        faults = self.header_faults
        if faults:
            raise DataError(
                f"the program's header (page 0) does not hold: {'; '.join(faults)}",
                hint=hint,
                page=0,
                faults=list(faults),
            )


def ranges(numbers: Iterable[int]) -> str:
    """Numbers in words for a message: ``0-4, 7, 9-12``."""
    parts: list[list[int]] = []
    for number in sorted(numbers):
        if parts and parts[-1][1] == number - 1:
            parts[-1][1] = number
        else:
            parts.append([number, number])
    return ", ".join(f"{first}" if first == last else f"{first}-{last}" for first, last in parts)
