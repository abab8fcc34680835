"""Two programs' differences in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.program.headers.header import PAGE_WORDS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.program.compare import Comparison

_WORDS_SHOWN: Final = 8


def difference_lines(found: Comparison, same: str, a: str, b: str) -> Iterator[str]:
    """What differs, a line a page; one line if nothing does.

    Args:
        found: the comparison.
        same: the line for two programs that are the same.
        a: what the first is called.
        b: what the second is called.
    """
    if found.same:
        yield same
        return
    if found.a_ladder_words != found.b_ladder_words:
        yield f"differs: ladder size {found.a_ladder_words} words in {a}, {found.b_ladder_words} in {b}"
    if found.pages:
        yield f"differs: {_extent(found)} ({a} -> {b})"
    for page in found.pages:
        if not page.words:
            yield f"  page {page.page}: only in one of them"
            continue
        shown = ", ".join(f"{word.word}: {word.a:04X} -> {word.b:04X}" for word in page.words[:_WORDS_SHOWN])
        more = len(page.words) - _WORDS_SHOWN
        rest = f", {more} more" if more > 0 else ""
        yield f"  page {page.page}, {len(page.words)} of {PAGE_WORDS} words: {shown}{rest}"


def size_of(found: Comparison) -> str:
    """How much differs, in words: ``3 words in 1 page``."""
    if found.a_ladder_words != found.b_ladder_words:
        return f"ladder size {found.a_ladder_words} words, and {found.b_ladder_words}"
    return _extent(found)


def _extent(found: Comparison) -> str:
    return f"{_count(found.word_count, 'word')} in {_count(len(found.pages), 'page')}"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
