"""An inventory, read from its file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.files.atomic import read_bounded
from fatektool.inventory.entries import Inventory, parse_inventory

if TYPE_CHECKING:
    from pathlib import Path

MAX_INVENTORY: Final = 16 << 20
"""No file of more bytes is read."""


def load_inventory(path: Path) -> Inventory:
    """Read an inventory, and whatever is wrong with it.

    Raises:
        UsageError: there is no such file.
        DataError: it is far too large.
    """
    return parse_inventory(read_bounded(path, MAX_INVENTORY), path)
