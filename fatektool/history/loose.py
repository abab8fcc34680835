"""Loose objects: a file each, as git stores what is new.

::

    objects/1c/fe93ed61398c6d2d…      zlib of: kind, space, length, 00, data; named by the SHA-1 of that
"""

from __future__ import annotations

import contextlib
import hashlib
import secrets
import zlib
from typing import TYPE_CHECKING, Final

from fatektool.files.atomic import sync_folder, write_synced

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.history.sharing import Rights

TEMPORARY: Final = "tmp_obj_fatektool-"


def hash_of(kind: str, data: bytes) -> str:
    """What git calls an object: 40 hex digits."""
    return hashlib.sha1(_whole(kind, data), usedforsecurity=False).hexdigest()


def read_loose(folder: Path, sha: str) -> tuple[str, bytes] | None:
    """An object's kind and data; None if there is no such file, or it is not what its name says.

    Args:
        folder: the repository.
        sha: 40 hex digits.
    """
    try:
        whole = zlib.decompress((folder / "objects" / sha[:2] / sha[2:]).read_bytes())
    except (OSError, zlib.error):
        return None
    if hashlib.sha1(whole, usedforsecurity=False).hexdigest() != sha:
        return None
    head, _, data = whole.partition(b"\0")
    kind, _, length = head.decode("ascii", "replace").partition(" ")
    return (kind, data) if length == str(len(data)) else None


def write_loose(folder: Path, kind: str, data: bytes, rights: Rights) -> str:
    """Put an object on disk; one that is there anew, as it may be damaged or about to go.

    Args:
        folder: the repository.
        kind: ``commit``, ``tree`` or ``blob``.
        data: its bytes.
        rights: what its file and folder are for others.

    Returns:
        its hash, 40 hex digits.

    Raises:
        OSError: the disk is full or broken.
    """
    sha = hash_of(kind, data)
    place = folder / "objects" / sha[:2]
    if not place.is_dir():
        rights.make_folder(place)
        sync_folder(place.parent)
    temporary = place / f"{TEMPORARY}{secrets.token_hex(6)}"
    try:
        write_synced(temporary, zlib.compress(_whole(kind, data)))
        rights.give(temporary)
        temporary.replace(place / sha[2:])
        sync_folder(place)
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
    return sha


def _whole(kind: str, data: bytes) -> bytes:
    return f"{kind} {len(data)}\0".encode() + data
