"""The header of the paper: FB, FBE and FBN, in both byte orders."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.program.headers.families import read_header, short_document
from fatektool.program.headers.header import Header
from tests.program.samples import header


def turned(page: bytes) -> bytes:
    """The two bytes of each word exchanged."""
    return bytes(page[place ^ 1] for place in range(len(page)))


@pytest.mark.parametrize("start", [b"FB30", b"FM99", b"FB00"])
def test_a_header_that_holds(start: bytes) -> None:
    page = header(8192, start)
    expected = Header("facon", start.decode(), "as paper", 8192, (), filled=True, announced_pages=129)
    assert read_header([page], 8192) == expected
    assert read_header([page], 8192).odd == ()


def test_the_same_with_the_bytes_of_each_word_exchanged() -> None:
    page = bytes.fromhex("42 46 30 33 00 20") + b"\xff" * 122
    expected = Header("facon", "FB30", "swapped", 8192, (), filled=True, announced_pages=129)
    assert read_header([page], 8192) == expected


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
    found = read_header([header(400, start)], 400)
    assert (found.faults, found.family, found.byte_order) == (faults, None, None)


def test_a_header_of_another_ladder_size() -> None:
    assert read_header([header(8192)], 13184).faults == (
        "bytes 4 and 5: expected the ladder size 13184 (3380), got 8192 (2000)",
    )


@pytest.mark.parametrize("place", [6, 7, 64, 127])
def test_a_rest_of_the_page_that_is_not_ff_is_odd_and_holds(place: int) -> None:
    page = bytearray(header(400))
    page[place] = 0
    found = read_header([bytes(page)], 400)
    assert not found.filled
    assert found.valid
    assert found.odd == ("bytes 6 to 127 of page 0: expected FF throughout, as in the FACON paper",)


def test_the_document_says_null_of_what_this_family_has_not() -> None:
    assert read_header([header(400)], 400).document() == {
        "valid": True,
        "family": "facon",
        "signature": "FB30",
        "byte_order": "as paper",
        "ladder_words": 400,
        "code_words": None,
        "capacity_words": None,
        "checksum": None,
        "sums": None,
    }


@given(st.lists(st.binary(min_size=128, max_size=128), min_size=1, max_size=6), st.integers(1, 0xFFFF))
def test_any_pages_can_be_looked_at_as_a_header(pages: list[bytes], words: int) -> None:
    found = read_header(pages, words)
    assert (found.family is None) == (found.byte_order is None)
    if found.family is None:
        assert not found.valid
    found.document()


@given(st.binary(min_size=128, max_size=128), st.integers(1, 0xFFFF))
def test_a_header_turned_around_says_the_same_but_its_byte_order(page: bytes, words: int) -> None:
    for start in (b"", b"FB30", b"FM12" + words.to_bytes(2, "big")):
        whole = start + page[len(start) :]
        found, other = read_header([whole], words), read_header([turned(whole)], words)
        assert found.family == other.family
        if found.family is not None:
            assert found.byte_order != other.byte_order
            assert (found.signature, found.ladder_words) == (other.signature, other.ladder_words)
            assert (found.faults, found.filled) == (other.faults, other.filled)


def test_the_header_as_files_had_it_before_there_were_families() -> None:
    fbs = b"FBS40003" + b"\xff" * 120
    assert short_document(fbs, 32768) == {"valid": False, "signature": "FBS4", "ladder_words": 0x3030}
    assert short_document(header(400), 400) == {"valid": True, "signature": "FB30", "ladder_words": 400}
