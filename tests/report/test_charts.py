"""Scales and charts: round ticks wherever the values lie, and shapes where they belong."""

from __future__ import annotations

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.report.scale import Scale, ends, labels, stamp, ticks, time_ticks
from fatektool.report.svg import WIDTH, Columns, columns, line, timing
from tests.report.tree import Node, parse

FINITE = st.floats(allow_nan=False, allow_infinity=False, min_value=-1.7e308, max_value=1.7e308)


def image(svg: str) -> Node:
    return parse(f"<!doctype html>\n<html>{svg}</html>").first("svg")


def paths(node: Node, kind: str) -> list[str]:
    return [str(each.attributes["d"]) for each in node.every("path") if each.attributes["class"] == kind]


def words(node: Node) -> list[str]:
    return [each.text for each in node.every("text")]


@given(st.lists(FINITE, min_size=1, max_size=9))
def test_ticks_lie_between_the_ends_and_can_be_told_apart(values: list[float]) -> None:
    low, high = ends(values)
    assert low < high
    assert low <= min(values)
    assert max(values) <= high
    found = ticks(low, high)
    assert 1 <= len(found) <= 12
    assert found == sorted(set(found))
    assert low <= found[0]
    assert found[-1] <= high
    shown = labels(found)
    assert len(set(shown)) == len(found)
    assert all(math.isclose(float(text), tick, rel_tol=1e-6) for text, tick in zip(shown, found, strict=True))
    scale = Scale(low, high, 150, 20)
    assert all(19.99 <= scale.at(value) <= 150.01 for value in values)


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (0, 10, ["0", "2", "4", "6", "8", "10"]),
        (43.4, 60.3, ["45", "50", "55", "60"]),
        (70_000, 70_039, ["70000", "70010", "70020", "70030"]),
        (-1, 1, ["-1", "-0.5", "0", "0.5", "1"]),
        (0.001, 0.002, ["0.001", "0.0012", "0.0014", "0.0016", "0.0018", "0.002"]),
        (0, 4e9, ["0", "1e+09", "2e+09", "3e+09", "4e+09"]),
        (5, 5, ["5", "5"]),
    ],
)
def test_round_numbers(low: float, high: float, expected: list[str]) -> None:
    assert labels(ticks(low, high)) == expected


def test_a_value_that_never_changes_lies_in_the_middle() -> None:
    assert ends([5.0]) == (4.0, 6.0)
    assert ends([1000.0, 1000.0]) == (900.0, 1100.0)
    assert ends([0.0], zero=True) == (0.0, 1.0)
    assert ends([3.0, 7.0], zero=True) == (0.0, 7.0)


@pytest.mark.parametrize(
    ("span_s", "expected"),
    [
        (4, ["03:15:00", "03:15:01", "03:15:02", "03:15:03", "03:15:04"]),
        (3600, ["03:15", "03:30", "03:45", "04:00", "04:15"]),
        (86_400, ["06:00", "12:00", "18:00", "23 Nov"]),
        (30 * 86_400, ["26 Nov", "03 Dec", "10 Dec", "17 Dec"]),
        (365 * 86_400, ["2026-12-03", "2027-03-03", "2027-06-01", "2027-08-30"]),
    ],
)
def test_round_times(span_s: int, expected: list[str]) -> None:
    begin = 1_795_317_300.0
    assert stamp(begin) == "2026-11-22 03:15:00"
    assert [text for _, text in time_ticks(begin, begin + span_s)] == expected


@given(st.integers(0, 4 * 10**9), st.integers(0, 10**9))
def test_times_lie_between_the_ends(begin: int, span: int) -> None:
    found = [seconds for seconds, _ in time_ticks(begin, begin + span)]
    assert len(found) <= 6
    assert all(begin <= seconds <= begin + span for seconds in found)


def test_a_line_with_gaps() -> None:
    """Two points, a gap, one point alone."""
    drawn = image(line("x", "oil", "said", [(0, 10.0), (1, 20.0), (2, None), (3, 15.0), (4, None)]))
    assert paths(drawn, "series") == ["M62 172L173.5 22M396.5 97h0"]
    assert paths(drawn, "dots") == ["M62 172h0M173.5 22h0M396.5 97h0"]
    assert paths(drawn, "gap") == ["M282 165l6 6m0 -6l-6 6M505 165l6 6m0 -6l-6 6"]
    assert words(drawn)[:6] == ["10", "12", "14", "16", "18", "20"]
    assert words(drawn)[-1] == "1970-01-01 00:00:00 to 1970-01-01 00:00:04 UTC"


def test_a_line_of_one_point_and_of_none() -> None:
    assert paths(image(line("x", "t", "s", [(5, 7.0)])), "dots") == ["M62 97h0"]
    assert paths(image(line("x", "t", "s", [(5, None)])), "series") == [""]


def test_a_timing_diagram() -> None:
    points = [(0, 0.0), (1, 1.0), (2, 1.0), (3, 0.0), (4, None), (5, 1.0), (6, 1.0)]
    drawn = image(timing("x", "valves", "said", [("Y0", points), ("a very long name of a valve", points)]))
    first, second = paths(drawn, "series")
    assert first == "M120 28h0H184.7V12H314V28H314M443.3 12h0H508"
    assert second == first.replace("28", "54").replace("V12", "V38").replace(" 12", " 38")
    assert paths(drawn, "under")[0] == "M184.7 28V12H314V28zM443.3 28V12H508V28z"
    assert words(drawn).count("a very long name…") == 1
    assert len(paths(drawn, "gap")) == 2


def test_columns() -> None:
    data = Columns(["1", "2", "4"], [0, 1, 1000], "ms", [(2.5, "p99 5 ms")])
    drawn = image(columns("x", "t", "s", data))
    heights = [float(str(each.attributes["height"])) for each in drawn.every("rect")]
    assert heights == [0, 2, 130]  # the little one can be seen
    assert [each.first("title").text for each in drawn.every("rect")] == ["1: 0", "2: 1", "4: 1000"]
    assert paths(drawn, "limit") == ["M433.7 4V172"]
    assert {"p99 5 ms", "1000", "ms"} <= set(words(drawn))


@given(st.lists(st.tuples(st.integers(0, 10**9), st.one_of(st.none(), FINITE)), min_size=1, max_size=30))
def test_nothing_is_drawn_outside(points: list[tuple[float, float | None]]) -> None:
    points.sort(key=lambda point: point[0])
    drawn = image(line("x", "t", "s", points))
    height = float(str(drawn.attributes["viewbox"]).split()[-1])
    for path in paths(drawn, "series"):
        for x, y in re.findall(r"[ML]([-\d.]+) ([-\d.]+)", path):
            assert 0 <= float(x) <= WIDTH
            assert 0 <= float(y) <= height
