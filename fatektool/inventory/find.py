"""Which file is the inventory, and whether a word names a PLC in it."""

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
    """False for what can only be a port: with a scheme, a slash or a backslash, or COM3."""
    return bool(word.strip()) and not _NO_NAME.fullmatch(word)


def find_inventory(named: Path | None, places: Iterable[Path]) -> Path | None:
    """The file that is named, else the first that is there.

    Args:
        named: by the user; it need not be there.
        places: where one may lie.
    """
    return named or next((place for place in places if place.is_file()), None)


def no_inventory() -> UsageError:
    """The error of having none."""
    return UsageError(
        "no inventory found",
        hint=f"name one with --inventory or FATEKTOOL_INVENTORY, put {FILE_NAME} here, "
        "or begin one with 'fatektool inventory add'",
    )
