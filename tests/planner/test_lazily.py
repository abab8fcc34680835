"""A plan is made while it is carried out: the same requests, and the first of them before the search."""

from __future__ import annotations

from collections import Counter
from random import Random
from typing import TYPE_CHECKING

import pytest

from fatektool.planner import plan_reads, planned_reads
from fatektool.planner.atoms import lines_of
from fatektool.planner.costs import Costs
from fatektool.planner.edges import Edges
from fatektool.planner.paths import Run, Search, least_path
from fatektool.planner.reads import neighbourhoods
from fatektool.protocol.commands import ReadMixed, ReadRegisters, Request
from fatektool.protocol.elements import Element, Stretch
from fatektool.protocol.registry import CODECS

if TYPE_CHECKING:
    from typing import Any

    from fatektool.protocol.codec import Codec

ALL = [
    Stretch(Element(symbol, 0), count)
    for symbol, count in (("C", 200), ("D", 2900), ("M", 2002), ("R", 4000))
]


def at_once(elements: list[Element | Stretch], codec: Codec, turnaround: float) -> Counter[object]:
    """The runs and the mixed elements of the least path, found in one go."""
    costs = Costs(codec, turnaround, writes=False)
    found: Counter[object] = Counter()
    for some in neighbourhoods(elements, codec, writes=False):
        edges = Edges(lines_of(some, {}), costs)
        for piece in least_path(edges.end, edges.of, costs.mixed_base, max(1, costs.mixed_words)):
            found.update([piece] if isinstance(piece, Run) else piece)
    return found


def asked(requests: list[Request[Any]]) -> Counter[object]:
    """The same of requests."""
    found: Counter[object] = Counter()
    for request in requests:
        if isinstance(request, ReadMixed):
            found.update(request.elements)
        else:
            found[Run(request.first.symbol, request.first.address, request.count)] += 1  # type: ignore[attr-defined]
    return found


@pytest.mark.parametrize("name", CODECS)
@pytest.mark.parametrize("turnaround", [0.0, 10.0, 300.0])
def test_the_requests_are_those_of_a_plan_at_once(name: str, turnaround: float) -> None:
    codec = CODECS[name]
    random = Random(5)  # noqa: S311  # of no secret
    cases: list[list[Element | Stretch]] = [list(ALL)]
    for _ in range(10):
        first, count = random.randrange(2000), random.randrange(1, 400)
        single = [Element("R", random.randrange(3000)) for _ in range(random.randrange(30))]
        cases.append(
            [Stretch(Element("R", first), count), Stretch(Element("M", 0), random.randrange(1, 300)), *single]
        )
    for elements in cases:
        plan = plan_reads(elements, codec, turnaround=turnaround)
        assert asked(plan) == at_once(elements, codec, turnaround)
        assert plan == list(planned_reads(elements, codec, turnaround=turnaround))


def test_the_first_request_is_there_before_the_search(monkeypatch: pytest.MonkeyPatch) -> None:
    steps: list[str] = []
    search = Search.steps

    def counted(self: Search) -> Any:
        for step in search(self):
            steps.append("step")
            yield step
        steps.append("end")

    monkeypatch.setattr(Search, "steps", counted)
    plan = planned_reads(ALL, CODECS["facon"], turnaround=10)
    assert next(plan) == ReadRegisters(Element("D", 0), 64)
    assert steps == []
    before_the_end = 1
    for _ in plan:
        if "end" in steps:
            break
        before_the_end += 1
    assert before_the_end > 10
    assert steps[: before_the_end - 1] == ["step"] * min(before_the_end - 1, len(steps) - 1)
