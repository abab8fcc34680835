from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from tests.cli.running import Cli, Press

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of its own to work in, with locks of its own."""
    locks, work = tmp_path / "locks", tmp_path / "work"
    locks.mkdir()
    work.mkdir()
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(locks))
    for name in ("FATEKTOOL_PORT", "FATEKTOOL_TRACEBACK"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(work)
    before = signal.getsignal(signal.SIGTERM)
    yield work
    signal.signal(signal.SIGTERM, before)


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str]) -> Cli:
    return Cli(capsys)


@pytest.fixture
def press(place: Path, monkeypatch: pytest.MonkeyPatch) -> Press:
    """A simulated PLC of 400 words whose memory lies in a file, named in the environment."""
    made = Press(place)
    monkeypatch.setenv("FATEKTOOL_PORT", made.target)
    return made
