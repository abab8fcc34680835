"""Many small files into one: a thousand PLCs change some ten thousand objects a year.

New objects are a file each. When there are about a thousand they go into one pack, the pack is on disk, and
only then are the files taken away: whatever ends this, every object is there at least once.

The objects stand in a pack as they are, without deltas: finding those in Python takes longer than reading the
PLCs. ``git gc`` finds them, whenever somebody cares to run it.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from dulwich.objects import ObjectID, ShaFile

from fatektool.errors import DataError
from fatektool.history.writing import TEMPORARY
from fatektool.program.files import sync_folder

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.history.repository import Repository

MANY: Final = 1000
_REST: Final = re.compile(r"[0-9a-f]{38}")
_NUMBERS: Final = {"commit": 1, "tree": 2, "blob": 3, "tag": 4}
_FOLDERS: Final = [f"{number:02x}" for number in range(256)]
_OURS: Final = ("tmp*.pack", "*.idx.lock")  # dulwich's unfinished packs; git's begin with tmp_pack_


def is_due(repository: Repository) -> bool:
    """True if there are about ``MANY`` loose objects: one folder in 256 tells, as git itself guesses it."""
    folder = repository.folder / "objects" / "17"
    return folder.is_dir() and sum(1 for _ in folder.iterdir()) * 256 >= MANY


def pack_loose(repository: Repository) -> int:
    """Put the loose objects into a pack; the caller holds the right to write.

    A damaged one stays where it is, for ``check`` to name.

    Returns:
        how many objects were packed.

    Raises:
        DataError: the disk is full, or dulwich cannot; nothing is lost.
    """
    objects = repository.folder / "objects"
    found: list[tuple[ShaFile, str | None]] = []
    places: list[Path] = []
    with repository.door("the loose objects"):
        _sweep(objects)
        for place in _loose(objects):
            sha = place.parent.name + place.name
            try:
                kind, data = repository.any_object(sha)
            except DataError:
                continue
            found.append((ShaFile.from_raw_string(_NUMBERS[kind], data, ObjectID(sha.encode())), None))
            places.append(place)
        if not found:
            return 0
        store = repository.git.object_store
        store.fsync_object_files = True
        store.add_objects(found)
        for path in (objects / "pack").glob("pack-*"):
            path.chmod(path.stat().st_mode & 0o440)
        sync_folder(objects / "pack")
        for place in places:
            place.unlink(missing_ok=True)
    return len(found)


def _loose(objects: Path) -> list[Path]:
    folders = [objects / name for name in _FOLDERS if (objects / name).is_dir()]
    return [path for folder in folders for path in sorted(folder.iterdir()) if _REST.fullmatch(path.name)]


def _sweep(objects: Path) -> None:
    """Take away what killed runs left unfinished."""
    left = [path for name in _FOLDERS for path in (objects / name).glob(f"{TEMPORARY}*")]
    left += [path for pattern in _OURS for path in (objects / "pack").glob(pattern)]
    for path in left:
        path.unlink(missing_ok=True)
