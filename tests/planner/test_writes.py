"""Planned writes: what is asked is written once and whole, and nothing else is touched."""

from __future__ import annotations

from array import array
from collections import Counter
from random import Random
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.planner import paths, plan_writes
from fatektool.planner.edges import Edges
from fatektool.protocol.commands import Request, WriteDiscretes, WriteMixed, WriteRegisters
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.fatek.facon.codec import FACON, parse_frame
from tests.night import examples
from tests.planner.exhaustive import places_of
from tests.planner.sets import TURNAROUNDS, apart, element_sets, named, scattered
from tests.protocol.decoding import request_of
from tests.rigs import simulated

if TYPE_CHECKING:
    from fatektool.simulator.memory import SimulatedMemory

AREAS = {
    "Y": 256,
    "M": 2002,
    "S": 1000,
    "T": 256,
    "C": 256,
    "R": 3840,  # behind them are inputs
    "D": 4096,
    "F": 8192,
    "RT": 256,
    "RC": 256,
    "X": 256,
}
turnarounds = st.sampled_from(TURNAROUNDS)


def touched(request: Request[Any]) -> list[Element]:
    """The elements that a write names, one by one."""
    if isinstance(request, WriteMixed):
        return [element for element, _ in request.items]
    assert isinstance(request, WriteDiscretes | WriteRegisters)
    return [request.first.after(place) for place in range(len(request.values))]


def plan_of(elements: list[Element], turnaround: float = 0.0) -> list[Request[None]]:
    return plan_writes([(element, 0) for element in elements], FACON, turnaround=turnaround)


def contents(memory: SimulatedMemory) -> dict[str, list[int]]:
    """All of it."""
    return {area: list(table) for area, table in [*memory.status.items(), *memory.registers.items()]}


def written(before: dict[str, list[int]], items: list[tuple[Element, int]]) -> dict[str, list[int]]:
    """What memory should hold after a write: said once more, without the planner's words."""
    after = {area: list(table) for area, table in before.items()}
    for element, value in items:
        symbol, address, bits = element.symbol, element.address, element.kind.bits
        if bits == 1:
            after[symbol][address] = value
        elif "W" in symbol:
            for bit in range(bits):
                after[symbol[-1]][address + bit] = value >> bit & 1
        elif bits == 16:
            after[symbol][address] = value
        else:
            after[symbol[1:]][address : address + 2] = [value & 0xFFFF, value >> 16]
    return after


@given(st.data(), turnarounds, st.integers(0, 99))
@settings(deadline=None, max_examples=examples(120))
def test_what_is_asked_is_written_and_nothing_else(data: st.DataObject, turnaround: float, seed: int) -> None:
    random = Random(seed)  # noqa: S311
    elements = [
        element
        for element in apart(data.draw(element_sets(most=30, areas=AREAS)))
        if not element.symbol.endswith("X")  # inputs follow their terminals
    ]
    one = simulated(model="fbs-20mc")
    memory = one.device.memory
    for table in memory.status.values():
        table[:] = bytes(byte & 1 for byte in random.randbytes(len(table)))
    for registers in memory.registers.values():
        registers[:] = array("H", random.randbytes(2 * len(registers)))
    items = [(element, random.randrange(1 << element.kind.bits)) for element in elements]
    before = contents(memory)
    for request in plan_writes(items, FACON, turnaround=turnaround):
        one.plc.link.ask(request)
    assert contents(memory) == written(before, items)


@given(element_sets(most=40), turnarounds)
@settings(deadline=None, max_examples=examples(150))
def test_each_place_once_and_no_element_torn(elements: list[Element], turnaround: float) -> None:
    """An element written in two parts would hold a wrong value for a scan."""
    elements = apart(elements)
    plan = plan_of(elements, turnaround)
    count = Counter(place for request in plan for one in touched(request) for place in places_of([one]))
    assert set(count) == places_of(elements)
    assert set(count.values()) == {1}
    for element in elements:
        assert any(places_of([element]) <= places_of(touched(request)) for request in plan), str(element)
    assert len(plan) <= len(elements)
    for request in plan:
        frame = parse_frame(FACON.encode(1, request))  # it can be said: no limit is broken
        assert request_of(frame) == request


@given(element_sets(most=20), turnarounds, st.randoms(use_true_random=False))
@settings(deadline=None, max_examples=examples(60))
def test_order_does_not_matter(elements: list[Element], turnaround: float, random: Random) -> None:
    items = [(element, random.randrange(1 << element.kind.bits)) for element in apart(elements)]
    plan = plan_writes(items, FACON, turnaround=turnaround)
    random.shuffle(items)
    assert plan_writes(iter(items), FACON, turnaround=turnaround) == plan


