from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.cli.conftest import cli, place
from tests.cli.many.fleet.gateway import Hall, hall
from tests.inventory.conftest import no_inventory_but_ours

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["cli", "no_inventory_but_ours", "place"]


@pytest.fixture
def plant(place: Path) -> Iterator[Hall]:
    """Three PLCs behind two doors, in an inventory in the present folder."""
    (place / "backups").mkdir()
    with hall() as made:
        yield made
