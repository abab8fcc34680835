from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.cli.conftest import cli, place

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["cli", "place"]


@pytest.fixture(autouse=True)
def no_inventory_but_ours(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The user's own is none of a test's."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(place.parent / "config"))
    monkeypatch.setenv("APPDATA", str(place.parent / "config"))
    monkeypatch.setenv("HOME", str(place.parent / "home"))
    monkeypatch.delenv("FATEKTOOL_INVENTORY", raising=False)
