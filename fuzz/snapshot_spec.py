"""Snapshot specifications: a list of items, or refused in one plain line."""

from __future__ import annotations

from fatektool.errors import DataError
from fatektool.jobs.snapshots.spec import MAX_ITEMS, parse_spec
from fuzz.words import require_plain


def one_input(data: bytes) -> None:
    """Read; no two items have one name, and none has a name of more than one line."""
    try:
        found = parse_spec(data, "press.toml")
    except DataError as error:
        require_plain(error)
        return
    keys = [item.item.key for item in found.items]
    assert len(set(keys)) == len(keys) <= MAX_ITEMS
    assert all(key.isprintable() for key in keys)
