"""Planned reads: everything wanted, whole, in the fewest bytes, and nothing past the PLC's end."""

from __future__ import annotations

from random import Random
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.planner import Values, paths, plan_reads, turnaround_bytes
from fatektool.planner.edges import Edges
from fatektool.protocol.commands import ReadDiscretes, ReadMixed, ReadRegisters, Request
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.fatek.facon.codec import FACON, parse_frame
from tests.night import examples, night
from tests.planner.exhaustive import places_of, wire_bytes
from tests.planner.plain import merged, one_each
from tests.planner.sets import TURNAROUNDS, element_sets, named, scattered, side_by_side
from tests.protocol.decoding import request_of
from tests.rigs import Simulated, simulated
from tests.rows import each

AREAS = {
    "X": 256,
    "Y": 256,
    "M": 2002,
    "S": 1000,
    "T": 256,
    "C": 256,
    "R": 8072,
    "D": 4096,
    "F": 8192,
    "RT": 256,
    "RC": 256,
}
turnarounds = st.sampled_from(TURNAROUNDS)


def touched(request: Request[Any]) -> list[Element]:
    """The elements that a read names, one by one."""
    if isinstance(request, ReadMixed):
        return list(request.elements)
    assert isinstance(request, ReadRegisters | ReadDiscretes)
    return [request.first.after(place) for place in range(request.count)]


def whole(element: Element, plan: list[Request[Any]]) -> bool:
    """True if one request has all of an element."""
    return any(places_of([element]) <= places_of(touched(request)) for request in plan)


@pytest.fixture(scope="module")
def filled() -> Simulated:
    """A PLC with something else in each place."""
    random = Random("memory")  # noqa: S311  # the same memory each time
    one = simulated(model="fbs-20mc")
    memory = one.device.memory
    for table in memory.status.values():
        table[:] = bytes(random.randrange(2) for _ in table)
    for registers in memory.registers.values():
        for place in range(len(registers)):
            registers[place] = random.randrange(1 << 16)
    return one


def held(one: Simulated, element: Element) -> int:
    """What the simulator's memory has."""
    memory = one.device.memory
    if element.kind.bits == 1:
        return memory.read_discretes(element.symbol, element.address, 1)[0]
    return memory.read_words(element.symbol, element.address, 1)[0]


# --- what every plan keeps ------------------------------------------------------------------------


@given(st.data(), turnarounds)
@settings(deadline=None, max_examples=examples(150))
def test_every_value_is_right(filled: Simulated, data: st.DataObject, turnaround: float) -> None:
    elements = data.draw(element_sets(most=30, areas=AREAS))
    plan = plan_reads(elements, FACON, turnaround=turnaround, limits=AREAS)
    values = Values()
    for request in plan:
        values.take(request, filled.plc.link.ask(request))
    for element in elements:
        assert element in values
        assert values.value(element) == held(filled, element), str(element)


@given(element_sets(most=40), turnarounds)
@settings(deadline=None, max_examples=examples(150))
def test_all_is_covered_and_no_element_is_torn(elements: list[Element], turnaround: float) -> None:
    plan = plan_reads(elements, FACON, turnaround=turnaround)
    for element in elements:
        assert whole(element, plan), str(element)
    assert len(plan) <= len(set(elements))
    for request in plan:
        frame = parse_frame(FACON.encode(1, request))  # it can be said: no limit is broken
        assert request_of(frame) == request


@given(element_sets(most=20), turnarounds, st.randoms(use_true_random=False))
@settings(deadline=None, max_examples=examples(80))
def test_order_and_repetition_do_not_matter(
    elements: list[Element], turnaround: float, random: Random
) -> None:
    plan = plan_reads(elements, FACON, turnaround=turnaround)
    again = [*elements, *random.choices(elements, k=5)]
    random.shuffle(again)
    assert plan_reads(again, FACON, turnaround=turnaround) == plan
    assert plan_reads(iter(again), FACON, turnaround=turnaround) == plan


@given(element_sets(most=25), st.integers(0, 400), turnarounds)
@settings(deadline=None, max_examples=examples(150))
def test_past_the_limits_only_what_is_wanted(elements: list[Element], limit: int, turnaround: float) -> None:
    """Also where something past them is wanted: it alone is read there."""
    limits = dict.fromkeys("XYMSTCRDF", limit)
    plan = plan_reads(elements, FACON, turnaround=turnaround, limits=limits)
    wanted = places_of(elements)
    for request in plan:
        for area, place in places_of(touched(request)) - wanted:
            assert place < limits.get(area, 1 << 17), f"{area}{place} is read"
    for element in elements:
        assert whole(element, plan), str(element)


