"""The differences between two programs, by page and word."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from itertools import zip_longest
from operator import ne
from typing import TYPE_CHECKING

from fatektool.program.headers.header import PAGE_WORDS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.program.image import Program


@dataclass(frozen=True, slots=True)
class WordDifference:
    """One word that differs.

    Attributes:
        word: its place in the page, 0 to 63.
        a: the word in the first program, 0 to 65535.
        b: the same in the second.
    """

    word: int
    a: int
    b: int


@dataclass(frozen=True, slots=True)
class PageDifference:
    """One page that differs.

    Attributes:
        page: its number.
        a: the page in the first program, 128 bytes; None if it has no such page.
        b: the same in the second.
    """

    page: int
    a: bytes | None
    b: bytes | None

    @property
    def words(self) -> tuple[WordDifference, ...]:
        """The words that differ; empty for a page that only one of the two programs has."""
        return () if self.a is None or self.b is None else compare_pages(self.a, self.b)

    @property
    def word_count(self) -> int:
        """Their number. It is faster than ``words``, because a restore needs it while the line waits."""
        return 0 if self.a is None or self.b is None else sum(map(ne, _words(self.a), _words(self.b)))


@dataclass(frozen=True, slots=True)
class Comparison:
    """The comparison of two programs.

    Attributes:
        a_ladder_words: ladder size of the first.
        b_ladder_words: ladder size of the second.
        pages: the pages that differ, in order.
        b_has_more: True if the second has more pages than the first; they are not compared.
    """

    a_ladder_words: int
    b_ladder_words: int
    pages: tuple[PageDifference, ...]
    b_has_more: bool = False

    @property
    def same(self) -> bool:
        """True if all compared bytes are identical."""
        return not self.pages and self.a_ladder_words == self.b_ladder_words

    @property
    def page_numbers(self) -> list[int]:
        """The numbers of the pages that differ."""
        return [page.page for page in self.pages]

    @property
    def word_count(self) -> int:
        """The number of words that differ, in the pages that both have."""
        return sum(page.word_count for page in self.pages)


def compare(a: Program, b: Program) -> Comparison:
    """Compare two programs, page by page."""
    return compare_images(a, b.ladder_words, b.pages)


def compare_images(
    a: Program, b_ladder_words: int, b_pages: Sequence[bytes], *, b_has_more: bool = False
) -> Comparison:
    """Compare a program with pages of another, not necessarily all.

    Args:
        a: the first.
        b_ladder_words: ladder size of the second.
        b_pages: its pages, 128 bytes each.
        b_has_more: see ``Comparison``.
    """
    pages = tuple(
        PageDifference(number, ours, theirs)
        for number, (ours, theirs) in enumerate(zip_longest(a.pages, b_pages))
        if ours != theirs
    )
    return Comparison(a.ladder_words, b_ladder_words, pages, b_has_more)


def compare_pages(a: bytes, b: bytes) -> tuple[WordDifference, ...]:
    """The words in which two pages of 128 bytes differ."""
    pairs = zip(_words(a), _words(b), strict=True)
    return tuple(WordDifference(word, x, y) for word, (x, y) in enumerate(pairs) if x != y)


def _words(page: bytes) -> tuple[int, ...]:
    return struct.unpack(f">{PAGE_WORDS}H", page)
