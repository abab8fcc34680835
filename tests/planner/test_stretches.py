"""Stretches of elements: planned as their elements are, without naming each."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.planner import plan_reads
from fatektool.protocol.commands import ReadRegisters
from fatektool.protocol.elements import KINDS, Element, Stretch
from fatektool.protocol.fatek.facon.codec import FACON, FaconCodec
from fatektool.protocol.registry import CODECS
from tests.night import examples

SYMBOLS = ["X", "M", "WM", "DWY", "R", "D", "DR", "RT", "RC", "DRC"]


@st.composite
def stretches(draw: st.DrawFn) -> Stretch:
    kind = KINDS[draw(st.sampled_from(SYMBOLS))]
    address = draw(st.integers(0, 40)) * kind.step
    return Stretch(Element(kind.symbol, address), draw(st.integers(1, 150 // kind.stride + 1)))


@given(
    parts=st.lists(stretches(), min_size=1, max_size=4),
    singles=st.lists(st.builds(Element, st.sampled_from(["R", "M", "DRC"]), st.integers(0, 200)), max_size=4),
    codec=st.sampled_from(["facon", "mseries"]),
    turnaround=st.sampled_from([0.0, 9.6, 900.0]),
)
@settings(max_examples=examples(40), deadline=None)
def test_a_plan_of_stretches_is_that_of_their_elements(
    parts: list[Stretch], singles: list[Element], codec: str, turnaround: float
) -> None:
    elements = [*singles, *(element for part in parts for element in part)]
    by_stretch = plan_reads([*parts, *singles], CODECS[codec], turnaround=turnaround)
    assert by_stretch == plan_reads(elements, CODECS[codec], turnaround=turnaround)


class Parted(FaconCodec):
    """No run goes over the border from 99 to 100."""

    def neighbourhood(self, element: Element, *, writes: bool) -> int:  # noqa: ARG002  # the interface's
        return element.address // 100


def test_a_stretch_over_two_neighbourhoods_is_parted() -> None:
    part = Stretch(Element("R", 90), 20)
    plan = plan_reads([part], Parted())
    assert plan == [ReadRegisters(Element("R", 90), 10), ReadRegisters(Element("R", 100), 10)]
    assert plan == plan_reads(list(part), Parted())


def test_the_elements_of_a_stretch() -> None:
    assert list(Stretch(Element("R", 5), 3)) == [Element("R", 5), Element("R", 6), Element("R", 7)]
    assert list(Stretch(Element("WY", 8), 2)) == [Element("WY", 8), Element("WY", 24)]
    assert Stretch(Element("DR", 0), 4).last == Element("DR", 6)


@pytest.mark.parametrize(("symbol", "address", "count"), [("R", 0, 0), ("R", 65535, 2), ("X", 9990, 11)])
def test_no_stretch(symbol: str, address: int, count: int) -> None:
    with pytest.raises(UsageError):
        Stretch(Element(symbol, address), count)


def test_all_of_a_plc_is_full_runs_first() -> None:
    plan = plan_reads([Stretch(Element("R", 0), 8072)], FACON)
    lengths = [request.count for request in plan if hasattr(request, "count")]
    assert lengths[:126] == [64] * 126
