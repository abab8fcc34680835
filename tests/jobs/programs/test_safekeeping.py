"""A backup takes the place of the one before."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.errors import UsageError
from fatektool.jobs.programs.safekeeping import Replaced, replace_backup
from fatektool.program.archive import load_backup
from tests.program.samples import backup, program

if TYPE_CHECKING:
    from pathlib import Path

ONE, OTHER = (backup(program(400, seed=seed)) for seed in (1, 2))


def test_whether_the_program_is_another(tmp_path: Path) -> None:
    path = tmp_path / "press.json"
    assert replace_backup(ONE, path) == Replaced(None)
    assert replace_backup(ONE, path) == Replaced(changed=False)
    assert replace_backup(OTHER, path) == Replaced(changed=True)
    assert load_backup(path).program == OTHER.program


def test_a_damaged_backup_is_replaced(tmp_path: Path) -> None:
    path = tmp_path / "press.json"
    path.write_bytes(ONE.to_bytes()[:-99])
    replaced = replace_backup(ONE, path)
    assert replaced.changed is None
    assert replaced.damaged is not None
    assert replaced.damaged.startswith(f"{path}: ")
    assert load_backup(path).program == ONE.program


def test_what_is_no_backup_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "press.json"
    path.write_text('{"mine": 1}')
    with pytest.raises(UsageError, match="is not a backup and is not replaced"):
        replace_backup(ONE, path)
    assert path.read_text() == '{"mine": 1}'
