"""The safety snapshot of an unfinished write is used again if it is what was there before."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.jobs.snapshots.apply import plan_apply
from fatektool.jobs.snapshots.write_values import SafetySnapshot
from fatektool.protocol.elements import Element
from tests.plant import small, snapshot_of

if TYPE_CHECKING:
    from pathlib import Path

    from tests.rigs import Simulated

WANTED = [1, 2, 3, 4]


def plc_with(values: list[int]) -> Simulated:
    made = small()
    made.plc.write_registers(Element("R", 0), values)
    return made


def copy_of(plc: Simulated, folder: Path, earlier: Path | None = None, *elements: str) -> SafetySnapshot:
    """The safety snapshot before the wanted values are written into a PLC."""
    wanted = snapshot_of(*(elements or ("R0-R3", "DR0", "R1", "R2")), plc=plc_with(WANTED))
    return SafetySnapshot(plan_apply(plc.plc, wanted).values, "a", folder, earlier)


@pytest.fixture
def first(tmp_path: Path) -> Path:
    """What the first run saved."""
    return copy_of(plc_with([7, 7, 7, 7]), tmp_path).save(tmp_path)


@pytest.mark.parametrize(
    ("held", "found"),
    [
        ([7, 7, 7, 7], True),  # nothing was written yet
        ([1, 7, 7, 7], True),
        ([1, 2, 3, 7], True),
        ([7, 7, 3, 4], True),
        ([1, 8, 7, 7], False),  # somebody changed what was still to be written
        ([8, 2, 3, 4], False),
    ],
)
def test_it_is_used_again_if_all_that_is_left_is_as_it_was(
    first: Path, tmp_path: Path, held: list[int], *, found: bool
) -> None:
    copy = copy_of(plc_with(held), tmp_path, first)
    assert copy.find(tmp_path) == (first if found else None)


def test_nothing_is_looked_for_without_a_record(first: Path, tmp_path: Path) -> None:
    """Values are too much alike to be recognised: a copy of another day could pass for the first run's."""
    assert first.exists()
    assert copy_of(plc_with([1, 7, 7, 7]), tmp_path).find(tmp_path) is None


def test_one_that_holds_less_is_not_used(tmp_path: Path) -> None:
    less = copy_of(plc_with([7, 7, 7, 7]), tmp_path, None, "R0-R2").save(tmp_path)
    assert copy_of(plc_with([1, 7, 7, 7]), tmp_path, less).find(tmp_path) is None


@pytest.mark.parametrize("text", ["", "{}", '{"schema": "fatektool.snapshot/1"}'])
def test_a_damaged_one_is_not_used(first: Path, tmp_path: Path, text: str) -> None:
    first.write_text(text)
    assert copy_of(plc_with([1, 7, 7, 7]), tmp_path, first).find(tmp_path) is None


def test_one_that_is_gone_is_not_used(tmp_path: Path) -> None:
    assert copy_of(plc_with([1, 7, 7, 7]), tmp_path, tmp_path / "gone.json").find(tmp_path) is None


def test_it_never_replaces_a_file(first: Path, tmp_path: Path) -> None:
    copy = copy_of(plc_with([7, 7, 7, 7]), tmp_path)
    paths = [first, *(copy.save(tmp_path) for _ in range(2))]
    assert len(set(paths)) == 3
    assert all(path.name.startswith("a.safety-st01-") for path in paths)
