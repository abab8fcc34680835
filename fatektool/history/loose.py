"""Loose objects: a file each, as git stores what is new.

::

    objects/1c/fe93ed61398c6d2d…      zlib of: kind, space, length, 00, data; named by the SHA-1 of that

What is written has dulwich's form, and is written here. dulwich's ``add_object`` keeps a damaged file that
has the object's name, so that a backup counts as recorded and is lost; it syncs no folder; killed, it leaves
a lock that ``git fsck`` reports and the next write of that object stops at. And it is read here: dulwich
parses each tree as it reads it, which takes 3.5 times as long with 1000 PLCs.
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

    from dulwich.objects import ShaFile

    from fatektool.history.sharing import Rights

TEMPORARY: Final = "tmp_obj_fatektool-"


def read_loose(folder: Path, sha: str) -> tuple[str, bytes] | None:
    """An object's kind and data; None if there is no such file, or it is not what its name says.

    Args:
        folder: the repository.
        sha: 40 hex digits.
    """
    try:
        whole = zlib.decompress(_place(folder, sha).read_bytes())
    except (OSError, zlib.error):
        return None
    if hashlib.sha1(whole, usedforsecurity=False).hexdigest() != sha:
        return None
    head, _, data = whole.partition(b"\0")
    kind, _, length = head.decode("ascii", "replace").partition(" ")
    return (kind, data) if length == str(len(data)) else None


def write_loose(folder: Path, new: ShaFile, rights: Rights) -> str:
    """Put an object on disk; one that is there anew, as it may be damaged or about to go.

    Args:
        folder: the repository.
        new: the object.
        rights: what its file and folder are for others.

    Returns:
        its hash, 40 hex digits.

    Raises:
        OSError: the disk is full or broken.
    """
    sha = new.id.decode()
    place = _place(folder, sha)
    if not place.parent.is_dir():
        rights.make_folder(place.parent)
        sync_folder(place.parent.parent)
    temporary = place.with_name(f"{TEMPORARY}{secrets.token_hex(6)}")
    try:
        write_synced(temporary, new.as_legacy_object())
        rights.give(temporary)
        temporary.replace(place)
        sync_folder(place.parent)
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
    return sha


def _place(folder: Path, sha: str) -> Path:
    return folder / "objects" / sha[:2] / sha[2:]
