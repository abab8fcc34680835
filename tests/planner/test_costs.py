"""What the planner takes a plan to cost is what the codec makes of it, and what the line then carries."""

from __future__ import annotations

from itertools import product
from random import Random
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.planner import plan_reads, plan_writes
from fatektool.planner.costs import Costs, costs_of
from fatektool.planner.paths import Edge, Run, least_path
from fatektool.protocol.commands import (
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    WriteDiscretes,
    WriteMixed,
    WriteRegisters,
)
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.fatek.mseries.codec import MSERIES
from tests.night import examples
from tests.planner.exhaustive import wire_bytes
from tests.planner.sets import named
from tests.rigs import simulated
from tests.rows import each

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec


@each(("codec", "symbol"), [(codec, symbol) for codec in (FACON, MSERIES) for symbol in KINDS])
@each("count", [1, 2, 7, 32])
def test_runs_and_items(symbol: str, count: int, codec: Codec) -> None:
    """Each value of a run costs the same, each item of a mixed request too, wherever they are."""
    first = Element(symbol, KINDS[symbol].step)
    reads, writes = Costs(codec, 7.5, writes=False), Costs(codec, 7.5, writes=True)
    discrete = first.kind.bits == 1
    read = ReadDiscretes(first, count) if discrete else ReadRegisters(first, count)
    write = WriteDiscretes(first, (True,) * count) if discrete else WriteRegisters(first, (1,) * count)
    assert reads.run_base(symbol) + count * reads.run_value(symbol) == wire_bytes([read], codec, 7.5)
    assert writes.run_base(symbol) + count * writes.run_value(symbol) == wire_bytes([write], codec, 7.5)
    items = tuple(first.after(place) for place in range(count // first.kind.words))
    if items:
        mixed = wire_bytes([ReadMixed(items)], codec, 7.5)
        assert reads.mixed_base + len(items) * reads.mixed_item(symbol) == mixed
    items = items[: 32 // first.kind.words]
    if items:
        mixed = wire_bytes([WriteMixed(tuple((item, 1) for item in items))], codec, 7.5)
        assert writes.mixed_base + len(items) * writes.mixed_item(symbol) == mixed


def test_bytes_of_the_paper() -> None:
    """46 of R12-R14 is 16 bytes and its answer 21; of 48 of R1, Y9 and DWM0: 28 and 22."""
    assert wire_bytes([ReadRegisters(Element("R", 12), 3)], FACON, 0) == 16 + 21
    assert wire_bytes([ReadMixed(tuple(named("R1 Y9 DWM0")))], FACON, 0) == 28 + 22


def test_bytes_of_a_binary_protocol() -> None:
    assert wire_bytes([ReadRegisters(Element("R", 12), 3)], MSERIES, 0) == 8 + 2 + 1 + 3 + 8 + 3 + 6
    assert wire_bytes([ReadMixed(tuple(named("R1 Y9 DWM0")))], MSERIES, 0) == 8 + 2 + 1 + 11 + 8 + 3 + 7


def test_the_codec_decides() -> None:
    """Five discretes as such are dearer than a word in FACON's hex; three are in a binary protocol."""
    wanted = named("M0-M3")
    assert plan_reads(wanted, FACON) == [ReadDiscretes(Element("M", 0), 4)]
    assert plan_reads(wanted, MSERIES) != [ReadDiscretes(Element("M", 0), 4)]
    elements = named("R0-R9 R11-R20 R25-R40 R200-R240")
    own: list[tuple[Codec, Codec]] = [(FACON, MSERIES), (MSERIES, FACON)]
    for codec, other in own:
        cost = wire_bytes(plan_reads(elements, codec), codec, 0)
        assert cost <= wire_bytes(plan_reads(elements, other), codec, 0)


@pytest.mark.parametrize("text", ["R0-R199", "M3-M90 R7 DWY8", "R1 R5 R9 R300 DD7 X1"])
def test_what_the_line_carries(text: str) -> None:
    """The bytes that go to and from a PLC are those that the plan was made for."""
    one = simulated()
    elements = named(text)
    for plan in (plan_reads(elements, FACON), plan_writes([(element, 1) for element in elements], FACON)):
        for request in plan:
            answer = one.plc.link.ask(request)
            assert len(FACON.encode_answer(1, request, answer)) == FACON.answer_bytes(request)


# --- the least path alone -------------------------------------------------------------------------


def _graph(random: Random, end: int) -> dict[int, list[Edge]]:
    graph = {}
    for node in range(end):
        graph[node] = [Edge(node + 1, random.randint(20, 40), 0, Run("R", node, 1))]
        for _ in range(random.randint(0, 4)):
            words = random.randint(0, 3)
            cost = random.randint(1, 30)
            graph[node].append(Edge(random.randint(node + 1, end), cost, words, Run("R", node, words)))
    return graph


def _every_path(graph: dict[int, list[Edge]], end: int) -> list[tuple[float, int]]:
    ways: dict[int, set[tuple[float, int]]] = {node: set() for node in range(end + 1)}
    ways[0] = {(0.0, 0)}
    for node in range(end):
        for edge in graph[node]:
            ways[edge.to] |= {(cost + edge.cost, words + edge.words) for cost, words in ways[node]}
    return sorted(ways[end])


@given(
    st.integers(0, 10_000),
    st.integers(1, 14),
    st.sampled_from([0.0, 1.0, 19.0, 134.5, 1019.0]),
    st.integers(1, 9),
)
@settings(deadline=None, max_examples=examples(300))
def test_the_least_of_all_paths(seed: int, end: int, base: float, capacity: int) -> None:
    random = Random(seed)  # noqa: S311
    graph = _graph(random, end)
    edges = {(id(edge.piece), edge.to): edge for node in graph for edge in graph[node]}
    found = least_path(end, graph.__getitem__, base, capacity)
    at, cost, words = 0, 0.0, 0
    for piece in found:
        edge = min(
            (edge for (piece_id, _), edge in edges.items() if piece_id == id(piece)),
            key=lambda edge: edge.cost,
        )
        at, cost, words = edge.to, cost + edge.cost, words + edge.words
    assert at == end
    least = min(own + base * -(-mixed // capacity) for own, mixed in _every_path(graph, end))
    assert cost + base * -(-words // capacity) == pytest.approx(least)


def test_no_edge_in_vain() -> None:
    """Nodes that no path touches are never asked for."""
    asked: list[int] = []

    def edges(node: int) -> list[Edge]:
        asked.append(node)
        return [Edge(node + 5, 1.0, 0, Run("R", node, 5))]

    assert least_path(10, edges, 1.0, 4) == [Run("R", 0, 5), Run("R", 5, 5)]
    assert sorted(asked) == [0, 5]


def test_where_every_path_is_mixed() -> None:
    graph = {
        node: [Edge(node + 1, 2.0, 3, Run("R", node, 1)), Edge(node + 1, 1.0, 5, Run("D", node, 1))]
        for node in range(3)
    }
    found = least_path(3, graph.__getitem__, 1000.0, 4)
    assert sorted(run[0] for run in found if isinstance(run, Run)) == [
        "D",
        "R",
        "R",
    ]  # 11 words, as dear as 9


def test_costs_are_kept_for_the_next_plan() -> None:
    """A job makes many plans for one line. Another protocol, turnaround or way has its own costs."""
    assert costs_of(FACON, 7.5, writes=False) is costs_of(FACON, 7.5, writes=False)
    for codec, turnaround, writes in product((FACON, MSERIES), (0.0, 7.5), (False, True)):
        kept, made = costs_of(codec, turnaround, writes=writes), Costs(codec, turnaround, writes=writes)
        assert kept.mixed_base == made.mixed_base
        assert [kept.run(symbol, 3) for symbol in KINDS] == [made.run(symbol, 3) for symbol in KINDS]
