from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from fatektool.simulator.build import build_simulation
from tests.cli.running import Cli
from tests.plant import Plant

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of its own to work in, with locks of its own."""
    locks, work = tmp_path / "locks", tmp_path / "work"
    locks.mkdir()
    work.mkdir()
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(locks))
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
def fbs(place: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> Plant:
    """A simulated FBs, which has D4043 to D4052, named in the environment."""
    build_simulation(model="fbs-20mc", ladder_words=64, state=place / "fbs.state")
    made = Plant(place, cli, "fbs.state")
    monkeypatch.setenv("FATEKTOOL_PORT", made.target)
    return made


@pytest.fixture
def fb(place: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> Plant:
    """A simulated FBE, which has no D past D3071."""
    made = Plant(place, cli)
    monkeypatch.setenv("FATEKTOOL_PORT", made.target)
    return made
