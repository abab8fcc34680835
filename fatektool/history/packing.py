"""Many small files into one: a thousand PLCs change some ten thousand objects a year.

New objects are a file each. When there are about a thousand they go into one pack, the pack is on disk, and
only then are the files taken away: whatever ends this, every object is there at least once.

The objects stand in a pack as they are, without deltas: finding those in Python takes longer than reading the
PLCs. ``git gc`` finds them, whenever somebody cares to run it.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from dulwich.pack import UnpackedObject

from fatektool.files.atomic import sync_folder
from fatektool.history.loose import TEMPORARY, read_loose

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.history.repository import Repository

MANY: Final = 1000
_SAMPLE: Final = 16
_REST: Final = re.compile(r"[0-9a-f]{38}")
_NUMBERS: Final = {"commit": 1, "tree": 2, "blob": 3, "tag": 4}
_FOLDERS: Final = [f"{number:02x}" for number in range(256)]
_OURS: Final = ("tmp*.pack", "*.idx.lock")  # dulwich's unfinished packs; git's begin with tmp_pack_


def is_due(repository: Repository) -> bool:
    """True if there are about ``MANY`` loose objects: one folder in 16 tells, within a third of it."""
    folders = (repository.folder / "objects" / name for name in _FOLDERS[::_SAMPLE])
    return sum(1 for folder in folders if folder.is_dir() for _ in folder.iterdir()) * _SAMPLE >= MANY


def pack_loose(repository: Repository) -> int:
    """Put the loose objects into a pack; the caller holds the right to write.

    A damaged one stays where it is, for ``check`` to name.

    Returns:
        how many objects were packed.

    Raises:
        DataError: the disk is full, or dulwich cannot; nothing is lost.
    """
    objects = repository.folder / "objects"
    with repository.door("the loose objects"):
        _sweep(objects)
        places = [place for place in _loose(objects) if _read(repository, place) is not None]
        if not places:
            return 0
        store = repository.git.object_store
        store.fsync_object_files = True
        packs = objects / "pack"
        before = set(packs.glob("pack-*"))
        # Each is read again when its turn comes: a thousand at once would be some 40 MB.
        store.add_pack_data(len(places), (_unpacked(repository, place) for place in places))
        for path in set(packs.glob("pack-*")) - before:  # others may be another user's
            path.chmod(path.stat().st_mode & 0o440)
            repository.rights.give(path)
        sync_folder(packs)
        for place in places:
            place.unlink(missing_ok=True)
    return len(places)


def _read(repository: Repository, place: Path) -> tuple[str, bytes] | None:
    return read_loose(repository.folder, place.parent.name + place.name)


def _unpacked(repository: Repository, place: Path) -> UnpackedObject:
    found = _read(repository, place)
    if found is None:
        raise repository.damaged(f"{place.name} was whole and is not any more")
    kind, data = found
    sha = bytes.fromhex(place.parent.name + place.name)
    return UnpackedObject(_NUMBERS[kind], decomp_chunks=[data], sha=sha)


def _loose(objects: Path) -> list[Path]:
    folders = [objects / name for name in _FOLDERS if (objects / name).is_dir()]
    return [path for folder in folders for path in sorted(folder.iterdir()) if _REST.fullmatch(path.name)]


def _sweep(objects: Path) -> None:
    """Take away what killed runs left unfinished."""
    left = [path for name in _FOLDERS for path in (objects / name).glob(f"{TEMPORARY}*")]
    left += [path for pattern in _OURS for path in (objects / "pack").glob(pattern)]
    for path in left:
        path.unlink(missing_ok=True)
