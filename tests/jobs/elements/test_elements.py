"""Reading and writing as jobs: what is refused stands alone, whatever it stood beside."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.errors import LineError, UsageError
from fatektool.jobs.elements.disabled import read_disabled
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.selection import parse_items
from fatektool.jobs.elements.writes import write_elements
from fatektool.protocol.elements import Element
from fatektool.simulator.models import MODELS
from fatektool.simulator.refusal import Refusal, RefusalCode
from tests.night import examples
from tests.plant import cut_after, small, with_holes


def elements(*texts: str) -> list[Element]:
    return [item.element for item in parse_items(texts)]


@pytest.mark.parametrize(
    ("wanted", "refused"),
    [
        ("R9000 R0-R99", "R9000"),
        ("R8000-R8080", "R8072-R8080"),
        ("R0 R2 R4 R8070-R8073 R8090", "R8072 R8073 R8090"),
        ("DR8070 DR8071 R8071", "DR8071"),
        ("X0-X255 X256 Y0", "X256"),
        ("M1990-M2003", "M2002 M2003"),
        ("WM1984 WM1992 DWM1968 M2001", "WM1992"),
        ("F0 F1 F2", "F0 F1 F2"),
        ("R9000", "R9000"),
        ("RT255 RT256 DRC254 DRC255 T255 T256 S999 S1000", "RT256 DRC255 T256 S1000"),
        ("R8000-R9999", "R8072-R9999"),
        ("D3000-D3071 D5000-D5999 R1", "D5000-D5999"),
    ],
)
def test_what_is_refused_does_not_lose_the_others(wanted: str, refused: str) -> None:
    made = small()
    asked, lost = elements(*wanted.split()), elements(*refused.split())
    reading = read_elements(made.plc, asked)
    assert sorted(reading.errors) == sorted(lost)
    assert list(reading.values) == [element for element in asked if element not in lost]
    for element, text in reading.errors.items():
        assert text.startswith("not asked: ") if element in reading.not_asked else f" {element} (" in text
    assert reading.requests <= made.plc.link.counters.exchanges


@pytest.mark.parametrize(
    "wanted",
    [
        "R0-R3839",
        "X0-X255 Y0-Y255",
        "DR0:500 R0-R1999",
        "R0 M3 WM8 DRC200 T5",
        "R8000-R9999",
        "F0 F1",
        "R9000",
    ],
)
def test_the_progress_goes_up_to_all_elements(wanted: str) -> None:
    asked = elements(*wanted.split())
    told: list[tuple[str, int, int]] = []
    reading = read_elements(small().plc, asked, progress=lambda *step: told.append(step))
    assert len(reading.values) + len(reading.errors) == len(asked)
    done = [step[1] for step in told]
    assert {(phase, total) for phase, _, total in told} == {("reading", len(asked))}
    assert done == sorted(done)
    assert done[-1] == len(asked)
    assert len(told) <= reading.requests + 1


def test_the_progress_of_all_elements_is_near_the_truth() -> None:
    """16 relays may be read as one word: they count as 16."""
    told: list[int] = []
    made = small()
    read_elements(made.plc, elements("X0-X255", "R0-R1999"), progress=lambda _, done, __: told.append(done))
    steps = [after - before for before, after in pairwise([0, *told])]
    assert max(steps) <= 256
    assert told[-2:] == [2256, 2256]


@settings(max_examples=examples(60), deadline=None)
@given(
    st.sets(st.integers(0, 90)),
    st.lists(st.integers(0, 90), min_size=1, unique=True),
    st.sampled_from([RefusalCode.ILLEGAL_ADDRESS, RefusalCode.WRITE_PROHIBITED]),
)
def test_any_holes(holes: set[int], asked: list[int], code: RefusalCode) -> None:
    made = with_holes(holes, code)
    wanted = [Element("R", address) for address in asked]
    reading = read_elements(made.plc, wanted)
    assert {element.address for element in reading.errors} == holes & set(asked)
    failed = write_elements(made.plc, [(element, 7) for element in wanted])
    assert {each.element.address for each in failed} == holes & set(asked)
    assert all("the PLC refused to" in each.reason for each in failed)


@pytest.mark.parametrize("model", MODELS)
def test_everything_refused_ends(model: str) -> None:
    made = small(model=model)
    asked = elements("R20000-R20999", "D20000-D20999", "M9000-M9999", "X9000", "WY9984", "DR60000")
    reading = read_elements(made.plc, asked)
    assert list(reading.errors) == asked
    assert not reading.values
    assert reading.requests < 1000


def test_writes_that_are_refused_for_writing_only_are_found() -> None:
    made = small()
    write = made.device.write_words

    def prohibiting(symbol: str, address: int, values: list[int]) -> None:
        if 10 in range(address, address + len(values)):
            raise Refusal(RefusalCode.WRITE_PROHIBITED)
        write(symbol, address, values)

    made.device.write_words = prohibiting  # type: ignore[method-assign, assignment]  # as above
    failed = write_elements(made.plc, [(Element("R", at), at + 1) for at in range(64)])
    assert [(each.element, each.got) for each in failed] == [(Element("R", 10), 0)]
    assert "error 3" in failed[0].reason
    assert read_elements(made.plc, [Element("R", 63)]).values == {Element("R", 63): 64}


def test_a_plc_that_only_acknowledges_is_found_out() -> None:
    made = small()
    made.device.acknowledge_only = True
    (failed,) = write_elements(made.plc, [(Element("R", 1), 5), (Element("R", 2), 0)])
    assert failed.element == Element("R", 1)
    assert failed.reason.startswith("acknowledged")


def test_reasons_of_packed_discretes_name_the_disabled_ones() -> None:
    made = small()
    for at in (3, 5, 40):
        made.plc.disable(Element("M", at))
    failed = write_elements(
        made.plc,
        [(Element("WM", 0), 0x0028), (Element("M", 40), 1), (Element("WX", 0), 1), (Element("M", 16), 1)],
    )
    reasons = {str(each.element): each.reason for each in failed}
    assert set(reasons) == {"WM0", "M40", "WX0"}
    assert reasons["WM0"].startswith("M3, M5 are disabled")
    assert reasons["M40"].startswith("it is disabled")
    assert "terminal" in reasons["WX0"]


def test_disabled_flags_across_what_the_plc_has_not() -> None:
    made = small()
    made.plc.disable(Element("Y", 255))
    flags, errors = read_disabled(made.plc, elements("Y250-Y260", "M0"))
    assert [element.address for element, flag in flags.items() if flag] == [255]
    assert sorted(element.address for element in errors.errors) == [256, 257, 258, 259, 260]


def test_overlapping_targets_send_nothing() -> None:
    made = small()
    with pytest.raises(UsageError, match="overlap"):
        write_elements(made.plc, [(Element("DRC", 0), 1), (Element("RC", 1), 1)])
    assert made.plc.link.counters.exchanges == 0


def test_a_dead_line_is_an_error_of_the_line(monkeypatch: pytest.MonkeyPatch) -> None:
    cut_after(monkeypatch, 3)
    with pytest.raises(LineError):
        read_elements(small().plc, elements("R0-R999"))
