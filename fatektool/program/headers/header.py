"""The header of a program, of any family; the ``header`` object in JSON.

::

    family   signature   byte order            contents
    facon    FB30        as paper or swapped   ladder size
    fbs      FBS40003    as paper or swapped   code capacity, code in use, four sums
    -        FB?? or -   -                     nothing valid
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

AS_PAPER: Final = "as paper"
SWAPPED: Final = "swapped"
FACON: Final = "facon"
FBS: Final = "fbs"
PAGE_WORDS: Final = 64
PAGE_BYTES: Final = 2 * PAGE_WORDS


@dataclass(frozen=True, slots=True)
class Sum:
    """A checksum of 16 bits.

    Attributes:
        stored: as in the header.
        computed: from the words; None if they are not in the image.
    """

    stored: int
    computed: int | None

    @property
    def valid(self) -> bool | None:
        """Whether the two are equal; None if it cannot be computed."""
        return None if self.computed is None else self.stored == self.computed

    def document(self) -> dict[str, Any]:
        """The sum for JSON."""
        computed = None if self.computed is None else f"{self.computed:04X}"
        return {"stored": f"{self.stored:04X}", "computed": computed, "valid": self.valid}


@dataclass(frozen=True, slots=True)
class Header:
    """The contents of an image's first pages.

    Attributes:
        family: ``facon`` or ``fbs``; None for another signature.
        signature: the first characters (``FB30``, ``FBS40003``); without a family the first four, None if
            they are not printable ASCII.
        byte_order: ``as paper`` if the signature is in the order of the bytes, ``swapped`` if the two bytes
            of each word are swapped; None without a family.
        ladder_words: the ladder size in it, in words; None in the fbs family, which has none.
        faults: what is wrong; empty for a valid header.
        filled: True if the rest of page 0 is FF, as usual in the family.
        announced_pages: the number of pages with all that it announces; None without a family.
        code_words: code in use, in words (fbs).
        capacity_words: space for code, in words (fbs).
        checksum: of the code (fbs).
        sums: of ``settings``, ``labels`` and ``ror`` (fbs).
    """

    family: str | None
    signature: str | None
    byte_order: str | None
    ladder_words: int | None
    faults: tuple[str, ...]
    filled: bool
    announced_pages: int | None = None
    code_words: int | None = None
    capacity_words: int | None = None
    checksum: Sum | None = None
    sums: dict[str, Sum] | None = None

    @property
    def valid(self) -> bool:
        """True for a valid header; its checksums may be wrong."""
        return not self.faults

    @property
    def code_page(self) -> int:
        """The page with the beginning of the code."""
        return 4 if self.family == FBS else 1

    @property
    def odd(self) -> tuple[str, ...]:
        """What is unusual in a valid header: a reason for a warning, but not to refuse the image."""
        found = []
        if not self.filled and self.family is not None:
            first, source = (6, "in the FACON paper") if self.family == FACON else (8, "in other images")
            found.append(f"bytes {first} to 127 of page 0: expected FF throughout, as {source}")
        if self.checksum is not None:
            found += _wrong("code", self.checksum)
        for name, each in (self.sums or {}).items():
            found += _wrong(name.upper() if name == "ror" else name, each)
        return tuple(found)

    def document(self) -> dict[str, Any]:
        """The header for JSON."""
        return {
            "valid": self.valid,
            "family": self.family,
            "signature": self.signature,
            "byte_order": self.byte_order,
            "ladder_words": self.ladder_words,
            "code_words": self.code_words,
            "capacity_words": self.capacity_words,
            "checksum": None if self.checksum is None else self.checksum.document(),
            "sums": None if self.sums is None else {key: each.document() for key, each in self.sums.items()},
        }

    def text(self) -> str:
        """The header on one line: ``FB30``, ``FBS40003 (code 3000 of 20224 words)``."""
        said = []
        if self.code_words is not None:
            said.append(f"code {self.code_words} of {self.capacity_words} words")
        if self.byte_order == SWAPPED:
            said.append("bytes swapped")
        name = self.signature or "unknown"
        return f"{name} ({', '.join(said)})" if said else name


def _wrong(name: str, found: Sum) -> list[str]:
    if found.valid is not False:
        return []
    return [f"checksum of the {name}: expected {found.stored:04X} as stored, got {found.computed:04X}"]


def swapped(page: bytes) -> bytes:
    """A page with the two bytes of each word swapped."""
    turned = bytearray(page)
    turned[::2], turned[1::2] = page[1::2], page[::2]
    return bytes(turned)


def printable(start: bytes) -> str | None:
    """Bytes as text; None if they are not printable ASCII without spaces around."""
    return start.decode("ascii") if all(0x20 < byte < 0x7F for byte in start) else None
