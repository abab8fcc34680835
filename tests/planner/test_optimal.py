"""The planner's plan costs what the cheapest of all plans costs: not a byte more."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.planner import plan_reads, plan_writes
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.fatek.mseries.codec import MSERIES
from tests.night import examples, night, seeds
from tests.planner.exhaustive import Caps, Limited, least_read, least_write, wire_bytes
from tests.planner.sets import TURNAROUNDS, apart, element_sets, named, scattered, side_by_side, small_set

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec
    from fatektool.protocol.elements import Element

CODECS: dict[str, Codec] = {"facon": FACON, "mseries": MSERIES}
codecs = pytest.mark.parametrize("codec", CODECS.values(), ids=CODECS)
turnarounds = st.sampled_from(TURNAROUNDS)


def reads_cost(elements: list[Element], codec: Codec, turnaround: float) -> float:
    return wire_bytes(plan_reads(elements, codec, turnaround=turnaround), codec, turnaround)


def writes_cost(elements: list[Element], codec: Codec, turnaround: float) -> float:
    plan = plan_writes([(element, 0) for element in elements], codec, turnaround=turnaround)
    return wire_bytes(plan, codec, turnaround)


def compare(elements: list[Element], codec: Codec, turnaround: float) -> None:
    assert reads_cost(elements, codec, turnaround) == pytest.approx(
        least_read(elements, codec, turnaround)
    ), f"read {' '.join(map(str, elements))} at {turnaround}"
    written = apart(elements)
    assert writes_cost(written, codec, turnaround) == pytest.approx(
        least_write(written, codec, turnaround)
    ), f"write {' '.join(map(str, written))} at {turnaround}"


@codecs
@pytest.mark.parametrize("seed", seeds(2, 8))
def test_random_sets(codec: Codec, seed: int) -> None:
    random = Random(seed)  # noqa: S311  # the same sets each time
    for _ in range(25):
        compare(small_set(random), codec, random.choice(TURNAROUNDS))


@given(element_sets(most=8), st.sampled_from(sorted(CODECS)), turnarounds)
@settings(deadline=None, max_examples=examples(250))
def test_any_set(elements: list[Element], codec: str, turnaround: float) -> None:
    compare(elements, CODECS[codec], turnaround)


@pytest.mark.arithmetic
@codecs
@pytest.mark.parametrize("seed", seeds(1, 3))
@pytest.mark.parametrize("caps", [(4, 40, 4, 2), (8, 64, 6, 4)], ids=["4 words", "8 words"])
def test_where_requests_are_full(codec: Codec, seed: int, caps: tuple[int, int, int, int]) -> None:
    """With requests that hold little, a few elements meet every limit."""
    words, discretes, mixed, mixed_write = caps
    read, write = Caps(discretes, words, mixed), Caps(discretes, words, mixed_write)
    codec = Limited(codec, read, write)
    random = Random(seed)  # noqa: S311
    for _ in range(20):
        elements = random.choice((small_set, side_by_side))(random, 14)
        turnaround = random.choice(TURNAROUNDS)
        assert reads_cost(elements, codec, turnaround) == pytest.approx(
            least_read(elements, codec, turnaround, caps=read)
        ), f"read {' '.join(map(str, elements))} at {turnaround}"
        written = apart(elements)
        assert writes_cost(written, codec, turnaround) == pytest.approx(
            least_write(written, codec, turnaround, caps=write)
        ), f"write {' '.join(map(str, written))} at {turnaround}"


@pytest.mark.arithmetic
@pytest.mark.parametrize("seed", seeds(1, 4))
def test_larger_sets(seed: int) -> None:
    random = Random(seed)  # noqa: S311
    turnaround = TURNAROUNDS[seed]
    compare(side_by_side(random, 40), FACON, turnaround)
    compare(scattered(random, "R", 100, 40), FACON, turnaround)
    assert reads_cost(several := scattered(random, "M", 900, 30), FACON, turnaround) == pytest.approx(
        least_read(several, FACON, turnaround)
    )


@pytest.mark.parametrize(
    "text",
    [
        "R0-R61 R63-R126",  # a run must end at the gap, or the other one does not fit in one request
        "R0 DR1-DR63",  # the single one before, or one of the pairs is left over
        "DR0 DR1 DR2 DR3",  # each across the next
        "R0-R61 DR62 DR63",  # across the limit
        "DR0-DR60 R62 DR63 R65",  # a pair across the limit, in more words than a mixed request holds
        "M7 WM8",  # one word holds M7 and M8, but not all of WM8
        "M3-M47",  # as such up to 16, not to 8: two words follow, and nothing is left over
        "M0-M55",
        "WM8 WM24 M0-M7 M40-M50",
        "M2000-M2001 WM1984",
        "DWM0 DWM8 WM24",  # packed words across each other
        "M9990-M9999",  # a word must begin 8 earlier, as there are no 16 left
        "M9999 DWM9960",
        "X0 Y0 M0 S0 T0 C0 R0 D0 RT0 RC0 DRC0 DRT1",
        "DRC0 DRC1 DRC2 DRC3 DRC5",  # two lines, by even and odd address
        "DR65534 R65535",
    ],
)
@pytest.mark.parametrize(
    ("codec", "turnaround"),
    [("facon", 0.0), ("mseries", 115.0), night("facon", 115.0), night("mseries", 0.0)],
)
def test_chosen_sets(text: str, codec: str, turnaround: float) -> None:
    compare(named(text), CODECS[codec], turnaround)


@pytest.mark.parametrize(
    ("text", "limits"),
    [
        ("S0-S7", {"S": 8}),  # no word fits
        ("M90-M99", {"M": 100}),
        ("M96-M103", {"M": 104}),  # the word begins at 88
        ("M8 M20 M40 M99", {"M": 100}),
        ("M1900 M1990-M2001", {"M": 2002}),
        ("X3 X9 X17", {"X": 20}),
        ("X3 X5", {"X": 8}),  # no word at all
        ("DWM64 M70 M96 M103", {"M": 104}),
    ],
)
@codecs
def test_at_the_end_of_a_plc(text: str, limits: dict[str, int], codec: Codec) -> None:
    elements = named(text)
    for turnaround in TURNAROUNDS:
        plan = plan_reads(elements, codec, turnaround=turnaround, limits=limits)
        assert wire_bytes(plan, codec, turnaround) == pytest.approx(
            least_read(elements, codec, turnaround, limits=limits)
        )


@given(st.sets(st.integers(0, 60), min_size=1, max_size=9), st.integers(0, 30), turnarounds)
@settings(deadline=None, max_examples=examples(60))
def test_at_the_end_of_any_plc(addresses: set[int], room: int, turnaround: float) -> None:
    elements = named(" ".join(f"M{address}" for address in addresses))
    limits = {"M": max(addresses) + 1 + room}
    plan = plan_reads(elements, FACON, turnaround=turnaround, limits=limits)
    assert wire_bytes(plan, FACON, turnaround) == pytest.approx(
        least_read(elements, FACON, turnaround, limits=limits)
    )