@given(element_sets(most=12), element_sets(most=12), turnarounds)
@settings(deadline=None, max_examples=examples(60))
def test_more_elements_never_cost_less(
    elements: list[Element], others: list[Element], turnaround: float
) -> None:
    def cost(some: list[Element]) -> float:
        return wire_bytes(plan_reads(some, FACON, turnaround=turnaround), FACON, turnaround)

    both = cost(elements + others)
    assert cost(elements) <= both + 1e-6
    assert both <= cost(elements) + cost(others) + 1e-6


@given(element_sets(most=40), turnarounds)
@settings(deadline=None, max_examples=examples(100))
def test_never_dearer_than_the_plain_rules(elements: list[Element], turnaround: float) -> None:
    cost = wire_bytes(plan_reads(elements, FACON, turnaround=turnaround), FACON, turnaround)
    for rule in (one_each, merged):
        plan = rule(elements)
        assert all(whole(element, plan) for element in elements)
        assert cost <= wire_bytes(plan, FACON, turnaround) + 1e-6


def test_nothing() -> None:
    assert plan_reads([], FACON) == []
    assert plan_reads([], FACON, turnaround=100, limits={"M": 8}) == []


@pytest.mark.parametrize("symbol", KINDS)
def test_one_element_is_one_request(symbol: str) -> None:
    kind = KINDS[symbol]
    for address in (0, kind.last):
        plan = plan_reads([Element(symbol, address)], FACON, turnaround=100)
        assert len(plan) == 1
        assert whole(Element(symbol, address), plan)


# --- figures --------------------------------------------------------------------------------------


@each("turnaround", TURNAROUNDS)
@each(
    ("text", "count"),
    [
        ("R0-R3839", 60),
        ("M0-M1999", 2),
        ("M0-M2001", 2),
        ("X0-X255", 1),
        ("R0-R63", 1),
        ("R0-R64", 2),
        ("DR0-DR62", 1),
        ("DRC0-DRC62", 1),
        ("R1 Y9 DWM0", 1),
        ("X0 Y16 M32 S48 T64 C80 R96 D112 RT1 RC2 DRT3 DRC4", 1),
    ],
)
def test_how_many_requests(text: str, count: int, turnaround: float) -> None:
    assert len(plan_reads(named(text), FACON, turnaround=turnaround)) == count


@pytest.mark.parametrize("turnaround", TURNAROUNDS)
def test_scattered_registers_are_one_request(turnaround: float) -> None:
    random = Random(40)  # noqa: S311
    plan = plan_reads(scattered(random, "R", 3840, 40), FACON, turnaround=turnaround)
    assert [type(request) for request in plan] == [ReadMixed]


def test_the_mixed_read_of_the_paper() -> None:
    """R1, Y9 and DWM0 are its example of 48."""
    plan = plan_reads(named("R1 Y9 DWM0"), FACON)
    assert [type(request) for request in plan] == [ReadMixed]
    assert set(touched(plan[0])) == set(named("R1 Y9 DWM0"))


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("R0-R3", [ReadRegisters(Element("R", 0), 4)]),
        ("R0 R2", [ReadRegisters(Element("R", 0), 3)]),  # a gap is read over
        ("M3", [ReadDiscretes(Element("M", 3), 1)]),
        ("M0-M3", [ReadDiscretes(Element("M", 0), 4)]),
        ("M0-M4", [ReadRegisters(Element("WM", 0), 1)]),  # four characters carry sixteen
        ("M9-M23", [ReadRegisters(Element("WM", 8), 1)]),
        ("M9990-M9999", [ReadRegisters(Element("WM", 9984), 1)]),
        # A full run, if it does not begin with M6.
        ("M6-M1031", [ReadDiscretes(Element("M", 6), 2), ReadRegisters(Element("WM", 8), 64)]),
    ],
)
def test_small_plans(text: str, plan: list[Request[Any]]) -> None:
    assert plan_reads(named(text), FACON) == plan


def test_the_last_word_of_a_plc() -> None:
    """With 256 inputs it begins at 240; at 248 only where there are more."""
    plan = plan_reads(named("X250-X255"), FACON, limits={"X": 256})
    assert plan == [ReadRegisters(Element("WX", 240), 1)]
    assert plan_reads(named("X250-X255"), FACON) == [ReadRegisters(Element("WX", 248), 1)]


def test_a_plain_request_where_a_mixed_one_costs_as_much() -> None:
    assert plan_reads(named("M3"), FACON, turnaround=115) == [ReadDiscretes(Element("M", 3), 1)]
    assert plan_reads(named("R3"), FACON, turnaround=115) == [ReadRegisters(Element("R", 3), 1)]


