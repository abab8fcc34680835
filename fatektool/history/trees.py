"""The PLCs' files in a tree. dulwich parses and writes trees."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

from dulwich.objects import ObjectID, Tree

from fatektool.history.names import file_of, name_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from dulwich.objects import Blob

Item: TypeAlias = tuple[bytes, int, bytes]
"""An item of a tree: path, mode, hash in 40 hex digits."""

_PLAIN: Final = 0o100644
_PLAIN_FILES: Final = (_PLAIN, 0o100755, 0o100664)


def files(items: Iterable[Item]) -> dict[str, str]:
    """The PLCs' files among these items: name and blob. Other files are left out."""
    named = ((name_of(path), sha) for path, mode, sha in items if mode in _PLAIN_FILES)
    return {name: sha.decode() for name, sha in named if name is not None}


def file_in(items: Iterable[Item], name: str) -> str | None:
    """The blob of one PLC among these items; None if it has none."""
    file = file_of(name)
    return next((sha.decode() for path, mode, sha in items if path == file and mode in _PLAIN_FILES), None)


def with_file(items: Iterable[Item], name: str, blob: Blob) -> Tree:
    """A tree of these items in which the file of one PLC is this blob."""
    tree = Tree()
    for path, mode, sha in items:
        tree.add(path, mode, ObjectID(sha))
    tree.add(file_of(name), _PLAIN, blob.id)
    return tree
