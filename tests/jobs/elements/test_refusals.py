"""What is said of an element that was not read: heard of it, or not asked, and why; at what cost."""

from __future__ import annotations

import json
import random
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.errors import DataError, NoAnswer, PlcRefused
from fatektool.jobs.elements.disabled import read_disabled
from fatektool.jobs.elements.division import ROW, STEP
from fatektool.jobs.elements.reads import ElementReading, read_elements
from fatektool.jobs.elements.selection import parse_items
from fatektool.jobs.elements.writes import write_elements
from fatektool.jobs.snapshots.snapshot import parse_snapshot
from fatektool.planner import plan_reads
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.simulator.refusal import Refusal, RefusalCode
from tests.night import examples, seeds
from tests.plant import recorded, small, snapshot_of, with_holes

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fatektool.client import Plc
    from tests.cli.running import Cli
    from tests.plant import Plant

LITERAL = {*range(15), 20, 26, 29, 30, 42, 45, 46, 48, *range(59, 62), 64, 65, 73, 90}
"""Holes between which R15, R41, R44, R47 and R79 were lost once."""
EACH_SEARCH = 4 + 4 * 6
"""Requests to find the neighbours that are refused among the 64 of one request: 4 + 4 * log2(64)."""


def registers(addresses: Iterable[int]) -> list[Element]:
    return [Element("R", address) for address in addresses]


def runs(addresses: Iterable[int], of: Sequence[int]) -> list[int]:
    """How long the stretches of ``addresses`` are that stand together in ``of``."""
    chosen, lengths, length = set(addresses), [], 0
    for address in [*of, -1]:
        if address in chosen:
            length += 1
        elif length:
            lengths.append(length)
            length = 0
    return lengths


