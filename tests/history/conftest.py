from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.history.books import Book

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def book(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Book:
    """A history in a folder of its own, and no settings of the one who runs the tests."""
    for name in (
        "FATEKTOOL_HISTORY",
        "GIT_SSH_COMMAND",
        "GIT_SSH",
        "GIT_DIR",
        "http_proxy",
        "https_proxy",
        "all_proxy",
    ):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.setenv("GIT_CONFIG_NOSYSTEM", "1")
    monkeypatch.chdir(tmp_path)
    return Book(tmp_path / "plc-history")
