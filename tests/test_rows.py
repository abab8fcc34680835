"""A test of rows fails if one of them does, and names it; where few are enough, three of them are run."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from tests.night import left_out
from tests.root import ROOT
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


def test_where_few_are_enough_three_rows_of_a_test_are_run() -> None:
    def items(folder: str, name: str, count: int) -> list[Any]:
        path = ROOT / "tests" / folder / "test_it.py"
        return [SimpleNamespace(path=path, nodeid=f"{folder}::{name}[{row}]") for row in range(count)]

    given = [*items("planner", "large", 7), *items("planner", "small", 3), *items("transport", "large", 7)]
    assert [item.nodeid for item in left_out(given)] == [f"planner::large[{row}]" for row in (1, 2, 4, 5)]