def test_nothing() -> None:
    assert plan_writes([], FACON) == []


@pytest.mark.parametrize("symbol", KINDS)
def test_one_element_is_one_request(symbol: str) -> None:
    kind = KINDS[symbol]
    for address in (0, kind.last):
        plan = plan_of([Element(symbol, address)], 100)
        assert len(plan) == 1
        assert places_of(touched(plan[0])) == places_of([Element(symbol, address)])


@pytest.mark.parametrize("turnaround", TURNAROUNDS)
@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("R0-R3839", 60),
        ("M0-M1999", 2),
        ("Y0-Y255", 1),
        ("M8-M1026", 2),
        ("R0 Y9 DWM0", 1),
    ],
)
def test_how_many_requests(text: str, count: int, turnaround: float) -> None:
    assert len(plan_of(named(text), turnaround)) == count


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("R0-R3", [WriteRegisters(Element("R", 0), (0,) * 4)]),
        ("M3-M9", [WriteDiscretes(Element("M", 3), (False,) * 7)]),
        ("M8-M23", [WriteRegisters(Element("WM", 8), (0,))]),
        # Eight more as such cost less than a word that is short of eight.
        (
            "M3-M207",
            [WriteDiscretes(Element("M", 3), (False,) * 13), WriteRegisters(Element("WM", 16), (0,) * 12)],
        ),
        # 65 words: one is written as discretes, with those before it.
        (
            "M5-M1047",
            [WriteDiscretes(Element("M", 5), (False,) * 19), WriteRegisters(Element("WM", 24), (0,) * 64)],
        ),
    ],
)
def test_small_plans(text: str, plan: list[Request[None]]) -> None:
    assert plan_of(named(text)) == plan


def test_a_word_is_not_written_in_halves() -> None:
    """M0-M23 with WM8 among them: two words as such would tear it."""
    plan = plan_of(named("M0-M7 WM8"))
    assert any(places_of(named("WM8")) <= places_of(touched(request)) for request in plan)
    plan = plan_of(named("M0-M7 WM8 WM24 M40-M50"))
    assert [places_of(named("WM8 WM24")) <= places_of(touched(request)) for request in plan].count(True) == 1


def test_a_gap_is_never_written_over() -> None:
    assert [touched(request) for request in plan_of(named("R0 R2"), 1000)] == [named("R0 R2")]
    for request in plan_of(named("M0-M6 M8-M15"), 1000):
        assert Element("M", 7) not in touched(request)
        assert ("M", 7) not in places_of(touched(request))


def test_values_go_where_they_belong() -> None:
    items = [
        (Element("DR", 2), 0x1234_5678),
        (Element("R", 4), 9),
        (Element("WM", 8), 0x8001),
        (Element("M", 24), 1),
        (Element("DRC", 1), 0xFFFF_0000),
    ]
    values: dict[tuple[str, int], int] = {}
    for request in plan_writes(items, FACON):
        assert isinstance(request, WriteMixed)
        values |= {(element.symbol, element.address): value for element, value in request.items}
    assert values == {
        ("DR", 2): 0x1234_5678,
        ("R", 4): 9,
        ("WM", 8): 0x8001,
        ("M", 24): 1,
        ("DRC", 1): 0xFFFF_0000,
    }


@pytest.mark.parametrize("turnaround", [0.0, 115.0, 920.0])
@pytest.mark.parametrize(
    ("text", "edges", "labels"), [("R0-R3839", 1_000, 1_000), ("M0-M1999", 20_000, 5_000)]
)
def test_the_work_is_bounded(
    text: str, edges: int, labels: int, turnaround: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: Counter[str] = Counter()
    edges_of, label = Edges.of, paths._Label

    def counted_edges(self: Edges, node: int) -> list[paths.Edge]:
        found = list(edges_of(self, node))
        done["edges"] += len(found)
        return found

    def counted_label(*parts: Any) -> paths._Label:
        done["labels"] += 1
        return label(*parts)

    monkeypatch.setattr(Edges, "of", counted_edges)
    monkeypatch.setattr(paths, "_Label", counted_label)
    plan_of(named(text), turnaround)
    assert done["edges"] <= edges
    assert done["labels"] <= labels


@pytest.mark.parametrize("turnaround", TURNAROUNDS)
def test_scattered_registers(turnaround: float) -> None:
    """Mixed writes hold 32 words."""
    elements = scattered(Random(32), "R", 3840, 32)  # noqa: S311
    assert [type(request) for request in plan_of(elements, turnaround)] == [WriteMixed]
