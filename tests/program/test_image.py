from __future__ import annotations

import hashlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import DataError
from fatektool.program.image import Header, Program, page_count, ranges

from .samples import header, program


@pytest.mark.parametrize(
    ("words", "pages"), [(1, 2), (64, 2), (65, 3), (400, 8), (8192, 129), (13184, 207), (65535, 1025)]
)
def test_an_image_has_a_header_and_a_page_for_each_64_words(words: int, pages: int) -> None:
    assert page_count(words) == pages
    assert len(program(words).pages) == pages


@pytest.mark.parametrize("start", [b"FB30", b"FM99", b"FB00"])
def test_a_header_that_holds(start: bytes) -> None:
    found = Header.parse(header(8192, start))
    assert found == Header(start.decode(), 8192, (), filled=True)
    assert found.faults_for(8192) == ()


@pytest.mark.parametrize(
    ("start", "faults"),
    [
        (b"GB30", ("byte 0: expected F (46), got G (47)",)),
        (b"\x00B30", ("byte 0: expected F (46), got 00",)),
        (b"FA30", ("byte 1: expected B (42) or M (4D), got A (41)",)),
        (b"FBA0", ("byte 2: expected a digit, got A (41)",)),
        (b"FB3/", ("byte 3: expected a digit, got / (2F)",)),
        (b"FB3:", ("byte 3: expected a digit, got : (3A)",)),
        (
            b"\xff\xff\xff\xff",
            (
                "byte 0: expected F (46), got FF",
                "byte 1: expected B (42) or M (4D), got FF",
                "byte 2: expected a digit, got FF",
                "byte 3: expected a digit, got FF",
            ),
        ),
    ],
)
def test_each_fault_of_a_header_is_named(start: bytes, faults: tuple[str, ...]) -> None:
    assert Header.parse(header(400, start)).faults == faults


def test_a_header_of_another_ladder_size() -> None:
    assert Header.parse(header(8192)).faults_for(13184) == (
        "bytes 4 and 5: expected the ladder size 13184 (3380), got 8192 (2000)",
    )


def test_the_rest_of_the_header_need_not_be_filled() -> None:
    odd = header(400)[:-1] + b"\x00"
    assert not Header.parse(odd).filled
    assert Header.parse(odd).faults_for(400) == ()


@given(st.binary(min_size=128, max_size=128))
def test_any_page_can_be_looked_at_as_a_header(page: bytes) -> None:
    found = Header.parse(page)
    assert (found.signature is None) == any(not 0x20 < byte < 0x7F for byte in page[:4])
    assert 0 <= found.ladder_words <= 0xFFFF


@pytest.mark.parametrize("words", [0, -1, 65536])
def test_there_is_no_such_ladder(words: int) -> None:
    with pytest.raises(DataError, match=f"expected 1 to 65535 words, got {words}"):
        Program(words, ())


def test_the_pages_must_be_as_many_as_the_ladder_asks_for() -> None:
    with pytest.raises(DataError, match="400 words has 8 pages, got 7"):
        Program(400, program(400).pages[:7])


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
