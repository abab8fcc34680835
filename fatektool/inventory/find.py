"""Find the file of the inventory, and distinguish names of PLCs from ports."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

FILE_NAME: Final = "fatek.toml"
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


def no_inventory() -> UsageError:
    """The error if there is no inventory."""
    return UsageError(
        "no inventory found",
        hint=f"give --inventory FILE, set FATEKTOOL_INVENTORY, put {FILE_NAME} into the current folder, "
        "or create one with 'fatektool inventory add'",
    )
