from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from fatektool import connection
from tests.cli.running import Cli, Press

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of its own to work in, with locks of its own; no pause before a connection is tried again."""
    locks, work = tmp_path / "locks", tmp_path / "work"
    locks.mkdir(exist_ok=True)
    work.mkdir()
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(locks))
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(connection, "sleep", lambda _: None)
    for name in ("FATEKTOOL_PORT", "FATEKTOOL_TRACEBACK", "COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(work)
    before = signal.getsignal(signal.SIGTERM)
    yield work
    signal.signal(signal.SIGTERM, before)


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str]) -> Cli:
    return Cli(capsys)


@pytest.fixture
def press(place: Path) -> Press:
    return Press(place)
