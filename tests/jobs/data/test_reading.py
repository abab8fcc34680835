"""The data of a PLC, read: all of it, twice where that proves something, whatever the line does."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import DataError, NoAnswer
from fatektool.jobs.data.reading import read_data
from fatektool.program.data.uses import CONSTANT, SYMBOLS, Use, use_of, uses_of
from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.refusal import Refusal, RefusalCode
from tests.jobs.data.filled import SMALL, Filled, disabled_of, fill_at_random, filled, values_of
from tests.plant import with_holes
from tests.rigs import Seen, simulated

if TYPE_CHECKING:
    from fatektool.program.data.part import DataPart
    from fatektool.simulator.elements import SymbolKind


def data_of(plant: Filled) -> DataPart:
    return read_data(plant.plc, plant.plc.detailed_status())


@pytest.mark.parametrize("seed", range(1, 6))
def test_everything_is_read(seed: int) -> None:
    plant = filled(seed)
    found = data_of(plant)
    assert found.values == values_of(plant.device)
    assert found.disabled == disabled_of(plant.device)
    assert (found.moving, found.errors, found.running) == ((), {}, False)


def test_a_whole_model_with_file_registers() -> None:
    made = simulated(model="fbs-20mc")
    fill_at_random(made.device, 3)
    found = read_data(made.plc, made.plc.detailed_status())
    assert found.values == values_of(made.device)
    assert found.counts == {"R": 8072, "D": 4096, "F": 8192, "RT": 256, "RC": 256, "M": 2002, "S": 1000}


@pytest.mark.parametrize("count", [1023, 1024, 1025, 2049])
def test_no_element_is_lost_between_two_steps(count: int) -> None:
    """Elements are read some 1000 at a time; the last step may have a single one."""
    device = SimulatedPlc(1, replace(SMALL, r_registers=count, f_registers=count))
    fill_at_random(device, count)
    made = simulated()
    made.simulation.plcs[1] = device
    found = read_data(made.plc, made.plc.detailed_status())
    assert found.counts["R"] == found.counts["F"] == count
    assert found.values == values_of(device)


@pytest.mark.parametrize("fault", ["drop=0.1", "flip=0.1", "late=0.1", "duplicate=0.1"])
def test_a_bad_line_makes_no_wrong_value(fault: str) -> None:
    plant = filled(2, faults=(fault,), retries=20)
    found = data_of(plant)
    assert found.values == values_of(plant.device)
    assert found.disabled == disabled_of(plant.device)


def test_a_value_that_changes_is_marked() -> None:
    """It is that of the third reading, the last request for registers before those for disabled discretes."""
    plant = filled()
    counted = plant.device.memory.registers["R"]

    def count(seen: Seen) -> None:
        if seen.command in {"46", "48"} and "43" not in plant.tap.count:
            counted[7] = (counted[7] + 1) % 0x10000

    plant.tap.before = count
    found = data_of(plant)
    assert found.moving == ("R7",)
    assert found.values["R"][7] == counted[7]


def test_what_is_refused_in_one_reading_alone_has_a_value_and_no_reason() -> None:
    holes = {10, 500}
    made = with_holes(holes)

    def mend(phase: str, _done: int, _total: int) -> None:
        if "pass 2" in phase:
            holes.discard(500)

    found = read_data(made.plc, made.plc.detailed_status(), mend)
    assert [at for at, value in enumerate(found.values["R"]) if value is None] == [10]
    assert list(found.errors) == ["R10"]


def test_what_is_disabled_must_hold_still() -> None:
    plant = filled()
    flags = plant.device.memory.disabled["M"]

    def force(seen: Seen) -> None:
        if seen.command == "43":
            flags[seen.number % len(flags)] ^= 1

    plant.tap.before = force
    with pytest.raises(DataError, match="disabled changed while it was read"):
        data_of(plant)


def test_what_is_refused_has_no_value_and_a_reason() -> None:
    made = with_holes({10, 11, 12, 500})
    found = read_data(made.plc, made.plc.detailed_status())
    missing = [at for at, value in enumerate(found.values["R"]) if value is None]
    assert missing == [10, 11, 12, 500]
    assert list(found.errors) == ["R10", "R11", "R12", "R500"]
    assert all("illegal address" in text for text in found.errors.values())


def test_a_plc_without_file_registers_is_asked_once() -> None:
    made = simulated()
    asked = []
    check = made.device.memory.check

    def counting(kind: SymbolKind, address: int, count: int) -> int:
        if kind.area == "F":
            asked.append(address)
            raise Refusal(RefusalCode.ILLEGAL_ADDRESS)
        return check(kind, address, count)

    made.device.memory.check = counting  # type: ignore[method-assign]  # to listen
    assert read_data(made.plc, made.plc.detailed_status()).counts["F"] == 0
    assert asked == [0]


def test_uses_cover_each_element_once() -> None:
    for symbol in SYMBOLS:
        for count in (0, 1, 900, 1913, 3841, 4059, 5000):
            spans = [*uses_of(symbol, count)]
            covered = [at for span in spans for at in range(span.first, span.last + 1)]
            assert covered == [*range(count)]
            assert all(use_of(symbol, at) is span.use for span in spans for at in (span.first, span.last))


K, W, SET, STATUS = Use.KEPT, Use.WORKING, Use.SETTING, Use.STATUS
CHANGES = {
    "R": {
        0: K, 3000: W, 3840: Use.INPUT, 3904: Use.OUTPUT, 3968: SET, 4058: STATUS, 4060: SET, 4128: Use.CLOCK,
        4136: SET, 4168: K,
    },
    "D": {0: K, 4000: SET, 4045: STATUS, 4053: SET, 4096: K},
    "F": {0: K},
    "RT": {0: W},
    "RC": {0: K, 140: W, 200: K, 240: W, 256: K},
    "M": {
        0: W, 800: K, 1400: W, 1912: STATUS, 1956: SET, 1957: STATUS, 1958: SET, 1960: STATUS, 1967: SET,
        1968: STATUS, 2002: K,
    },
    "S": {0: W, 500: K},
}  # fmt: skip
"""From which element on the use is another, as the manual has it [E:kept]."""


def test_uses_as_the_manual_says() -> None:
    for symbol, changes in CHANGES.items():
        uses = [use_of(symbol, at) for at in range(6000)]
        found = {at: use for at, use in enumerate(uses) if at == 0 or uses[at - 1] is not use}
        assert found == changes, symbol
    assert set(CHANGES) == set(SYMBOLS)
    assert Use.KEPT in CONSTANT
    assert Use.WORKING not in CONSTANT


def test_silence_to_file_registers_is_none_of_them() -> None:
    plant = filled()
    plant.tap.forge = lambda seen, answer: b"" if is_of_f(plant) and seen.command == "46" else answer
    assert data_of(plant).counts["F"] == 0


def is_of_f(plant: Filled) -> bool:
    return plant.tap.last[7:8] == b"F"


@pytest.mark.parametrize("lost", range(1, 12))
def test_a_lost_line_is_no_plc_without_file_registers(lost: int) -> None:
    """Silence that begins at any request of the search ends the reading, or changes nothing."""
    plant = filled(1, retries=0)
    asked = 0

    def silent(seen: Seen, answer: bytes) -> bytes:
        nonlocal asked
        asked += seen.command == "46" and is_of_f(plant)
        return b"" if asked == lost else answer

    plant.tap.forge = silent
    try:
        found = data_of(plant)
    except NoAnswer:
        return
    assert found.values == values_of(plant.device)
