"""A series, round by round: its figures are of all rounds, its memory has a bound."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.report.rounds import Rounds, is_number, seconds

NUMBERS = st.one_of(st.none(), st.integers(-9, 9), st.floats(-1.7e308, 1.7e308))
VALUES = st.one_of(st.none(), st.booleans(), st.sampled_from(["BEEF", "0001"]))


def stamp(second: int) -> str:
    return f"2026-11-22T{second // 3600:02}:{second // 60 % 60:02}:{second % 60:02}Z"


def document(second: int, errors: dict[str, str] | None = None, **values: Any) -> dict[str, Any]:
    return {"time": stamp(second), "running": True, "values": values, "errors": errors or {}}


@given(st.lists(NUMBERS, min_size=1, max_size=60), st.integers(2, 9))
def test_figures_of_numbers(values: list[float | None], most_points: int) -> None:
    rounds = Rounds(most_points=most_points)
    for second, value in enumerate(values):
        rounds.add(document(second, a=value))
    track = rounds.tracks["a"]
    read = [value for value in values if value is not None]
    assert (track.read, track.failed) == (len(read), len(values) - len(read))
    assert track.least == min(read, default=None)
    assert track.most == max(read, default=None)
    assert track.last == (read[-1] if read else None)
    assert track.changes == sum(one != other for one, other in pairwise(read))
    if read:
        assert track.mean is not None
        exact = math.fsum(value / len(read) for value in read)
        assert math.isclose(track.mean, exact, rel_tol=1e-9, abs_tol=1e-12 * max(map(abs, read)))


@given(st.lists(VALUES, max_size=40))
def test_discretes_and_texts_have_no_mean(values: list[Any]) -> None:
    rounds = Rounds()
    for second, value in enumerate(values):
        rounds.add(document(second, a=value))
    if values:
        track = rounds.tracks["a"]
        assert (track.least, track.mean, track.most) == (None, None, None)
        read = [value for value in values if value is not None]
        assert track.changes == sum(one != other for one, other in pairwise(read))


@given(st.integers(1, 3000), st.integers(2, 50))
def test_points_are_thinned_evenly_and_end_at_the_end(count: int, most_points: int) -> None:
    rounds = Rounds(most_points=most_points)
    for second in range(count):
        rounds.add(document(second, a=second))
    kept = [each.values["a"] for each in rounds.kept()]
    *even, last = kept
    assert last == count - 1
    assert even == list(range(0, count - 1, rounds.stride))
    assert len(kept) <= most_points + 1
    assert rounds.stride == 1 or len(kept) >= most_points // 2
    assert rounds.count == rounds.tracks["a"].read == count


def test_many_values_mean_fewer_points() -> None:
    rounds = Rounds(most_cells=1000)
    values = {f"R{number}": number for number in range(100)}
    for second in range(500):
        rounds.add(document(second) | {"values": values})
    assert sum(len(each.values) for each in rounds.kept()) <= 1100
    assert rounds.tracks["R99"].read == 500


def test_gaps_are_named_from_to_and_why() -> None:
    rounds = Rounds()
    for second in range(20):
        if second in {3, 4}:
            rounds.fail(stamp(second), "no answer")
        elif second in {7, 8, 9}:
            rounds.add(document(second, {"a": "refused" if second < 9 else "no number"}, a=None, b=1))
        else:
            rounds.add(document(second, a=1, b=1))
    found = [(gap.key, gap.first[-3:-1], gap.last[-3:-1], gap.rounds, gap.reason) for gap in rounds.gaps]
    assert found == [
        (None, "03", "04", 2, "no answer"),
        ("a", "07", "08", 2, "refused"),
        ("a", "09", "09", 1, "no number"),
    ]
    assert (rounds.count, rounds.lost, rounds.gaps_in_all) == (18, 2, 3)
    assert (rounds.first_time, rounds.last_time) == (stamp(0), stamp(19))
    lost = [each for each in rounds.kept() if not each.values]
    assert [each.time_s - seconds(stamp(0)) for each in lost] == [3, 4]


def test_a_gap_goes_on_over_lost_rounds_of_others() -> None:
    """A key that is refused in every round is one gap, not a gap a round."""
    rounds = Rounds()
    for second in range(1000):
        rounds.add(document(second, {"a": "refused"}, a=None))
    (gap,) = rounds.gaps
    assert (gap.rounds, gap.last) == (1000, stamp(999))


def test_rounds_of_one_second_lie_in_it_evenly() -> None:
    rounds = Rounds()
    for second in (0, 0, 0, 0, 1, 1, 5):
        rounds.add(document(second, a=1))
    begin = seconds(stamp(0))
    assert [each.time_s - begin for each in rounds.kept()] == [0, 0.25, 0.5, 0.75, 1, 1.5, 5]


def test_a_clock_that_was_put_back() -> None:
    rounds = Rounds()
    for second in (10, 11, 3, 4):
        rounds.add(document(second, a=second))
    assert [each.values["a"] for each in rounds.kept()] == [3, 4, 10, 11]


def test_keys_that_come_and_go() -> None:
    rounds = Rounds()
    rounds.add(document(0, a=1))
    rounds.add(document(1, b=2))
    assert {key: track.read for key, track in rounds.tracks.items()} == {"a": 1, "b": 1}
    assert [dict(each.values) for each in rounds.kept()] == [{"a": 1}, {"b": 2}]


def test_times_and_numbers() -> None:
    assert seconds("1970-01-01T00:01:00Z") == 60
    assert seconds("1970-01-01T00:01:00.25Z") == 60.25
    with pytest.raises(ValueError, match="day is out of range"):
        seconds("2026-04-31T00:00:00Z")
    assert [is_number(value) for value in (1, 1.5, True, "1", None)] == [True, True, False, False, False]