def test_turnaround_in_bytes() -> None:
    assert turnaround_bytes(0.010, 10 / 9600) == pytest.approx(9.6)
    assert turnaround_bytes(0.0, 1.0) == 0


def test_a_dear_turnaround_makes_fewer_requests() -> None:
    elements = named("R0-R9 R100-R109 R200-R209")
    cheap = plan_reads(elements, FACON, turnaround=0)
    dear = plan_reads(elements, FACON, turnaround=1000)
    assert [type(request) for request in cheap] == [ReadRegisters] * 3
    assert [type(request) for request in dear] == [ReadMixed]


# --- values ---------------------------------------------------------------------------------------


def test_a_value_is_of_one_answer() -> None:
    """A byte that two answers tell of is taken from the one that has all of the word."""
    values = Values()
    values.take(ReadRegisters(Element("WM", 0), 1), (0xFFFF,))
    values.take(ReadRegisters(Element("WM", 8), 1), (0x0000,))
    assert values.value(Element("WM", 0)) == 0xFFFF
    assert values.value(Element("WM", 8)) == 0x0000
    assert values.value(Element("M", 8)) == 0  # the last that was told
    assert values.value(Element("M", 7)) == 1
    assert Element("DWM", 0) not in values


def test_a_value_is_put_together_from_the_parts_of_one_answer() -> None:
    values = Values()
    values.take(ReadMixed(tuple(named("R2 DR0 X1"))), (3, 0x0002_0001, 1))
    assert values.value(Element("DR", 1)) == 0x0003_0002
    assert values.value(Element("DR", 0)) == 0x0002_0001
    assert values.value(Element("X", 1)) == 1
    values.take(ReadDiscretes(Element("Y", 0), 16), (True, False) * 8)
    assert values.value(Element("WY", 0)) == 0x5555
    values.take(ReadRegisters(Element("DWM", 8), 2), (0x8000_0001, 0xFFFF_FFFF))
    assert [values.value(element) for element in named("M8 M39 WM8 DWM40")] == [1, 1, 1, 0xFFFF_FFFF]
    values.take(ReadRegisters(Element("DRC", 0), 2), (1 << 31, 7))
    assert values.value(Element("DRC", 2)) == 7
    assert Element("RC", 0) not in values  # a counter's 32 bits may be a register of its own


def test_what_no_answer_told() -> None:
    values = Values()
    assert Element("R", 0) not in values
    assert "R0" not in values
    with pytest.raises(KeyError):
        values.value(Element("R", 0))
    values.take(ReadRegisters(Element("R", 0), 1), (1,))
    values.take(ReadRegisters(Element("R", 1), 1), (1,))
    assert Element("DR", 0) not in values
    with pytest.raises(KeyError):
        values.value(Element("DR", 0))


# --- how much is tried ----------------------------------------------------------------------------


class Work:
    """Counts the edges and labels that a plan takes."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.edges = 0
        self.labels = 0
        edges_of, label = Edges.of, paths._Label

        def counted_edges(edges: Edges, node: int) -> list[paths.Edge]:
            found = list(edges_of(edges, node))
            self.edges += len(found)
            return found

        def counted_label(*parts: Any) -> paths._Label:
            self.labels += 1
            return label(*parts)

        monkeypatch.setattr(Edges, "of", counted_edges)
        monkeypatch.setattr(paths, "_Label", counted_label)


@pytest.mark.parametrize("turnaround", [0.0, night(10.0), night(115.0), 920.0])
@pytest.mark.parametrize(
    ("name", "edges", "labels"),
    [
        ("R0-R3839", 1_000, 1_000),
        ("M0-M1999", 1_000, 1_000),
        ("800 of M0-M1999", 8_000, 10_000),
        ("200 of M0-M1999", 10_000, 10_000),
        ("400 of R0-R3839", 8_000, 10_000),
        ("2000 of R0-R3839", 70_000, 400_000),
        ("side by side", 5_000, 40_000),
    ],
)
def test_the_work_is_bounded(
    name: str, edges: int, labels: int, turnaround: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    random = Random(name)  # noqa: S311
    count, _, text = name.partition(" of ")
    if text:
        elements = random.sample(named(text), int(count))
    else:
        elements = side_by_side(random, 800) if name == "side by side" else named(name)
    work = Work(monkeypatch)
    plan_reads(elements, FACON, turnaround=turnaround)
    assert work.edges <= edges
    assert work.labels <= labels
