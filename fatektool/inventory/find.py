"""Find the file of the inventory, and distinguish names of PLCs from ports."""

from __future__ import annotations

import os
import re
import sys
from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from fatektool.inventory.entries import Inventory, PlcEntry

FILE_NAME: Final = "fatek.toml"
VARIABLE: Final = "FATEKTOOL_INVENTORY"
_NO_NAME: Final = re.compile(r"COM\d+|.*[:/\\\0].*", re.ASCII | re.IGNORECASE | re.DOTALL)


def may_be_name(word: str) -> bool:
    """False for a word that can only be a port: with a scheme, a slash or a backslash, or COM3."""
    return bool(word.strip()) and not _NO_NAME.fullmatch(word)


def find_inventory(named: Path | None, places: Iterable[Path]) -> Path | None:
    """The file that the user gave, else the first of the usual files that exists.

    Args:
        named: given by the user; it need not exist.
        places: the usual files.
    """
    return named or next((place for place in places if place.is_file()), None)


def inventory_path(named: Path | None) -> Path | None:
    """The file of the inventory; None if there is none.

    It is the one given, else the one that the environment names, else that in the current folder, else that
    in the user's configuration folder.
    """
    from pathlib import Path

    if named is None and os.environ.get(VARIABLE):
        named = Path(os.environ[VARIABLE])
    return find_inventory(named, (Path(FILE_NAME), Path(configuration_folder()) / FILE_NAME))


def configuration_folder() -> str:
    """The user's folder for the settings of this program, as each system has it."""
    if sys.platform == "win32":
        base = os.environ.get("APPDATA") or "~"
    elif sys.platform == "darwin":
        base = "~/Library/Application Support"
    else:
        base = os.environ.get("XDG_CONFIG_HOME", "~/.config")
    return os.path.join(os.path.expanduser(base), "fatektool")  # noqa: PTH111, PTH118  # no pathlib for a port


def no_inventory() -> UsageError:
    """The error if there is no inventory."""
    return UsageError(
        "no inventory found",
        hint=f"give --inventory FILE, set {VARIABLE}, put {FILE_NAME} into the current folder, "
        "or create one with 'fatektool inventory add'",
    )


def whole_inventory(path: Path) -> Inventory:
    """Read an inventory, which must have no faults.

    Raises:
        UsageError: the file does not exist or cannot be read.
        DataError: it has faults.
    """
    from fatektool.inventory.load import load_inventory

    found = load_inventory(path)
    found.require_whole()
    return found


def plc_named(word: str, named: Path | None) -> PlcEntry | None:
    """The PLC of the inventory that a target names; None if it is a port.

    Args:
        word: the target.
        named: the inventory that the user gave; None for the usual one.

    Raises:
        UsageError: it can only be a name, and is not in the inventory.
        DataError: the inventory has faults.
    """
    if not may_be_name(word):
        return None
    path = inventory_path(named)
    if path is None:
        return None
    found = whole_inventory(path)
    if word not in found.plcs and os.path.lexists(word):
        return None
    try:
        return found.named(word)
    except UsageError as error:
        from fatektool.transport.nearly import meant

        error.hint = meant(word) or error.hint
        raise
