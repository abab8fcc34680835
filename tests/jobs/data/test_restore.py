"""Program and data of one PLC into another: all that can be written is equal, or it is said what is not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import pytest

from fatektool.errors import DataError, FatektoolError, LineError, PlcError, RestoreIncomplete, UsageError
from fatektool.jobs.programs.backup import backup
from fatektool.jobs.programs.restore import RestoreOptions, RestoreResult, restore
from fatektool.program.archive import load_backup
from fatektool.program.data.compare import elements_in
from fatektool.program.data.uses import Use
from fatektool.simulator.memory import SimulatedMemory
from tests.jobs.data.filled import (
    IMAGE,
    OTHER_IMAGE,
    SMALL,
    Filled,
    disabled_of,
    fill_at_random,
    filled,
    values_of,
)
from tests.night import night, seeds
from tests.rigs import Seen, simulated

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.jobs.programs.restore import RestorePlan
    from fatektool.program.archive import Backup

WRITTEN = (Use.KEPT, Use.WORKING)


def file_of(plant: Filled) -> Backup:
    return backup(plant.plc, data=True)


def put(plant: Filled, wanted: Backup, folder: Path | None = None, **options: bool) -> RestoreResult:
    """Restore program and data, always agreed to."""
    return restore(
        plant.plc,
        wanted,
        (folder or Path("nowhere")) / "press.json",
        confirm=lambda plan, kept: True,  # noqa: ARG005
        options=RestoreOptions(**({"data": True} | options)),
        save_previous=folder is not None,
    )


def equal(plant: Filled, wanted: Backup) -> bool:
    """True if a PLC holds all of a file that can be written."""
    assert wanted.data is not None
    return (
        tuple(plant.device.pages) == wanted.program.pages
        and values_of(plant.device) == wanted.data.values
        and disabled_of(plant.device) == wanted.data.disabled
    )


# --- what goes well -------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", seeds(4, 40))
def test_one_plc_into_another(seed: int) -> None:
    spare = filled(1000 + seed, OTHER_IMAGE)
    wanted = file_of(filled(seed))
    result = put(spare, wanted)
    assert equal(spare, wanted)
    assert not result.not_taken


@pytest.mark.arithmetic
@pytest.mark.parametrize("model", ["fbs-20mc", "fbe-28mc"])
def test_whole_models(model: str) -> None:
    first, spare = simulated(model=model), simulated(model=model, program_seed=2)
    fill_at_random(first.device, 1)
    fill_at_random(spare.device, 2)
    outside = {use: values_of(spare.device, use) for use in Use if use not in {*WRITTEN, Use.SETTING}}
    wanted = backup(first.plc, data=True)
    result = put(spare, wanted, system=True)  # type: ignore[arg-type]  # it has what is used of one
    assert not result.not_taken
    assert spare.device.pages == first.device.pages
    assert values_of(spare.device, *WRITTEN, Use.SETTING) == values_of(first.device, *WRITTEN, Use.SETTING)
    assert disabled_of(spare.device) == disabled_of(first.device)
    for use, before in outside.items():
        assert values_of(spare.device, use) == before or use is Use.STATUS  # disabled relays are


def test_settings_are_written_only_if_asked_for() -> None:
    first, spare = simulated(), simulated()
    first.device.memory.registers["R"][4146] = 0x5621
    wanted = backup(first.plc, data=True)
    put(spare, wanted)  # type: ignore[arg-type]
    assert spare.device.memory.registers["R"][4146] == 0
    put(spare, wanted, system=True)  # type: ignore[arg-type]
    assert spare.device.memory.registers["R"][4146] == 0x5621


def test_equal_already_writes_nothing() -> None:
    plant = filled()
    wanted = file_of(plant)
    plant.tap.count.clear()
    put(plant, wanted)
    assert not {"42", "45", "47", "49", "50"} & plant.tap.count.keys()


def test_what_differs_alone_is_written() -> None:
    plant = filled()
    wanted = file_of(plant)
    plant.device.memory.registers["R"][3] ^= 1
    plant.tap.count.clear()
    put(plant, wanted)
    assert equal(plant, wanted)
    assert sum(plant.tap.count.get(each, 0) for each in ("45", "47", "49", "50")) == 1


def test_a_running_plc_is_stopped_and_its_last_values_are_overwritten() -> None:
    """Values that the plan found equal change until the PLC stops."""
    plant = filled(1)
    wanted = file_of(plant)
    spare = filled(2, OTHER_IMAGE)
    spare.device.running = True
    counter = spare.device.memory.registers["R"]

    def run(_: Seen) -> None:
        if spare.device.running:
            for at in range(len(counter)):
                counter[at] = (counter[at] + 1) % 0x10000

    spare.tap.before = run
    put(spare, wanted, stop=True)
    assert equal(spare, wanted)
    assert put(spare, wanted, run=True).mode_after == "run"


def test_the_safety_copy_brings_back_all(tmp_path: Path) -> None:
    spare = filled(2, OTHER_IMAGE)
    before = file_of(spare)
    result = put(spare, file_of(filled(1)), tmp_path)
    assert result.safety_backup is not None
    copy = load_backup(result.safety_backup)
    assert copy.data is not None
    assert copy.data.values == before.data.values  # type: ignore[union-attr]
    put(spare, copy, tmp_path)
    assert equal(spare, before)


def test_the_program_alone_leaves_data_alone() -> None:
    spare = filled(2, OTHER_IMAGE)
    before = values_of(spare.device)
    put(spare, file_of(filled(1)), data=False)
    assert tuple(spare.device.pages) == IMAGE.pages
    assert values_of(spare.device) == before


# --- what is refused, or does not take -------------------------------------------------------------------


def test_a_file_without_data() -> None:
    plant = filled()
    with pytest.raises(UsageError, match="the file has no data"):
        put(plant, backup(plant.plc))


def test_a_smaller_plc_is_refused_before_anything_is_read() -> None:
    wanted = file_of(filled())
    spare = filled(2, OTHER_IMAGE)
    spare.device.model = replace(SMALL, r_registers=20)
    spare.device.memory = SimulatedMemory(spare.device.model)
    with pytest.raises(DataError, match="expected at most 20 R, got 24"):
        put(spare, wanted)
    assert "4F" not in spare.tap.count


FATES = ("values_written", "values_uncertain", "values_old")


def keep_r5(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let PLCs acknowledge a write of R5 and not make it."""
    store = SimulatedMemory._store_registers

    def all_but_r5(self: SimulatedMemory, area: str, address: int, end: int, values: Any) -> None:
        kept = self.registers["R"][5]
        store(self, area, address, end, values)
        self.registers["R"][5] = kept

    monkeypatch.setattr(SimulatedMemory, "_store_registers", all_but_r5)


