from __future__ import annotations

from tests.cli.conftest import cli, place
from tests.cli.many.conftest import no_inventory_but_ours
from tests.cli.many.fleet.conftest import plant

__all__ = ["cli", "no_inventory_but_ours", "place", "plant"]
