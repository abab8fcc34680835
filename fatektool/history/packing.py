"""Put loose objects into a pack: a thousand PLCs add some ten thousand objects a year.

New objects are a file each. When there are a thousand, dulwich writes them into one pack. When the pack is on
disk, the files are deleted. If the process ends at any step, every object exists at least once.

Which files are packed and when they are deleted is decided here: dulwich's ``pack_loose_objects`` stops at a
damaged file, holds all objects in memory, and deletes the files before the folder of the pack is synced.

The pack has no deltas: finding them in Python takes longer than reading the PLCs. ``git gc`` makes them.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from dulwich.objects import OBJECT_CLASSES
from dulwich.pack import UnpackedObject

from fatektool.files.atomic import sync_folder
from fatektool.history.loose import TEMPORARY, read_loose
from fatektool.system.renaming import remove_file

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.history.repository import Repository

MANY: Final = 1000
_UNFINISHED_S: Final = 3600  # git may be about to write the index of a newer pack
_REST: Final = re.compile(r"[0-9a-f]{38}")
_NUMBERS: Final = {kind.type_name.decode(): kind.type_num for kind in OBJECT_CLASSES}
_FOLDERS: Final = [f"{number:02x}" for number in range(256)]
_OURS: Final = ("tmp*.pack", "*.idx.lock")  # dulwich's unfinished packs; git's begin with tmp_pack_


def is_due(repository: Repository) -> bool:
    """True if there are ``MANY`` loose objects."""
    return repository.git.object_store.count_loose_objects() >= MANY


def pack_loose(repository: Repository) -> int:
    """Put the loose objects into a pack; the caller holds the lock of the history.

    A damaged object stays where it is, and ``check`` reports it.

    Returns:
        the number of packed objects.

    Raises:
        DataError: the disk is full, or dulwich failed; nothing is lost.
    """
    objects = repository.folder / "objects"
    with repository.guard("the loose objects"):
        _sweep(repository)
        places = [place for place in _loose(objects) if _read(repository, place) is not None]
        if not places:
            return 0
        store = repository.git.object_store
        store.fsync_object_files = True
        packs = objects / "pack"
        before = set(packs.glob("pack-*"))
        # Each is read again when it is written: a thousand in memory would be some 40 MB.
        store.add_pack_data(len(places), (_unpacked(repository, place) for place in places))
        for path in set(packs.glob("pack-*")) - before:  # older ones may belong to another user
            path.chmod(path.stat().st_mode & 0o440)
            repository.rights.give(path)
        sync_folder(packs)
        for place in places:
            remove_file(place)
    return len(places)


def _read(repository: Repository, place: Path) -> tuple[str, bytes] | None:
    return read_loose(repository.folder, place.parent.name + place.name)


def _unpacked(repository: Repository, place: Path) -> UnpackedObject:
    found = _read(repository, place)
    if found is None:
        raise repository.damaged(f"{place.name} was valid when it was read first, and is not any more")
    kind, data = found
    sha = bytes.fromhex(place.parent.name + place.name)
    return UnpackedObject(_NUMBERS[kind], decomp_chunks=[data], sha=sha)


def _loose(objects: Path) -> list[Path]:
    folders = [objects / name for name in _FOLDERS if (objects / name).is_dir()]
    return [path for folder in folders for path in sorted(folder.iterdir()) if _REST.fullmatch(path.name)]


def _sweep(repository: Repository) -> None:
    """Delete unfinished files of killed runs."""
    objects = repository.folder / "objects"
    left = [path for name in _FOLDERS for path in (objects / name).glob(f"{TEMPORARY}*")]
    left += [path for pattern in _OURS for path in (objects / "pack").glob(pattern)]
    for path in left:
        remove_file(path)
    repository.git.object_store.prune(_UNFINISHED_S)
