from __future__ import annotations

from tests.history.conftest import book
from tests.inventory.conftest import no_inventory_but_ours

__all__ = ["book", "no_inventory_but_ours"]
