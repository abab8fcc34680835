"""Plans over Modbus: no mixed requests, eight discretes a byte, long runs; they cost what the cheapest do."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.planner import plan_reads, plan_writes
from fatektool.planner.edges import Edges
from fatektool.protocol.commands import (
    ReadDiscretes,
    ReadRegisters,
    Request,
    WriteDiscretes,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus.ascii import ASCII
from fatektool.protocol.modbus.map import parse_map
from fatektool.protocol.modbus.rtu import RTU
from fatektool.protocol.modbus.tcp import TCP
from tests.night import examples, seeds
from tests.planner.exhaustive import Caps, Limited, least_read, least_write, places_of, wire_bytes
from tests.planner.sets import (
    TURNAROUNDS,
    apart,
    element_sets,
    named,
    sayable,
    scattered,
    side_by_side,
    small_set,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.planner.paths import Edge
    from fatektool.protocol.codec import Codec

READ, WRITE = Caps(2000, 125, 0, packs=True), Caps(1968, 123, 0, packs=True)
CODECS: list[Codec] = [RTU, ASCII, TCP]
codecs = pytest.mark.parametrize("codec", CODECS, ids=lambda codec: codec.name)


def compare(
    elements: list[Element], codec: Codec, turnaround: float, read: Caps = READ, write: Caps = WRITE
) -> None:
    wanted = sayable(elements, codec)
    plan = plan_reads(wanted, codec, turnaround=turnaround)
    said = f"{' '.join(map(str, wanted))} at {turnaround}"
    if wanted:
        least = least_read(wanted, codec, turnaround, caps=read)
        assert wire_bytes(plan, codec, turnaround) == pytest.approx(least), f"read {said}"
    written = apart(sayable(elements, codec, writes=True))
    writes = plan_writes([(element, 0) for element in written], codec, turnaround=turnaround)
    if written:
        least = least_write(written, codec, turnaround, caps=write)
        assert wire_bytes(writes, codec, turnaround) == pytest.approx(least), f"write {said}"


@codecs
@pytest.mark.parametrize("seed", seeds(1, 3))
def test_random_sets(codec: Codec, seed: int) -> None:
    random = Random(seed)  # noqa: S311  # the same sets each time
    for _ in range(15):
        compare(small_set(random), codec, random.choice(TURNAROUNDS))


@given(element_sets(most=8), st.sampled_from(CODECS), st.sampled_from(TURNAROUNDS))
@settings(deadline=None, max_examples=examples(120))
def test_any_set(elements: list[Element], codec: Codec, turnaround: float) -> None:
    compare(elements, codec, turnaround)


@pytest.mark.arithmetic
@codecs
@pytest.mark.parametrize("seed", seeds(1, 3))
@pytest.mark.parametrize(
    "sizes", [(4, 40), (5, 33), (8, 64), (7, 72)], ids=["4 words", "5 words", "8 words", "7 words"]
)
def test_where_requests_are_full(codec: Codec, seed: int, sizes: tuple[int, int]) -> None:
    words, discretes = sizes
    caps = Caps(discretes, words, 0, packs=True)
    random = Random(seed)  # noqa: S311
    for _ in range(15):
        elements = random.choice((small_set, side_by_side))(random, 14)
        compare(elements, Limited(codec, caps, caps), random.choice(TURNAROUNDS), caps, caps)


@pytest.mark.arithmetic
@pytest.mark.parametrize("seed", seeds(1, 2))
def test_larger_sets(seed: int) -> None:
    random = Random(seed)  # noqa: S311
    compare(side_by_side(random, 40), RTU, TURNAROUNDS[seed])
    compare(scattered(random, "R", 900, 25), RTU, TURNAROUNDS[seed])
    compare(scattered(random, "M", 1900, 25), RTU, TURNAROUNDS[seed])


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("R0-R124", [ReadRegisters(Element("R", 0), 125)]),
        ("R0-R125", [ReadRegisters(Element("R", 0), 125), ReadRegisters(Element("R", 125), 1)]),
        ("M0-M1999", [ReadDiscretes(Element("M", 0), 2000)]),
        ("M0-M2001", [ReadDiscretes(Element("M", 0), 2000), ReadDiscretes(Element("M", 2000), 2)]),
        ("M3 M100", [ReadDiscretes(Element("M", 3), 98)]),  # thirteen bytes cost less than a request
        ("WM8 DWM24", [ReadDiscretes(Element("M", 8), 48)]),
        ("R4167 R5000", [ReadRegisters(Element("R", 4167), 1), ReadRegisters(Element("R", 5000), 1)]),
        ("DRC200 DRC204", [ReadRegisters(Element("DRC", 200), 3)]),
        ("DRC200 DRC254", [ReadRegisters(Element("DRC", 200), 1), ReadRegisters(Element("DRC", 254), 1)]),
    ],
)
def test_small_plans(text: str, plan: list[Request[Any]]) -> None:
    assert plan_reads(named(text), RTU, turnaround=10) == plan


@pytest.mark.parametrize(
    ("text", "requests"),
    [("M0 M127", 1), ("M0 M128", 2), ("M187 M392", 2), ("M22 M59 M112 M318 M344 M390", 2)],
)
def test_a_gap_is_as_dear_as_its_bytes(text: str, requests: int) -> None:
    """In ASCII a byte of eight discretes takes two characters, so less is read over."""
    elements = named(text)
    assert len(plan_reads(elements, ASCII)) == requests
    compare(elements, ASCII, 0.0)


def test_writes_are_long_and_touch_nothing_else() -> None:
    items = [(element, 0) for element in named("R0-R123 M0-M1968 R200 Y7")]
    plan = plan_writes(items, RTU)
    touched = [
        request.first.after(place)
        for request in plan
        if isinstance(request, WriteDiscretes | WriteRegisters)
        for place in range(len(request.values))
    ]
    assert len(touched) == len(items)
    assert places_of(touched) == places_of(element for element, _ in items)
    assert len(plan) == 6


def test_a_run_does_not_go_on_from_one_stretch_into_another() -> None:
    codec = RTU.mapped(
        parse_map("M1000-M1009=000001,M1010-M1019=100001,R2000-R2009=400001,R2010-R2019=300001")
    )
    plan = plan_reads(named("M1005-M1015 R2005-R2015"), codec)
    assert plan == [
        ReadDiscretes(Element("M", 1005), 5),
        ReadRegisters(Element("R", 2005), 5),
        ReadDiscretes(Element("M", 1010), 6),
        ReadRegisters(Element("R", 2010), 6),
    ]
    assert [codec.code(request) for request in plan] == [1, 3, 2, 4]


def test_what_has_no_reference_is_named_before_anything_is_planned() -> None:
    with pytest.raises(UsageError, match="F7 has no Modbus reference"):
        plan_reads(named("R0-R99 F7"), RTU)
    with pytest.raises(UsageError, match="R2999 has no Modbus reference: the custom map has R2000-R2009"):
        plan_writes([(Element("R", 2999), 1)], RTU.mapped(parse_map("R2000-R2009=400001")))


@pytest.mark.parametrize("text", ["M0-M2001", "R0-R3839", "S0-S999 M0-M2001 D0-D2998"])
def test_large_plans_are_soon_made(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []
    of = Edges.of

    def counted(edges: Edges, node: int) -> Iterator[Edge]:
        asked.append(node)
        return of(edges, node)

    monkeypatch.setattr(Edges, "of", counted)
    plan_reads(named(text), RTU, turnaround=10)
    assert len(asked) < 1000