def bound(asked: Sequence[int], holes: set[int]) -> int:
    """The most requests that reading may take: what the docs say."""
    plan = len(plan_reads(registers(asked), FACON))
    total = 2 * plan + 1
    for length in runs(holes.intersection(asked), asked):
        alone = min(length, ROW + 64 + length // STEP + length // 64 + 2)
        total += alone + 2 * EACH_SEARCH
    return total


def check_reading(reading: ElementReading, asked: Sequence[int], holes: set[int]) -> None:
    """Nothing wrong is said, and nothing is lost that may not be."""
    errors = {element.address for element in reading.errors}
    left_out = {element.address for element in reading.not_asked}
    assert {element.address for element in reading.values} == set(asked) - errors
    assert left_out <= errors
    assert errors - left_out <= holes
    assert holes.intersection(asked) <= errors
    if max(runs(errors, asked), default=0) <= ROW:
        assert not left_out
    assert all(length < STEP for length in runs(left_out - holes, asked))
    for element, text in reading.errors.items():
        assert text.startswith("not asked: " if element in reading.not_asked else "the PLC refused to read")
    assert reading.requests <= bound(asked, holes)


@pytest.mark.parametrize("seed", seeds(12, 12))
def test_registers_between_holes_are_read(seed: int) -> None:
    asked = sorted(random.Random(seed).sample(range(91), 32)) if seed else list(range(91))  # noqa: S311
    asked = sorted({*asked, 15, 41, 44, 47, 79})
    reading = read_elements(with_holes(LITERAL).plc, registers(asked))
    assert [element.address for element in reading.errors] == sorted(LITERAL.intersection(asked))
    assert not reading.not_asked
    check_reading(reading, asked, LITERAL)


LENGTHS = st.sampled_from([1, 1, 2, 7, 40, 63, 130, 400, 900])
PARTS = st.lists(st.tuples(st.integers(0, 1500), LENGTHS), max_size=8)


@settings(max_examples=examples(25), deadline=None)
@given(PARTS, st.sets(st.integers(0, 1500), max_size=40), st.sampled_from([1, 1, 2, 5]))
def test_any_gaps(gaps: list[tuple[int, int]], more: set[int], every: int) -> None:
    holes = more.union(*(range(first, first + length) for first, length in gaps))
    asked = range(0, 1501, every)
    check_reading(read_elements(with_holes(holes).plc, registers(asked)), asked, holes)


@settings(max_examples=examples(60), deadline=None)
@given(st.sets(st.integers(0, 127)), st.booleans())
def test_nothing_is_lost_however_many_holes_two_requests_have(kept: set[int], turned: bool) -> None:
    holes = kept if turned else set(range(128)) - kept
    reading = read_elements(with_holes(holes).plc, registers(range(128)))
    assert {element.address for element in reading.errors} == holes
    assert not reading.not_asked


def asked_alone(sent: list[bytes]) -> set[int]:
    return {int(frame[8:13]) for frame in sent if frame[3:8] == b"4601R"}


def test_what_the_plc_is_said_to_refuse_was_asked_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    sent = recorded(monkeypatch)
    holes = {*range(100, 900), *LITERAL}
    reading = read_elements(with_holes(holes).plc, registers(range(1200)))
    heard = {element.address for element in reading.errors if element not in reading.not_asked}
    assert heard <= asked_alone(sent)
    assert not asked_alone(sent) & {element.address for element in reading.not_asked}


def test_a_gap_costs_a_search_and_loses_nothing_behind_it() -> None:
    gap = set(range(4168, 5000))
    reading = read_elements(with_holes(gap).plc, registers(range(8072)))
    check_reading(reading, range(8072), gap)
    assert {element.address for element in reading.errors} == gap
    assert reading.requests <= 127 + 1 + 14 + ROW + 64 + len(gap) // STEP + 2 * EACH_SEARCH
    said = reading.errors[Element("R", 4500)]
    row = "each of R4168 to R4295 is refused"
    assert said == f"not asked: {row}, and so are R4495 and R4511: a gap, or past the end"


def test_elements_that_53_excludes_are_asked_once_at_the_edge(monkeypatch: pytest.MonkeyPatch) -> None:
    sent = recorded(monkeypatch)
    reading = read_elements(small().plc, registers(range(10000)))
    assert {element.address for element in reading.errors} == set(range(8072, 10000))
    assert {element.address for element in reading.not_asked} == set(range(8073, 10000))
    assert asked_alone(sent) == {8072}
    assert reading.requests <= 127 + 5
    assert reading.errors[Element("R", 9999)] == (
        "not asked: R8072 is refused, and the PLC has R0 to R8071 by its status (53)"
    )


def test_what_is_far_from_other_neighbours_is_asked_for_itself() -> None:
    reading = read_elements(small().plc, registers([1, 8072, 8073, 9000, 9001, 20000]))
    assert [element.address for element in reading.not_asked] != []
    assert {element.address for element in reading.not_asked} == {8073, 9001}


def test_registers_past_what_53_says_are_read_where_the_plc_has_them(monkeypatch: pytest.MonkeyPatch) -> None:
    made = small()
    status = made.plc.detailed_status()
    few = replace(status, system=replace(status.system, r_registers=3840, d_registers=0))
    monkeypatch.setattr(type(made.plc), "detailed_status", lambda _: few)
    reading = read_elements(made.plc, [*registers(range(3800, 8100)), Element("D", 5), Element("D", 9000)])
    assert {str(element) for element in reading.errors} == {*(f"R{at}" for at in range(8072, 8100)), "D9000"}
    assert not reading.not_asked


@pytest.mark.parametrize("how", ["refused", "silent", "unknown"])
def test_where_53_says_nothing_the_end_is_searched(how: str, monkeypatch: pytest.MonkeyPatch) -> None:
    error = {
        "refused": PlcRefused("no", code=4, command=0x53),
        "silent": NoAnswer("nothing"),
        "unknown": DataError("a layout that no paper describes"),
    }[how]
    made = small()

    def failing(_: Plc) -> Any:
        raise error

    monkeypatch.setattr(type(made.plc), "detailed_status", failing)
    reading = read_elements(made.plc, registers(range(10000)))
    check_reading(reading, range(10000), set(range(8072, 10000)))
    assert Element("R", 8071) in reading.values


@pytest.mark.parametrize("protocol", ["modbus-rtu", "modbus-tcp", "mseries"])
def test_a_protocol_without_53_searches_the_end(protocol: str) -> None:
    made = small(protocol=protocol)
    wanted = registers(range(5000, 5900))
    gap = set(range(5300, 5700))
    made = with_holes(gap, protocol=protocol)
    reading = read_elements(made.plc, wanted)
    check_reading(reading, range(5000, 5900), gap)
    assert {element.address for element in reading.errors} == gap


@pytest.mark.parametrize("protocol", ["facon", "mseries"])
@pytest.mark.parametrize("fault", ["duplicate=0.3", "duplicate=0.1 flip=0.05", "late=0.1", "noise=0.2"])
@pytest.mark.parametrize("seed", seeds(2, 8))
def test_a_search_takes_no_other_answer_for_its_own(protocol: str, fault: str, seed: int) -> None:
    """Answers that come twice over a paced line would shift all that follow, refusals too."""
    holes = {3, 11, 12, *range(40, 52)}
    made = with_holes(holes, protocol=protocol, baud=9600, faults=fault.split(), seed=seed)
    for at in set(range(64)) - holes:
        made.device.write_words("R", at, [1000 + at * 7])
    reading = read_elements(made.plc, [*registers(range(64)), *registers([8072, 8073])])
    assert {element.address for element in reading.errors} == {*holes, 8072, 8073}
    for element, value in reading.values.items():
        assert value == 1000 + element.address * 7, element


def test_a_refusal_has_nothing_read_again(monkeypatch: pytest.MonkeyPatch) -> None:
    sent = recorded(monkeypatch)
    made = with_holes({3000})
    read_elements(made.plc, registers(range(3200)), limits={})
    firsts = [frame[5:13] for frame in sent if frame[3:5] == b"46"]
    assert firsts.count(b"40R00000") == 1


def test_writing_where_nothing_can_be_written_is_bounded_too() -> None:
    made = small()
    write = made.device.write_words

    def prohibiting(symbol: str, address: int, values: list[int]) -> None:
        if address + len(values) > 5000:
            raise Refusal(RefusalCode.WRITE_PROHIBITED)
        write(symbol, address, values)

    made.device.write_words = prohibiting  # type: ignore[method-assign, assignment]  # a PLC with other rules
    failed = write_elements(made.plc, [(Element("R", at), 7) for at in range(4000, 8072)])
    assert {each.element.address for each in failed} == set(range(5000, 8072))
    assert all(each.got == 0 for each in failed)
    assert all(each.reason.startswith(("not asked: ", "the PLC refused to write")) for each in failed)
    assert made.plc.link.counters.exchanges < 3 * 4072 // 64 + ROW + 64 + 3072 // STEP + 4 * EACH_SEARCH


def test_discretes_that_cannot_be_read_as_disabled_are_bounded_too() -> None:
    made = small()
    flags, refusals = read_disabled(made.plc, [Element("M", at) for at in range(1990, 6000)])
    assert {element.address for element in flags} == set(range(1990, 2002))
    assert {element.address for element in refusals.errors} == set(range(2002, 6000))
    assert refusals.not_asked
    assert made.plc.link.counters.exchanges < 600


def test_neighbours_of_several_kinds() -> None:
    made = small()
    wanted = [
        item.element for item in parse_items(["WM1984", "WM1992-WM9976", "DR8070-DR9998", "Y250-Y9999"])
    ]
    reading = read_elements(made.plc, wanted)
    assert [str(element) for element in reading.values] == [
        "WM1984",
        "DR8070",
        *(f"Y{at}" for at in range(250, 256)),
    ]
    heard = {str(element) for element in reading.errors} - {str(element) for element in reading.not_asked}
    assert heard == {"WM1992", "DR8072", "Y256"}
    assert reading.requests < 40


def test_the_command_tells_what_was_not_asked(plant: Plant, cli: Cli) -> None:
    document = plant.json("read", "read", "R8070-R8090", "M0", "-p", plant.target, code=4)
    assert document["not_asked"] == [f"R{at}" for at in range(8073, 8091)]
    assert list(document["errors"]) == [f"R{at}" for at in range(8072, 8091)]
    done = cli("read", "R8070-R8090", "M0", "-p", plant.target)
    refused, left_out = done.err.splitlines()
    assert refused.startswith("warning: R8072: the PLC refused to read registers R8072 (46): error A")
    why = "R8072 is refused, and the PLC has R0 to R8071 by its status (53)"
    assert left_out == f"warning: R8073 to R8090 (18): not asked: {why}"
    snapshot = plant.json("snapshot", "snapshot", "R8070-R8090", "-p", plant.target, code=4)
    assert snapshot["not_asked"] == document["not_asked"]
    listed = plant.json("discrete", "discrete", "list", "M2000-M2010", "-p", plant.target, code=4)
    assert listed["not_asked"] == [f"M{at}" for at in range(2003, 2011)]


def test_a_snapshot_file_that_names_others_as_not_asked_is_damaged() -> None:
    document = snapshot_of("R8070-R8090").document()
    assert parse_snapshot(json.dumps(document).encode(), "s").not_asked == document["not_asked"]
    cases: tuple[dict[str, object], ...] = ({"not_asked": ["R1"]}, {"not_asked": 5}, {"not_asked": [[]]})
    for damaged in cases:
        with pytest.raises(DataError, match="not_asked"):
            parse_snapshot(json.dumps(document | damaged).encode(), "s")
