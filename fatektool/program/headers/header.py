"""What a program's header says, whatever its family; JSON's ``header`` object.

::

    family   signature   byte order            says
    facon    FB30        as paper or swapped   ladder size
    fbs      FBS40003    as paper or swapped   code capacity, code in use, four sums
    -        FB?? or -   -                     nothing that holds
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
        stored: as the header has it.
        computed: of the words themselves; None if they are not in the image.
    """

    stored: int
    computed: int | None

    @property
    def valid(self) -> bool | None:
        """Whether the two are equal; None where nothing can be computed."""
        return None if self.computed is None else self.stored == self.computed

    def document(self) -> dict[str, Any]:
        """The sum as JSON has it."""
        computed = None if self.computed is None else f"{self.computed:04X}"
        return {"stored": f"{self.stored:04X}", "computed": computed, "valid": self.valid}


@dataclass(frozen=True, slots=True)
class Header:
    """What an image's first pages say of the program.

    Attributes:
        family: ``facon`` or ``fbs``; None for a signature of neither.
        signature: the characters that the family begins with (``FB30``, ``FBS40003``); of no family the first
            four, None if they are not printable ASCII.
        byte_order: ``as paper`` if the signature reads in the order of the bytes, ``swapped`` if the two
            bytes of each word are exchanged; None for no family.
        ladder_words: the ladder size that it names, in words; None in the fbs family, which names none.
        faults: what does not hold, in words; empty for a header that holds.
        filled: True if the rest of page 0 is FF, as the family has it.
        announced_pages: how many pages hold all that it announces; None for no family.
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
        """True for a header that holds; its checksums may be wrong."""
        return not self.faults

    @property
    def code_page(self) -> int:
        """The page that code begins with."""
        return 4 if self.family == FBS else 1

    @property
    def odd(self) -> tuple[str, ...]:
        """What is odd about a header that holds: a reason to look, none to refuse the image."""
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
        """The header as JSON has it."""
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
    """A page with the two bytes of each word exchanged."""
    turned = bytearray(page)
    turned[::2], turned[1::2] = page[1::2], page[::2]
    return bytes(turned)


def printable(start: bytes) -> str | None:
    """Bytes as text; None if they are not printable ASCII without spaces around."""
    return start.decode("ascii") if all(0x20 < byte < 0x7F for byte in start) else None
