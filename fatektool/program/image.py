"""The program image of a PLC: header and ladder in pages of 64 words, 128 bytes (FACON paper, command 4F).

::

    facon    page 0 the header, 1..N the ladder; N = ladder size / 64 rounded up
    fbs      pages 0..3 the header, the code from page 4 on, then labels and more

For the ladder size that the PLC reports (53), there are N + 1 pages. If a PLC refuses the pages after its
end, fewer pages are a complete program: all that the header announces, or one less. An image has only what
the PLC has: it is not a project file of the vendor's software, and has no comments and no register values.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError
from fatektool.program.headers.families import fewest_pages, read_header
from fatektool.program.headers.header import PAGE_BYTES, PAGE_WORDS

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from fatektool.program.headers.header import Header

LAST_LADDER_WORDS: Final = 0xFFFF


def page_count(ladder_words: int) -> int:
    """The number of pages for a ladder size, the header included: 129 for 8192 words."""
    return 1 + -(-ladder_words // PAGE_WORDS)


def is_whole(pages: Sequence[bytes], ladder_words: int) -> bool:
    """True if these pages are a complete program, if the PLC refuses all further pages."""
    most = page_count(ladder_words)
    return len(pages) == most or fewest_pages(pages, ladder_words, most) <= len(pages) < most


@dataclass(frozen=True, slots=True)
class Program:
    """A complete program image.

    Attributes:
        ladder_words: the ladder size that the PLC reports (53), 1 to 65535.
        pages: 128 bytes each, page 0 first; as many as the ladder size needs, or as ``is_whole`` allows.

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
        """The header in the first pages."""
        return read_header(self.pages, self.ladder_words)

    @property
    def header_faults(self) -> tuple[str, ...]:
        """The faults of the header; empty for a valid header."""
        return self.header.faults

    @property
    def pages_asked_for(self) -> int:
        """The number of pages for the ladder size; more than ``pages`` has if the PLC refused some."""
        return page_count(self.ladder_words)

    @property
    def data(self) -> bytes:
        """All pages' bytes in order."""
        return b"".join(self.pages)

    @property
    def sha256(self) -> str:
        """The hash of the program: two people can compare it."""
        return hashlib.sha256(self.data).hexdigest()

    def require_header(self, hint: str | None = None) -> None:
        """Raise unless the header is valid.

        Args:
            hint: the next step.

        Raises:
            DataError: it is invalid; with the faults.
        """
        faults = self.header_faults
        if faults:
            raise DataError(
                f"invalid header of the program (page 0): {'; '.join(faults)}",
                hint=hint,
                page=0,
                faults=list(faults),
            )


def ranges(numbers: Iterable[int]) -> str:
    """Numbers as text for a message: ``0-4, 7, 9-12``."""
    parts: list[list[int]] = []
    for number in sorted(numbers):
        if parts and parts[-1][1] == number - 1:
            parts[-1][1] = number
        else:
            parts.append([number, number])
    return ", ".join(f"{first}" if first == last else f"{first}-{last}" for first, last in parts)


def page_ranges(pages: Collection[int]) -> str:
    """Pages as text for a message: ``page 7``, ``pages 0-4, 7``."""
    return f"{'page' if len(pages) == 1 else 'pages'} {ranges(pages)}"
