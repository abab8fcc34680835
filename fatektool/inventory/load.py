"""Read an inventory from its file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.files.atomic import read_bounded
from fatektool.inventory.entries import Inventory, parse_inventory

if TYPE_CHECKING:
    from pathlib import Path

MAX_INVENTORY: Final = 16 << 20
"""No file of more bytes is read."""


def load_inventory(path: Path) -> Inventory:
    """Read an inventory; faults are in its ``faults``.

    Raises:
        UsageError: the file does not exist or cannot be read.
        DataError: it is larger than ``MAX_INVENTORY``.
    """
    return parse_inventory(read_bounded(path, MAX_INVENTORY), path)
