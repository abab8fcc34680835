"""The safety backup: named so that it replaces nothing, found again after an unfinished restore."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.jobs.programs.restore import RestoreResult, restore
from fatektool.jobs.programs.safety import SafetyBackup, find_safety_backup, save_safety_backup
from fatektool.program.archive import load_backup, save_backup
from fatektool.program.image import Program
from tests.program.samples import backup, program
from tests.rigs import Bench

if TYPE_CHECKING:
    from pathlib import Path

PAGES = 8
OLD, NEW = program(400, seed=1), program(400, seed=2)


def half(*new: int) -> Program:
    return Program(400, tuple(NEW.pages[n] if n in new else OLD.pages[n] for n in range(PAGES)))


def find(place: Path, present: Program, **others: Any) -> Path | None:
    known: dict[str, Any] = {"wanted": NEW, "station": 1, "file": place / "press.json", "folder": place}
    return find_safety_backup(present, **known | others)


def test_the_way_back_is_found_among_foreign_and_damaged_files(tmp_path: Path) -> None:
    mine = save_safety_backup(backup(OLD), tmp_path / "press.json", tmp_path)
    stem = mine.name.removesuffix(".json")
    (tmp_path / f"{stem}-7.json").write_text("{")
    (tmp_path / f"{stem}-8.json").write_bytes(mine.read_bytes()[:-200])
    (tmp_path / f"{stem}-9.json").mkdir()
    (tmp_path / f"{stem}-a.json").symlink_to("nowhere")
    save_backup(backup(program(400, seed=3)), tmp_path / f"{stem}-b.json")
    save_backup(backup(program(500)), tmp_path / f"{stem}-c.json")
    save_backup(backup(OLD), tmp_path / "other.json")
    assert find(tmp_path, half(1, 2, 3)) == mine
    assert find(tmp_path, half(7)) == mine


def test_what_is_no_half_has_no_way_back(tmp_path: Path) -> None:
    save_safety_backup(backup(OLD), tmp_path / "press.json", tmp_path)
    assert find(tmp_path, OLD) is None  # nothing was written yet
    assert find(tmp_path, program(400, seed=3)) is None
    assert find(tmp_path, program(500)) is None
    assert find(tmp_path, half(1), station=2) is None
    assert find(tmp_path, half(1), file=tmp_path / "door.json") is None
    assert find(tmp_path, half(1), folder=tmp_path / "missing") is None


@pytest.mark.parametrize("new", [(1,), (1, 2, 3)])
def test_the_copy_of_a_recorded_restore_is_used_again(tmp_path: Path, new: tuple[int, ...]) -> None:
    mine = save_safety_backup(backup(OLD), tmp_path / "press.json", tmp_path)
    again = SafetyBackup(backup(half(*new)), NEW, tmp_path / "press.json", tmp_path, earlier=mine)
    assert again.find(tmp_path) == mine
    assert again.doubts == ()
    elsewhere = replace(again, present=backup(program(400, seed=3)))
    assert elsewhere.find(tmp_path) is None  # another PLC, or another program
    assert replace(again, earlier=tmp_path / "missing.json").find(tmp_path) is None


def test_a_version_between_two_others_is_no_half_restore(tmp_path: Path) -> None:
    """Of three versions the middle one has only pages of the first and the last: it is saved all the same."""
    first, middle, last = OLD, half(1), half(1, 6)
    bench, file = Bench(first), tmp_path / "press.json"

    def put(wanted: Program) -> RestoreResult:
        return restore(bench.plc, backup(wanted), file, confirm=lambda *_: True)

    assert put(last).warnings == ()
    bench.device.pages[:] = middle.pages  # by the vendor's program
    result = put(last)
    assert bench.pages == last.pages
    assert result.safety_backup is not None
    assert load_backup(result.safety_backup).program == middle
    (oldest,) = {*map(str, tmp_path.iterdir())} - {result.safety_backup}
    (warning,) = result.warnings
    assert warning.startswith(
        f"the PLC had pages of FILE and pages of {oldest}: if a restore was interrupted"
    )


def test_safety_backups_never_replace_one_another(tmp_path: Path) -> None:
    kept = backup(OLD)
    paths = [save_safety_backup(kept, tmp_path / "press.json", tmp_path) for _ in range(3)]
    assert [path.name for path in paths] == [
        "press.safety-st01-20261122T031500Z.json",
        "press.safety-st01-20261122T031500Z-2.json",
        "press.safety-st01-20261122T031500Z-3.json",
    ]


@pytest.mark.parametrize("name", ["x" * 250, "塔" * 80, "é" * 120, "塔" * 80 + ".json"])
def test_a_long_file_name_leaves_room_for_the_safety_backup(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    file.write_bytes(b"")  # the system takes this name
    path = save_safety_backup(replace(backup(OLD)), file, tmp_path)
    assert load_backup(path).program == OLD
    assert find(tmp_path, half(2), file=file) == path
