from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.cli.conftest import cli, place
from tests.plant import Plant

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli

__all__ = ["cli", "place", "plant"]


@pytest.fixture
def plant(place: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> Plant:
    """A simulated PLC whose memory lies in a file, named in the environment."""
    made = Plant(place, cli)
    monkeypatch.setenv("FATEKTOOL_PORT", made.target)
    return made
