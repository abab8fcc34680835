from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.program.compare import PageDifference, WordDifference, compare, compare_pages
from fatektool.program.image import Program
from tests.program.samples import changed, header, program


def test_a_program_is_the_same_as_itself() -> None:
    found = compare(program(400), program(400))
    assert found.same
    assert found.page_numbers == []
    assert found.word_count == 0


def test_a_word_that_differs_is_named_with_both_values() -> None:
    a = program(400)
    b = changed(a, 3)
    found = compare(a, b)
    before, after = a.pages[3][64:66], b.pages[3][64:66]
    assert found.pages == (PageDifference(3, a.pages[3], b.pages[3]),)
    assert found.pages[0].words == (
        WordDifference(32, int.from_bytes(before, "big"), int.from_bytes(after, "big")),
    )
    assert found.pages[0].word_count == 1
    assert not found.same


@given(st.dictionaries(st.tuples(st.integers(0, 7), st.integers(0, 63)), st.integers(1, 0xFFFF)))
def test_exactly_the_words_that_differ_are_found(changes: dict[tuple[int, int], int]) -> None:
    a = program(400)
    pages = [bytearray(page) for page in a.pages]
    for (page, word), flips in changes.items():
        for place, flip in enumerate(flips.to_bytes(2, "big")):
            pages[page][2 * word + place] ^= flip
    b = Program(400, tuple(map(bytes, pages)))
    found = compare(a, b)
    assert {(page.page, word.word) for page in found.pages for word in page.words} == set(changes)
    assert found.word_count == len(changes)
    assert found.page_numbers == sorted({page for page, _ in changes})
    assert all(
        word.a ^ word.b == changes[page.page, word.word] for page in found.pages for word in page.words
    )


def test_pages_that_only_one_has_differ_without_words() -> None:
    a, b = program(400), program(500)
    found = compare(a, b)
    assert (found.a_ladder_words, found.b_ladder_words) == (400, 500)
    assert found.pages[-1] == PageDifference(8, None, b.pages[8])
    assert found.pages[-1].words == ()
    assert found.pages[-1].word_count == 0
    assert found.page_numbers == [0, 8]
    assert compare(b, a).page_numbers == [0, 8]


def test_another_ladder_size_is_a_difference_by_itself() -> None:
    page0 = header(400)
    a = program(399, page0=page0)
    b = program(400, page0=page0)
    found = compare(a, b)
    assert found.pages == ()
    assert not found.same


def test_pages_are_compared_whole() -> None:
    with pytest.raises(Exception, match="128"):
        compare_pages(b"\0" * 127, b"\0" * 128)
