"""A test of rows fails if one of them does, and names it."""

from __future__ import annotations

import pytest

from tests.rows import each

SEEN: list[tuple[int, str]] = []


@pytest.fixture
def limit() -> int:
    return 3


@each("number", range(3))
@each(("letter", "known"), [("a", True), ("b", True)])
def test_every_row_is_tried_with_the_same_fixtures(
    number: int, letter: str, limit: int, *, known: bool
) -> None:
    assert known
    assert number < limit
    SEEN.append((number, letter))


def test_they_were() -> None:
    if SEEN:  # the one above may have run in another process
        assert sorted(set(SEEN)) == [(number, letter) for number in range(3) for letter in "ab"]


def test_those_that_fail_are_named() -> None:
    @each("number", range(10))
    def fails(number: int) -> None:
        with pytest.raises(ZeroDivisionError):
            1 / (number % 3)

    with pytest.raises(BaseExceptionGroup, match="6 of 10 rows of fails failed") as caught:
        fails()
    notes = [error.__notes__[-1] for error in caught.value.exceptions]
    assert notes == [f"in the row {number}" for number in (1, 2, 4, 5, 7)]


def test_no_rows_are_a_fault() -> None:
    with pytest.raises(AssertionError):
        each("number", [])
