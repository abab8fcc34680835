"""Phone numbers: the paper's two, every number both ways, and what is none."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import DataError, UsageError
from fatektool.plcports.phone_number import MAX_PHONE, parse_phone_number, phone_number_words

PLAIN = (0x8220, 0x1280, 0x0E29, 0, 0, 0)
"""Section 13.1, modem: 02-28082192."""
EXTENSION = (0x2A20, 0x2808, 0xA291, 0xAAAA, 0x001A, 0x000E)
"""The same with extension 100, and pauses to reach it."""

numbers = st.text("0123456789,#*", min_size=1, max_size=MAX_PHONE)


def test_the_papers_numbers() -> None:
    assert parse_phone_number(PLAIN) == "0228082192"
    assert parse_phone_number(EXTENSION) == "02,28082192,,,,,,100"
    assert phone_number_words("02-28082192") == PLAIN
    assert phone_number_words("02,2808 2192,,,,,,100") == EXTENSION


def test_hash_and_star() -> None:
    assert phone_number_words("#*9,") == (0xA9CB, 0x000E, 0, 0, 0, 0)
    assert parse_phone_number((0xA9CB, 0x000E, 0, 0, 0, 0)) == "#*9,"


@given(numbers)
def test_both_ways(number: str) -> None:
    words = phone_number_words(number)
    assert len(words) == 6
    assert parse_phone_number(words) == number


@given(numbers, st.integers(0, 0xFFFF))
def test_what_follows_the_end_means_nothing(number: str, rest: int) -> None:
    words = list(phone_number_words(number))
    if len(number) < MAX_PHONE - 4:
        words[-1] = rest
    assert parse_phone_number(words) == number


def test_a_number_of_23_takes_all_nibbles() -> None:
    assert phone_number_words("1" * 23)[-1] == 0xE111
    with pytest.raises(UsageError, match="expected 1 to 23 characters, got 24"):
        phone_number_words("1" * 24)


@pytest.mark.parametrize(
    ("number", "said"),
    [
        ("", "expected 1 to 23 characters, got 0"),
        (" - ", "got 0"),
        ("0800x", "got 'x'"),
        ("+49", "got '\\+'"),
        ("0\u0664", "expected digits"),
        ("A", "expected digits"),
    ],
)
def test_what_is_no_number(number: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        phone_number_words(number)


def test_no_number_in_the_registers() -> None:
    with pytest.raises(DataError, match="no end"):
        parse_phone_number((0,) * 6)
    for nibble in (0xD, 0xF):
        with pytest.raises(DataError, match=f"nibble 3: expected .*, got {nibble:X}"):
            parse_phone_number((0xE000 | nibble << 8, 0, 0, 0, 0, 0))
    assert parse_phone_number((0x000E, 0, 0, 0, 0, 0)) == ""


@given(st.lists(st.integers(0, 0xFFFF), max_size=8))
def test_any_words_are_a_number_or_none(words: list[int]) -> None:
    try:
        number = parse_phone_number(words)
    except DataError:
        return
    assert set(number) <= set("0123456789,#*")
