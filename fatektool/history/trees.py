"""What stands in a tree, taken from its bytes.

::

    100644 press.json 00 <20 bytes: hash>  100644 saw.json 00 …      in order of the names, one a PLC

With 1000 PLCs a tree has 1000 entries, and the one after it 999 of the same. So nothing is taken apart but
what is asked for: one name, or the entries in which two trees differ.
"""

from __future__ import annotations

import re
from bisect import insort
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.history.names import file_of, name_of

if TYPE_CHECKING:
    from collections.abc import Iterable

FOLDER: Final = 0o040000
SUBMODULE: Final = 0o160000
_FOLDER: Final = b"40000 "
_PLAIN_FILES: Final = (b"100644", b"100755", b"100664")
_ENTRY: Final = re.compile(rb"[0-7]{5,6} [^\0]+\0.{20}", re.DOTALL)
_HASH_BYTES: Final = 20


class Item(NamedTuple):
    """One entry of a tree: its mode, its path in the tree, its object's hash in 40 hex digits."""

    mode: int
    path: bytes
    sha: str


def entries(tree: bytes) -> list[bytes]:
    """The entries of a tree, each as it stands there.

    Raises:
        ValueError: it has something else in it.
    """
    found: list[bytes] = _ENTRY.findall(tree)
    if sum(map(len, found)) != len(tree):
        raise ValueError("a tree with something else than entries in it")
    return found


def item(entry: bytes) -> Item:
    """An entry, taken apart."""
    mode, _, path = entry[: -_HASH_BYTES - 1].partition(b" ")
    return Item(int(mode, 8), path, entry[-_HASH_BYTES:].hex())


def files(found: Iterable[bytes]) -> dict[str, str]:
    """The PLCs' files among these entries: name and blob. What else somebody put there is left out."""
    parts = ((entry[:6], name_of(entry[7 : -_HASH_BYTES - 1]), entry) for entry in found)
    return {
        name: entry[-_HASH_BYTES:].hex()
        for mode, name, entry in parts
        if name is not None and mode in _PLAIN_FILES
    }


def file_in(tree: bytes, name: str) -> str | None:
    """One PLC's blob in a tree; None if it is not in it.

    It is looked for, not counted to: a hash that held mode and name would be taken for the entry. By chance
    that is one tree in 2^96, for the shortest name.
    """
    wanted = b" %b\0" % file_of(name)
    at = tree.find(wanted)
    while at >= 0:
        if tree[at - 6 : at] in _PLAIN_FILES:
            start = at + len(wanted)
            return tree[start : start + _HASH_BYTES].hex()
        at = tree.find(wanted, at + 1)
    return None


def with_file(tree: bytes, name: str, sha: str) -> bytes:
    """The tree with one PLC's blob put in, in place of what has its name.

    Raises:
        ValueError: it is no tree.
    """
    file = file_of(name)
    found = [each for each in entries(tree) if _path(each) != file]
    insort(found, b"100644 %b\0%b" % (file, bytes.fromhex(sha)), key=_order)
    return b"".join(found)


def _path(entry: bytes) -> bytes:
    return entry[entry.index(b" ") + 1 : -_HASH_BYTES - 1]


def _order(entry: bytes) -> bytes:
    """Git's order: by name, a folder's as if it ended with a slash."""
    return _path(entry) + b"/" if entry.startswith(_FOLDER) else _path(entry)
