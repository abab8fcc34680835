from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.simulator.build import build_simulation
from tests.plant import Plant

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli


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
