"""The program image of a PLC: a header page and the ladder's pages (FACON paper, command 4F).

::

    page 0      header: 'F' · 'B' or 'M' · digit · digit · ladder size high, low · FF to the end
    page 1..N   the ladder, N = ladder size / 64 rounded up

A page is 64 words, 128 bytes. An image is what the PLC holds, no more: not a project file of the vendor's
program, no comments that the PLC does not keep, no register values.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError

if TYPE_CHECKING:
    from collections.abc import Iterable

PAGE_WORDS: Final = 64
PAGE_BYTES: Final = 2 * PAGE_WORDS
LAST_LADDER_WORDS: Final = 0xFFFF


def page_count(ladder_words: int) -> int:
    """How many pages an image of this ladder size has, the header included: 8192 words are 129."""
    return 1 + -(-ladder_words // PAGE_WORDS)


@dataclass(frozen=True, slots=True)
class Header:
    """What page 0 says of the program.

    Attributes:
        signature: the first four characters (``FB30``), None if they are not printable ASCII.
        ladder_words: the ladder size that it names, in words.
        faults: what does not hold, in words, without regard to any PLC; empty for a header that holds.
        filled: True if the rest of the page is FF, as the paper draws it.
    """

    signature: str | None
    ladder_words: int
    faults: tuple[str, ...]
    filled: bool

    @classmethod
    def parse(cls, page: bytes) -> Header:
        """Read page 0. Never raises: what does not hold is named in ``faults``."""
        first, second, third, fourth = page[:4]
        faults = []
        if first != ord("F"):
            faults.append(f"byte 0: expected F (46), got {_shown(first)}")
        if second not in b"BM":
            faults.append(f"byte 1: expected B (42) or M (4D), got {_shown(second)}")
        for place, byte in ((2, third), (3, fourth)):
            if not 0x30 <= byte <= 0x39:
                faults.append(f"byte {place}: expected a digit, got {_shown(byte)}")
        printable = all(0x20 < byte < 0x7F for byte in page[:4])
        return cls(
            page[:4].decode("ascii") if printable else None,
            int.from_bytes(page[4:6], "big"),
            tuple(faults),
            page[6:] == b"\xff" * (PAGE_BYTES - 6),
        )

    def faults_for(self, ladder_words: int) -> tuple[str, ...]:
        """All that does not hold, for a PLC of this ladder size."""
        if self.ladder_words == ladder_words:
            return self.faults
        size = (
            f"bytes 4 and 5: expected the ladder size {ladder_words} ({ladder_words:04X}), "
            f"got {self.ladder_words} ({self.ladder_words:04X})"
        )
        return (*self.faults, size)


@dataclass(frozen=True, slots=True)
class Program:
    """A whole program image.

    Attributes:
        ladder_words: the ladder size that the PLC told (53), 1 to 65535.
        pages: 128 bytes each, page 0 first; as many as the ladder size asks for.

    Raises:
        DataError: a wrong number or length of pages, or no ladder.
    """

    ladder_words: int
    pages: tuple[bytes, ...]

    def __post_init__(self) -> None:
        if not 1 <= self.ladder_words <= LAST_LADDER_WORDS:
            raise DataError(f"ladder size: expected 1 to {LAST_LADDER_WORDS} words, got {self.ladder_words}")
        expected = page_count(self.ladder_words)
        if len(self.pages) != expected:
            raise DataError(
                f"a ladder of {self.ladder_words} words has {expected} pages, got {len(self.pages)}"
            )
        for number, page in enumerate(self.pages):
            if len(page) != PAGE_BYTES:
                raise DataError(f"page {number}: expected {PAGE_BYTES} bytes, got {len(page)}", page=number)

    @property
    def header(self) -> Header:
        """Page 0, read."""
        return Header.parse(self.pages[0])

    @property
    def header_faults(self) -> tuple[str, ...]:
        """What does not hold of the header; empty for a header that holds."""
        return self.header.faults_for(self.ladder_words)

    @property
    def data(self) -> bytes:
        """All pages' bytes in order."""
        return b"".join(self.pages)

    @property
    def sha256(self) -> str:
        """The hash by which two people can tell whether they hold the same program."""
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


def _shown(byte: int) -> str:
    return f"{chr(byte)} ({byte:02X})" if 0x20 < byte < 0x7F else f"{byte:02X}"
