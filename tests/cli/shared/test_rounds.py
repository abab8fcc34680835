"""Rounds on time: when each begins, and what a line that fails does to them."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, cast

import pytest

from fatektool.cli.shared.rounds import RoundTimes, paced_rounds
from fatektool.errors import LineError, NoAnswer, TransportClosed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc


class Line:
    """A line that is lent, and whose clock goes on while it is read and lent."""

    def __init__(self, takes_s: Callable[[int], float], fails: Callable[[int], LineError | None]) -> None:
        self.now = 0.0
        self.began: list[float] = []
        self.broken: list[bool] = []
        self.warned: list[str] = []
        self.failures: list[LineError] = []
        self._takes_s = takes_s
        self._fails = fails

    def take(self) -> None:
        self.began.append(self.now)

    def read(self) -> int:
        number = len(self.began) - 1
        self.now += self._takes_s(number)
        error = self._fails(number)
        if error is not None:
            raise error
        return number

    def lend(self, seconds: float, *, broken: bool, sleep: object) -> None:
        assert sleep is None
        self.broken.append(broken)
        self.now += seconds

    def warn(self, text: str) -> None:
        self.warned.append(text)

    def rounds(self, pace: RoundTimes, *, patient: bool = False) -> Iterator[int]:
        return paced_rounds(
            cast("Plc", self),
            self.read,
            pace,
            failed=self.failures.append,
            voice=None if patient else cast("Voice", self),
            clock=lambda: self.now,
        )


def line(
    takes_s: Callable[[int], float] = lambda _: 0.25,
    fails: Callable[[int], LineError | None] = lambda _: None,
) -> Line:
    return Line(takes_s, fails)


def lost(*numbers: int) -> Callable[[int], LineError | None]:
    return lambda number: NoAnswer(f"lost {number}") if number in numbers else None


def test_each_begins_on_time() -> None:
    made = line()
    assert [*made.rounds(RoundTimes(1, 4))] == [0, 1, 2, 3]
    assert made.began == [0, 1, 2, 3]
    assert made.now == 3.25  # no wait behind the last


def test_a_round_that_takes_long_delays_the_next_and_none_is_caught_up() -> None:
    made = line(lambda number: 2.5 if number == 1 else 0.25)
    assert [*made.rounds(RoundTimes(1, 4))] == [0, 1, 2, 3]
    assert made.began == [0, 1, 3.5, 4.5]


def test_a_round_that_fails_is_said_and_not_counted() -> None:
    made = line(fails=lost(1, 2))
    assert [*made.rounds(RoundTimes(1, 3))] == [0, 3, 4]
    assert made.warned == ["lost 1; trying again", "lost 2; trying again"]
    assert len(made.failures) == 2


def test_the_first_or_ten_in_a_row_end_it() -> None:
    with pytest.raises(NoAnswer, match="lost 0"):
        [*line(fails=lost(0)).rounds(RoundTimes(1))]
    made = line(fails=lost(*range(1, 10), *range(11, 30)))
    with pytest.raises(NoAnswer, match="lost 20"):
        [*made.rounds(RoundTimes(1))]
    assert len(made.failures) == 9 + 10


def test_nobody_to_warn_is_no_end() -> None:
    made = line(fails=lambda number: NoAnswer("lost") if number < 1000 else None)
    assert [*islice(made.rounds(RoundTimes(1), patient=True), 2)] == [1000, 1001]
    assert (made.warned, len(made.failures)) == ([], 1000)


def test_a_broken_line_is_opened_anew() -> None:
    errors = {1: TransportClosed("gone"), 2: NoAnswer("lost")}
    made = line(fails=errors.get)
    assert [*made.rounds(RoundTimes(1, 3))] == [0, 3, 4]
    assert made.broken == [False, True, False, False]
