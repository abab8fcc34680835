"""Loose objects: a file each, as git stores what is new.

::

    objects/1c/fe93ed61398c6d2d…      zlib of: kind, space, length, 00, data; named by the SHA-1 of that

dulwich makes the bytes of the file, and the file is written here. dulwich's ``add_object`` keeps a damaged
file that has the object's name: a backup would count as recorded and be lost. It does not sync the folder.
If it is killed it leaves a lock which ``git fsck`` reports as an error, and at which the next write of that
object stops. Objects are read here too: dulwich parses each tree that it reads, which takes 3.5 times as long
with 1000 PLCs.
"""

from __future__ import annotations

import contextlib
import hashlib
import secrets
import zlib
from typing import TYPE_CHECKING, Final

from fatektool.files.atomic import sync_folder, write_synced
from fatektool.system.renaming import replace_file

if TYPE_CHECKING:
    from pathlib import Path

    from dulwich.objects import ShaFile

    from fatektool.history.sharing import Rights

TEMPORARY: Final = "tmp_obj_fatektool-"


def read_loose(folder: Path, sha: str) -> tuple[str, bytes] | None:
    """Read an object: its kind and data. None if the file does not exist or does not match its hash.

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
    """Write an object to disk. An existing file is replaced: it may be damaged, or ``git gc`` may delete it.

    Args:
        folder: the repository.
        new: the object.
        rights: the permissions of its file and folder.

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
        replace_file(temporary, place)
        sync_folder(place.parent)
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
    return sha


def _place(folder: Path, sha: str) -> Path:
    return folder / "objects" / sha[:2] / sha[2:]
