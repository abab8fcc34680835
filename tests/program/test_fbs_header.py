"""The header of FBs images: what agrees, what does not, its sums, in both byte orders."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.errors import DataError
from fatektool.program.headers.families import read_header
from fatektool.program.image import Program
from tests.night import examples
from tests.program.fbs import CAPACITY, CODE, PRINTED, fbs_program, pages_of, words_of

WORD = st.integers(0, 0xFFFF)
FEW = st.lists(WORD, max_size=40).map(tuple)
DIGITS = st.from_regex(rb"[0-9]{4}", fullmatch=True)


@given(main=FEW, sub=FEW, labels=FEW, ror=FEW, digits=DIGITS, swapped=st.booleans())
@settings(max_examples=examples(60))
def test_an_image_whose_header_agrees(
    main: tuple[int, ...],
    sub: tuple[int, ...],
    labels: tuple[int, ...],
    ror: tuple[int, ...],
    digits: bytes,
    *,
    swapped: bool,
) -> None:
    words = words_of(main, sub, labels=labels, ror=ror, digits=digits)
    found = read_header(pages_of(words, swapped=swapped), 0x8000)
    assert found.faults == found.odd == ()
    assert found.family == "fbs"
    assert found.signature == "FBS4" + digits.decode()
    assert found.byte_order == ("swapped" if swapped else "as paper")
    assert found.ladder_words is None
    assert (found.code_words, found.capacity_words) == (len(main) + len(sub), CAPACITY)
    assert found.announced_pages == 320
    assert found.checksum is not None
    assert found.checksum.valid
    assert found.sums is not None
    assert list(found.sums) == ["settings", "labels", "ror"]
    assert all(each.valid for each in found.sums.values())


@pytest.mark.parametrize(("text", "stored"), PRINTED)
def test_the_sum_of_code_is_that_of_real_images(text: str, stored: int) -> None:
    code = tuple(int(word, 16) for word in text.split())
    found = read_header(pages_of(words_of(code)), 0x8000)
    assert found.checksum is not None
    assert found.checksum.computed == stored


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize(
    ("word", "value", "fault"),
    [
        (2, 0x4130, "bytes 4 to 7: expected four digits, got 30 41 30 33"),
        (130, 0x4E00, "word 132: expected capacity less code in use, 4DDB, got 4EDB"),
        (131, 0xFFFF, "word 131: expected less code than the capacity of 20224 words, got 65535"),
        (131, 37, "word 132: expected capacity less code in use, 4EDA, got 4EDB"),
        (132, 0, "word 132: expected capacity less code in use, 4EDB, got 0000"),
        (133, 0x400, "word 133: expected the address of code, 0200, got 0400"),
        (134, 0x200, "word 134: expected an even address of 0202 to 024A after the main units, got 0200"),
        (134, 0x24C, "word 134: expected an even address of 0202 to 024A after the main units, got 024C"),
        (134, 0x203, "word 134: expected an even address of 0202 to 024A after the main units, got 0203"),
        (135, 0x24C, "word 135: expected the address after all code, 024A, got 024C"),
        (254, 0x55AA, "word 254: expected the mark AA55, got 55AA"),
    ],
)
def test_each_word_that_does_not_agree_is_named(word: int, value: int, fault: str, *, swapped: bool) -> None:
    words = words_of()
    words[word] = value
    found = read_header(pages_of(words, swapped=swapped), 0x8000)
    assert fault in found.faults
    assert not found.valid
    assert found.family == "fbs"
    with pytest.raises(DataError, match="invalid header"):
        Program(0x8000, pages_of(words, swapped=swapped)).require_header()


@pytest.mark.parametrize(
    ("word", "said"),
    [
        (104, "checksum of the settings: expected"),
        (256, "checksum of the code: expected 4A57 as stored, got"),
        (256 + len(CODE), "checksum of the code: expected 4A57 as stored, got"),
        (0x53FF, "checksum of the labels: expected 0003 as stored, got"),
        (0x5400, "checksum of the ROR: expected 000F as stored, got"),
    ],
)
def test_a_sum_that_does_not_hold_is_odd_and_no_fault(word: int, said: str) -> None:
    words = words_of(labels=(1, 2), ror=(4, 5, 6))
    words[word] ^= 0x0100
    found = read_header(pages_of(words), 0x8000)
    assert found.valid
    (odd,) = found.odd
    assert odd.startswith(said)


@pytest.mark.parametrize("word", [4, 63])
def test_a_page_0_with_something_behind_the_digits_is_odd(word: int) -> None:
    words = words_of()
    words[word] = 0
    assert read_header(pages_of(words), 0x8000).odd == (
        "bytes 8 to 127 of page 0: expected FF throughout, as in other images",
    )


def test_sums_of_what_is_not_in_the_image_are_not_computed() -> None:
    found = read_header(pages_of(words_of(labels=(1,), ror=(2,), pages=320)), 0x8000)
    assert found.sums is not None
    assert found.sums["settings"].valid
    assert found.sums["labels"].document() == {"stored": "0001", "computed": None, "valid": None}
    assert found.sums["ror"].document() == {"stored": "0002", "computed": None, "valid": None}
    assert found.odd == ()


@pytest.mark.parametrize("address", [0xA7FF, 0x0200, 0x0001])
def test_a_label_table_at_an_impossible_place_has_no_sum(address: int) -> None:
    words = words_of()
    words[138] = address
    found = read_header(pages_of(words), 0x8000)
    assert found.sums is not None
    assert found.sums["labels"].computed is None


@pytest.mark.parametrize("count", [1, 2, 3])
def test_an_image_that_ends_inside_its_header(count: int) -> None:
    found = read_header(pages_of(words_of(pages=count)), 0x8000)
    assert found.faults == (f"expected a header of 4 pages, got {count}",)


def test_code_past_the_end_of_the_image_is_a_fault() -> None:
    found = read_header(pages_of(words_of(tuple(range(1000)), pages=8)), 0x8000)
    assert found.faults == ("word 131: expected code that ends in the 512 words of the image, got 1000",)


@pytest.mark.parametrize("count", [320, 321, 511, 512, 513])
def test_all_that_the_header_announces_is_a_whole_program(count: int) -> None:
    words = words_of() + [0xFFFF] * 64
    image = Program(0x8000, pages_of(words[: 64 * count]))
    assert image.header.valid
    assert image.pages_asked_for == 513


@pytest.mark.parametrize("count", [4, 5, 319, 514])
def test_less_than_the_header_announces_is_none(count: int) -> None:
    words = words_of() + [0xFFFF] * 128
    with pytest.raises(DataError, match=f"32768 words has 513 pages, got {count}"):
        Program(0x8000, pages_of(words[: 64 * count]))


def test_one_line_says_what_it_is() -> None:
    assert fbs_program().header.text() == "FBS40003 (code 36 of 20224 words)"
    assert fbs_program(swapped=True).header.text() == "FBS40003 (code 36 of 20224 words, bytes swapped)"