def test_a_value_that_does_not_take_is_named_and_the_plc_stays_in_stop(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    spare = filled(2, OTHER_IMAGE)
    wanted = file_of(filled(1))
    keep_r5(monkeypatch)
    result = put(spare, wanted, run=True)
    assert list(result.not_taken) == ["R5"]
    assert "read-only" in result.not_taken["R5"]
    assert result.mode_after == "stop"


def test_a_value_that_did_not_take_is_uncertain_if_the_line_is_lost_later(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It was acknowledged and read back as another; then the line is lost."""
    spare = filled(2, OTHER_IMAGE, retries=0)
    wanted = file_of(filled(1))
    keep_r5(monkeypatch)
    has_written = is_cut = False

    def cut(seen: Seen, answer: bytes) -> bytes:
        nonlocal has_written, is_cut
        has_written = has_written or seen.command in {"45", "47", "49"}
        is_cut = is_cut or (has_written and seen.command == "42")
        return b"" if is_cut else answer

    spare.tap.forge = cut
    with pytest.raises(RestoreIncomplete) as caught:
        put(spare, wanted)
    states = {key: [str(each) for each in elements_in(caught.value.details[key])] for key in FATES}
    assert "R5" in states["values_uncertain"]
    assert "R5" not in states["values_written"]
    assert "R4" in states["values_written"]


# --- ends half way ----------------------------------------------------------------------------------------


class Cut(Exception):  # the power, not an error
    """The end of the process."""


Ends: TypeAlias = "Callable[[list[str]], list[int]]"
"""From the commands of a restore to the requests at which it ends, counted from 1."""


def at_each(commands: list[str]) -> list[int]:
    return [*range(1, len(commands) + 1)]


def at_each_kind(commands: list[str]) -> list[int]:
    """The first of each command before the first write, then the first and the last of each row of one."""
    first_write = next(at for at, command in enumerate(commands) if command in WRITES)
    found = {commands.index(each) + 1 for each in commands[:first_write]}
    for at in range(first_write, len(commands)):
        if commands[at - 1 : at + 2] != [commands[at]] * 3:
            found.add(at + 1)
    return sorted(found)


WRITES = ("42", "45", "47", "49", "50")
ends_of = pytest.mark.parametrize("ends", [at_each_kind, night(at_each)])


def commands_of(wanted: Backup) -> list[str]:
    """The requests of a whole restore."""
    spare = filled(2, OTHER_IMAGE)
    commands: list[str] = []
    spare.tap.before = lambda seen: commands.append(seen.command)
    put(spare, wanted)
    assert len(commands) > 40
    return commands


def test_a_restore_ends_at_each_kind_of_request() -> None:
    commands = ["53", "46", "46", "53", "50", "50", "50", "4F", "42", "42", "46"]
    assert at_each_kind(commands) == [1, 2, 5, 7, 8, 9, 10, 11]


@pytest.mark.arithmetic
@ends_of
@pytest.mark.parametrize("answered", [True, False])
def test_killed_at_any_request_the_same_again_completes_it(ends: Ends, *, answered: bool) -> None:
    wanted = file_of(filled(1))
    for end in ends(commands_of(wanted)):
        spare = filled(2, OTHER_IMAGE)
        left = end

        def die(_: Seen) -> None:
            nonlocal left
            left -= 1
            if left <= 0:
                raise Cut

        setattr(spare.tap, "after" if answered else "before", die)
        with pytest.raises((Cut, RestoreIncomplete)):
            put(spare, wanted)
        spare.tap.after = spare.tap.before = lambda _: None
        put(spare, wanted)
        assert equal(spare, wanted), end


@pytest.mark.arithmetic
@ends_of
def test_cut_at_any_request_says_what_the_plc_holds(ends: Ends) -> None:
    wanted = file_of(filled(1))
    assert wanted.data is not None
    for end in ends(commands_of(wanted)[:-1]):
        spare = filled(2, OTHER_IMAGE, retries=0)
        before = file_of(spare).data
        assert before is not None
        left = end

        def cut(seen: Seen, answer: bytes) -> bytes:  # noqa: ARG001
            nonlocal left
            left -= 1
            return answer if left > 0 else b""

        spare.tap.forge = cut
        try:
            put(spare, wanted)
        except RestoreIncomplete as error:
            for key, holds in (("values_written", wanted.data), ("values_old", before)):
                for each in elements_in(error.details[key]):
                    held = value_in(spare, each.symbol, each.address)
                    assert holds.values[each.symbol][each.address] == held, (end, key, each)
        except LineError:
            assert values_of(spare.device) == before.values, end
            assert tuple(spare.device.pages) == OTHER_IMAGE.pages, end


def value_in(plant: Filled, symbol: str, at: int) -> int:
    memory = plant.device.memory
    return {**memory.registers, **memory.status}[symbol][at]


@pytest.mark.parametrize("fault", ["drop=0.05", "flip=0.05", "duplicate=0.1", "late=0.1", "lying-write=0.1"])
@pytest.mark.parametrize("seed", seeds(2, 20))
def test_faults_make_no_wrong_restore(fault: str, seed: int) -> None:
    wanted = file_of(filled(1))
    spare = filled(seed + 2, OTHER_IMAGE, faults=(fault,), retries=20)
    for _ in range(10):
        try:
            result = put(spare, wanted)
        except FatektoolError:
            continue
        if not result.not_taken:
            break
    else:
        pytest.fail("never completed")
    assert equal(spare, wanted)


@ends_of
def test_rollback_puts_both_parts_back(ends: Ends) -> None:
    wanted = file_of(filled(1))
    undone = 0
    for end in ends(commands_of(wanted)[:-1]):
        spare = filled(2, OTHER_IMAGE, retries=0)
        before = file_of(spare)
        left = end

        def fail_once(seen: Seen, answer: bytes) -> bytes:  # noqa: ARG001
            nonlocal left
            left -= 1
            return b"" if left == 0 else answer

        spare.tap.forge = fail_once
        try:
            put(spare, wanted, rollback=True)
        except (LineError, PlcError) as error:
            undone += bool(error.details.get("rolled_back"))
            assert equal(spare, before), end
        except RestoreIncomplete as error:
            pytest.fail(f"{end}: {error}")
    assert undone > 1


def test_the_plan_says_what_is_left(tmp_path: Path) -> None:
    first, spare = simulated(), simulated()
    for at, value in ((3840, 5), (3904, 6), (4128, 7), (4146, 8), (10, 9)):
        first.device.memory.registers["R"][at] = value
    shown: list[RestorePlan] = []

    def agree(plan: RestorePlan, _: Path | None) -> bool:
        shown.append(plan)
        return True

    restore(
        spare.plc,
        backup(first.plc, data=True),
        tmp_path / "press.json",
        confirm=agree,
        options=RestoreOptions(data=True),
    )
    (plan,) = shown
    assert plan.data is not None
    left = {use: [str(each) for each in elements] for use, elements in plan.data.left.items()}
    assert left == {Use.INPUT: ["R3840"], Use.OUTPUT: ["R3904"], Use.CLOCK: ["R4128"], Use.SETTING: ["R4146"]}
    assert [str(change.element) for change in plan.data.values] == ["R10"]
