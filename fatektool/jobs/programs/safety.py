"""The safety backup: the way back from a restore.

It lies beside FILE as ``FILE.safety-st01-20261122T031500Z.json`` and is never overwritten. Where nothing was
written into the PLC, it is removed again.

A restore that was killed half way leaves a program that is part old, part new. When the same restore is run
again, a backup of *that* would be no way back: so the safety backup of the first run is looked for, the one
from whose pages and FILE's all present pages come, and kept as the way back.
"""

from __future__ import annotations

import os
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import zip_longest
from typing import TYPE_CHECKING, Final

from fatektool.errors import FatektoolError
from fatektool.files.atomic import STANDARD, write_new
from fatektool.files.times import stamp
from fatektool.program.archive import load_backup

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.program.archive import Backup
    from fatektool.program.image import Program

_MOST_LOOKED_AT: Final = 100


@dataclass(slots=True)
class WayBack:
    """The old program on disk.

    Attributes:
        path: where; None if it is not saved.
        written: set when the first page is about to be written.
    """

    path: Path | None
    written: bool = False

    @property
    def name(self) -> str | None:
        """The path as text."""
        return None if self.path is None else str(self.path)

    def begin(self) -> None:
        """Take note that the next request writes a page."""
        self.written = True

    def end(self, *, proven: bool) -> None:
        """Take note that it is over. The copy is kept all the same."""


@contextmanager
def way_back(present: Backup, wanted: Program, file: Path, folder: Path | None) -> Iterator[WayBack]:
    """Have the old program on disk while a restore is agreed to and done.

    It is the safety backup of an unfinished run, or a new one. A new one is removed if it ends before
    ``written`` is True, as for a question that was answered with no: then nothing needs a way back.

    Args:
        present: the program in the PLC.
        wanted: the program that is to be restored.
        file: where that came from.
        folder: where safety backups lie; None for no way back.

    Raises:
        UsageError: the folder cannot be written.
        DataError: the disk is full or broken.
    """
    path, new = None, False
    if folder is not None:
        path = find_way_back(present.program, wanted, present.source.station, file, folder)
        if path is None:
            path, new = save_safety_backup(present, file, folder), True
    kept = WayBack(path)
    try:
        yield kept
    finally:
        if new and path is not None and not kept.written:
            with suppress(OSError):
                path.unlink()


def save_safety_backup(backup: Backup, file: Path, folder: Path) -> Path:
    """Write a safety backup under a new name; it is on disk when this returns.

    Args:
        backup: the program that is in the PLC.
        file: the file that will be restored.
        folder: where to.

    Raises:
        UsageError: the folder cannot be written.
        DataError: the disk is full or broken.
    """
    stem = f"{_stem(file)}.safety-st{backup.source.station:02}-{stamp(backup.created)}"
    return write_new(folder, stem, "json", backup.to_bytes())


def find_way_back(present: Program, wanted: Program, station: int, file: Path, folder: Path) -> Path | None:
    """The safety backup of an unfinished restore of the same file, if the PLC holds such a half.

    Args:
        present: the program in the PLC.
        wanted: the program that is to be restored.
        station: the PLC's station.
        file: where ``wanted`` came from.
        folder: where safety backups lie.
    """
    pattern = f".safety-st{station:02}-"
    try:
        names = [
            path for path in folder.iterdir() if path.name.startswith(_stem(file)) and pattern in path.name
        ]
    except OSError:
        return None
    for path in sorted(names, reverse=True)[:_MOST_LOOKED_AT]:
        try:
            old = load_backup(path).program
        except FatektoolError:
            continue  # somebody's damaged file is no way back, and no reason to stop
        if old == present or old.ladder_words != present.ladder_words:
            continue
        if len(old.pages) != len(present.pages):
            continue
        pages = zip_longest(present.pages, old.pages, wanted.pages)
        if all(page in {before, after} for page, before, after in pages):
            return path
    return None


def _stem(file: Path) -> str:
    name = "stdin" if str(file) == STANDARD else file.name.removesuffix(".json")
    stem = os.fsencode(name)
    return stem[:150].decode(errors="ignore")  # 255 bytes is all, and the rest of the name needs room too
