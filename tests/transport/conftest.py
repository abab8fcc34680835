from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.parts.conftest import pyserial_in_a_hurry

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["pyserial_in_a_hurry"]


@pytest.fixture(autouse=True)
def lock_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for lock files of this test alone."""
    folder = tmp_path / "locks"
    folder.mkdir(exist_ok=True)
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(folder))
    return folder
