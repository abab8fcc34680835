"""The figures: percentiles in buckets, exact bounds of an error rate, steps of a USB adapter, patterns."""

from __future__ import annotations

from itertools import islice
from math import comb, inf

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.jobs.linetest.binomial import at_least, at_most, upper_bound
from fatektool.jobs.linetest.latency import Times
from fatektool.jobs.linetest.loopback.data import Pattern, payloads
from fatektool.jobs.linetest.steps import STEP_S, Steps
from fatektool.protocol.fatek.facon.codec import FACON


@pytest.mark.parametrize(
    ("errors", "trials", "bound"),
    [
        (0, 1000, 0.002991),  # 1 - 0.05 ** (1 / 1000)
        (0, 1, 0.95),
        (0, 59, 0.049508),
        (1, 20, 0.216107),  # tables of Clopper and Pearson, 95 % one-sided
        (3, 50, 0.147837),
        (10, 10, 1.0),
        (0, 0, 1.0),
    ],
)
def test_the_bound_is_exact(errors: int, trials: int, bound: float) -> None:
    assert upper_bound(errors, trials) == pytest.approx(bound, abs=1e-6)


@given(st.integers(1, 60), st.data())
def test_the_tails_are_those_of_the_sum(trials: int, data: st.DataObject) -> None:
    errors = data.draw(st.integers(0, trials))
    rate = data.draw(st.floats(0.001, 0.999))
    terms = [
        comb(trials, count) * rate**count * (1 - rate) ** (trials - count) for count in range(trials + 1)
    ]
    assert at_most(errors, trials, rate) == pytest.approx(sum(terms[: errors + 1]), abs=1e-9)
    assert at_least(errors, trials, rate) == pytest.approx(sum(terms[errors:]), abs=1e-9)


def test_the_bound_holds_for_many_trials() -> None:
    assert upper_bound(0, 10_000_000) == pytest.approx(2.9957e-7, rel=1e-4)
    assert 0.05 < upper_bound(50_000, 1_000_000) < 0.0504


def test_no_times_give_no_figures() -> None:
    times = Times()
    assert set(times.summary_ms().values()) == {None}
    assert times.bars() == []
    with pytest.raises(ValueError, match="no times"):
        times.percentile(0.5)


@given(st.lists(st.floats(1e-6, 100), min_size=1, max_size=200))
def test_percentiles_are_within_half_a_per_cent(values: list[float]) -> None:
    times = Times()
    for value in values:
        times.add(value)
    ordered = sorted(values)
    for share in (0.5, 0.9, 0.99, 0.999, 1.0):
        exact = ordered[max(1, -int(-share * len(values) // 1)) - 1]
        assert times.percentile(share) == pytest.approx(exact, rel=0.006)
    summary = [float(value or 0) for value in times.summary_ms().values()]
    assert summary[0] == pytest.approx(ordered[0] * 1000, abs=0.001)
    assert summary[:6] == sorted(summary[:6])
    assert sum(bar.count for bar in times.bars()) == len(values)
    assert len(times.bars()) <= 20


def test_a_time_below_zero_counts_as_zero() -> None:
    times = Times()
    times.add(-0.001)
    assert times.summary_ms()["max"] == 0.0


def test_steps_are_seen_whatever_the_wire_times() -> None:
    steps = Steps()
    for count in range(60):
        wire_s = 0.003 + count * 0.0041
        steps.add(-(-wire_s // STEP_S) * STEP_S + 0.0004, wire_s)
    assert steps.seen


@pytest.mark.parametrize("latency_s", [0.02, 0.0003, 0.016])
def test_one_and_the_same_latency_is_no_step(latency_s: float) -> None:
    steps = Steps()
    for count in range(60):
        steps.add(latency_s, count * 0.0041)
    assert not steps.seen


def test_wire_times_and_a_scan_are_no_steps() -> None:
    steps = Steps()
    for count in range(60):
        steps.add(count * 0.0041 + 0.02, count * 0.0041)
    assert not steps.seen
    assert Steps().least_s == inf


CHARACTERS = FACON.loopback_alphabet


@pytest.mark.parametrize("pattern", list(Pattern))
def test_a_pattern_has_the_sizes_in_turn_and_no_character_that_frames(pattern: Pattern) -> None:
    sent = list(islice(payloads((0, 1, 16, 256), (pattern,), CHARACTERS, 1), 40))
    assert [len(data) for data in sent[:5]] == [0, 1, 16, 256, 0]
    assert set(b"".join(sent)) <= set(CHARACTERS)
    assert not {2, 3} & set(b"".join(sent))
    assert max(b"".join(sent)) < 0x80


def test_the_patterns_are_what_they_are_called() -> None:
    def first(pattern: Pattern, characters: bytes = CHARACTERS) -> list[bytes]:
        return list(islice(payloads((4,), (pattern,), characters, 0), 3))

    assert first(Pattern.RAMP) == [b"\x00\x01\x04\x05", b"\x01\x04\x05\x06", b"\x04\x05\x06\x07"]
    assert first(Pattern.ONES) == [b"\x7f" * 4] * 3
    assert first(Pattern.ALTERNATE) == [b"\x2a\x55" * 2, b"\x55\x2a" * 2, b"\x2a\x55" * 2]
    assert first(Pattern.ONES, bytes(range(256))) == [b"\xff" * 4] * 3
    assert first(Pattern.ALTERNATE, bytes(range(256)))[0] == b"\xaa\x55" * 2
    assert first(Pattern.RANDOM) == first(Pattern.RANDOM)


def test_all_sizes_come_with_each_pattern() -> None:
    patterns = (Pattern.ONES, Pattern.ALTERNATE)
    sent = list(islice(payloads((1, 2), patterns, CHARACTERS, 0), 5))
    assert sent == [b"\x7f", b"\x7f\x7f", b"\x2a", b"\x55\x2a", b"\x7f"]
