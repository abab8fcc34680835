from __future__ import annotations

import hashlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import DataError
from fatektool.program.image import Program, page_count, ranges
from tests.program.samples import header, program


@pytest.mark.parametrize(
    ("words", "pages"), [(1, 2), (64, 2), (65, 3), (400, 8), (8192, 129), (13184, 207), (65535, 1025)]
)
def test_an_image_has_a_header_and_a_page_for_each_64_words(words: int, pages: int) -> None:
    assert page_count(words) == pages
    assert len(program(words).pages) == pages


@pytest.mark.parametrize("words", [0, -1, 65536])
def test_there_is_no_such_ladder(words: int) -> None:
    with pytest.raises(DataError, match=f"expected 1 to 65535 words, got {words}"):
        Program(words, ())


@pytest.mark.parametrize("count", [0, 1, 2, 6, 9])
def test_the_pages_must_be_as_many_as_the_ladder_asks_for(count: int) -> None:
    pages = (program(400).pages * 2)[:count]
    with pytest.raises(DataError, match=f"400 words has 8 pages, got {count}"):
        Program(400, pages)


def test_the_very_last_page_may_be_missing_as_a_plc_may_refuse_it() -> None:
    short = Program(400, program(400).pages[:7])
    assert short.pages_asked_for == 8
    assert short.header.valid


def test_a_header_page_alone_is_no_program() -> None:
    with pytest.raises(DataError, match="64 words has 2 pages, got 1"):
        Program(64, program(64).pages[:1])


def test_a_page_of_another_length_is_named() -> None:
    pages = [*program(400).pages]
    pages[5] = pages[5][:-1]
    with pytest.raises(DataError, match="page 5: expected 128 bytes, got 127") as caught:
        Program(400, tuple(pages))
    assert caught.value.details["page"] == 5


def test_the_hash_is_of_all_pages_in_order() -> None:
    image = program(400)
    assert image.data == b"".join(image.pages)
    assert image.sha256 == hashlib.sha256(image.data).hexdigest()


def test_a_header_can_be_required() -> None:
    program(400).require_header()
    with pytest.raises(DataError) as caught:
        program(400, page0=header(500, b"XB30")).require_header("do this")
    assert "byte 0: expected F" in caught.value.message
    assert "ladder size 400" in caught.value.message
    assert caught.value.details["page"] == 0
    assert len(caught.value.details["faults"]) == 2
    assert str(caught.value).endswith("; do this")


@pytest.mark.parametrize(
    ("numbers", "words"),
    [([], ""), ([7], "7"), ([0, 1, 2], "0-2"), ([12, 9, 0, 1, 10, 11, 4], "0-1, 4, 9-12")],
)
def test_ranges(numbers: list[int], words: str) -> None:
    assert ranges(numbers) == words


@given(st.sets(st.integers(0, 1024)))
def test_ranges_name_every_number_once(numbers: set[int]) -> None:
    named: list[int] = []
    for part in ranges(numbers).split(", ") if numbers else []:
        first, _, last = part.partition("-")
        named += range(int(first), int(last or first) + 1)
    assert named == sorted(numbers)
