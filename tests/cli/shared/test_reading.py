"""Rounds in a thread: paused, interrupted for a job, and left while the line cannot be had."""

from __future__ import annotations

import threading
from queue import SimpleQueue
from typing import TYPE_CHECKING, cast

from fatektool.cli.shared.reading import Reading, lost_words
from fatektool.cli.shared.rounds import RoundTimes
from fatektool.errors import NoAnswer

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.client import Plc


class Line:
    """A line whose rounds are numbers; it can be held by another process."""

    def __init__(self) -> None:
        self.is_free, self.is_wanted = threading.Event(), threading.Event()
        self.is_free.set()
        self.number = 0
        self.fails = False
        self.news: SimpleQueue[object] = SimpleQueue()

    def take(self) -> None:
        if not self.is_free.is_set():
            self.is_wanted.set()
        self.is_free.wait()

    def lend(self, seconds: float, *, broken: bool, sleep: Callable[[float], object]) -> None:
        assert not broken
        sleep(seconds)

    def read(self) -> int:
        if self.fails:
            raise NoAnswer("nothing")
        self.number += 1
        return self.number

    def reading(self, interval_s: float, count: int | None = None) -> Reading[int]:
        plc = cast("Plc", self)
        return Reading(plc, self.read, RoundTimes(interval_s, count), lambda: self.news.put(None))


def test_so_many_rounds() -> None:
    line = Line()
    with line.reading(0, count=3) as reading:
        while not reading.is_over:
            line.news.get()
    assert (reading.last, line.number, reading.error) == (3, 3, None)


def test_a_job_is_done_at_once_and_a_round_read_behind_it() -> None:
    line = Line()
    done: list[int] = []
    with line.reading(3600) as reading:
        line.news.get()
        reading.do(lambda: done.append(line.number))
        while reading.last != 2:
            line.news.get()
    assert done == [1]


def test_a_pause_and_what_is_done_in_it() -> None:
    line = Line()
    done: list[int] = []
    with line.reading(0) as reading:
        line.news.get()
        reading.pause(on=True)
        reading.do(lambda: done.append(line.number))
        while not done:
            line.news.get()
        before = line.number
        reading.do(lambda: done.append(line.number))
        while len(done) < 2:
            line.news.get()
        assert done[1] == before
        reading.pause(on=False)
        while reading.last == before:
            line.news.get()


def test_a_line_that_is_lost_and_comes_again() -> None:
    line = Line()
    with line.reading(0.001) as reading:
        line.news.get()
        line.fails = True
        while reading.lost is None:
            line.news.get()
        assert lost_words(reading).endswith(": nothing; trying again")
        line.fails = False
        while reading.lost is not None:
            line.news.get()
        assert lost_words(reading) == ""


def test_the_first_round_that_fails_is_the_end() -> None:
    line = Line()
    line.fails = True
    with line.reading(0) as reading:
        while not reading.is_over:
            line.news.get()
    assert isinstance(reading.error, NoAnswer)


def test_it_is_left_while_another_process_has_the_line() -> None:
    line = Line()
    with line.reading(0.001) as reading:
        line.news.get()
        line.is_free.clear()
        line.is_wanted.wait()
    assert not reading.is_over  # the thread still waits, and nobody for it
    line.is_free.set()
    while not reading.is_over:
        line.news.get()
    assert reading.error is None
