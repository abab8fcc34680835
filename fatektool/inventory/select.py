"""Select PLCs by name, by tag, or by a pattern of names."""

from __future__ import annotations

from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.inventory.entries import Inventory, PlcEntry


def select(inventory: Inventory, words: Iterable[str] = ()) -> list[PlcEntry]:
    """The PLCs that match one of the words, in the order of the file; all if there are no words.

    Args:
        inventory: the PLCs.
        words: each a name, a tag or a glob of names: ``hall1-*``.

    Raises:
        UsageError: a word matches no PLC, or the inventory is empty.
    """
    wanted = list(words)
    for word in wanted:
        if not any(_means(word, entry) for entry in inventory.plcs.values()):
            tags = sorted({tag for entry in inventory.plcs.values() for tag in entry.tags})
            known = f"; tags are {', '.join(tags)}" if tags else ""
            raise UsageError(
                f"--select {word!r}: no PLC has this name or tag in {inventory.file}{known}",
                hint="see 'fatektool inventory list'",
            )
    found = [
        entry
        for entry in inventory.plcs.values()
        if not wanted or any(_means(word, entry) for word in wanted)
    ]
    if not found:
        raise UsageError(
            f"no PLC in the inventory {inventory.file}", hint="add one with 'fatektool inventory add'"
        )
    return found


def _means(word: str, entry: PlcEntry) -> bool:
    return word == entry.name or word in entry.tags or fnmatchcase(entry.name, word)
