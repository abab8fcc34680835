"""The safety backup: the program that was in the PLC before a restore.

A restore that was killed half way leaves a program that is part previous, part new. When the same restore is
run again, a backup of *that* would be no use: so the safety backup of the first run is looked for, the one
from whose pages and FILE's all present pages come, and is used again.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import zip_longest
from typing import TYPE_CHECKING, ClassVar, Final

from fatektool.errors import FatektoolError
from fatektool.jobs.programs.known import KnownPages
from fatektool.jobs.write_back.safety_copy import name_of, save_copy, start_of
from fatektool.program.archive import load_backup

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.program.archive import Backup
    from fatektool.program.image import Program

_MOST_LOOKED_AT: Final = 100


@dataclass(frozen=True, slots=True)
class SafetyBackup:
    """The safety copy of a program.

    Attributes:
        present: the program in the PLC.
        wanted: the program that is to be restored.
        file: where that came from.
        folder: where safety backups go; None for none.
    """

    what: ClassVar[str] = "program"
    key: ClassVar[str] = "safety_backup"

    present: Backup
    wanted: Program
    file: Path
    folder: Path | None

    def find(self, folder: Path) -> Path | None:
        """The safety backup of an unfinished restore of the same file, if the PLC has part of it."""
        return find_safety_backup(
            self.present.program, self.wanted, self.present.source.station, self.file, folder
        )

    def save(self, folder: Path) -> Path:
        """Write a new one; it is on disk when this returns.

        Raises:
            UsageError: the folder cannot be written.
            DataError: the disk is full or broken.
        """
        return save_safety_backup(self.present, self.file, folder)


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
    return save_copy(folder, _stem(file), backup.source.station, backup.created, backup.to_bytes())


def find_safety_backup(
    present: Program, wanted: Program, station: int, file: Path, folder: Path
) -> Path | None:
    """The safety backup of an unfinished restore of the same file, if the PLC has part of it.

    Args:
        present: the program in the PLC.
        wanted: the program that is to be restored.
        station: the PLC's station.
        file: where ``wanted`` came from.
        folder: where safety backups are.
    """
    for path, old in _safety_backups(station, file, folder):
        if old == present or old.ladder_words != present.ladder_words:
            continue
        if len(old.pages) != len(present.pages):
            continue
        pages = zip_longest(present.pages, old.pages, wanted.pages)
        if all(page in {before, after} for page, before, after in pages):
            return path
    return None


def known_before_restore(wanted: Program, file: Path, folder: Path | None, station: int) -> KnownPages:
    """What is on file of the program that a PLC may have before a restore: FILE, the newest safety backup.

    Args:
        wanted: the program that is to be restored.
        file: where it came from.
        folder: where safety backups are; None for none.
        station: the PLC's station.
    """
    newest = next(_safety_backups(station, file, folder), None) if folder is not None else None
    return KnownPages((wanted,) if newest is None else (wanted, newest[1]), str(file))


def _safety_backups(station: int, file: Path, folder: Path) -> Iterator[tuple[Path, Program]]:
    """The safety backups of restores of this file, the newest first; damaged ones are left out."""
    start, pattern = start_of(_stem(file)), name_of("", station)
    try:
        names = [path for path in folder.iterdir() if path.name.startswith(start) and pattern in path.name]
    except OSError:
        return
    for path in sorted(names, reverse=True)[:_MOST_LOOKED_AT]:
        try:
            yield path, load_backup(path).program
        except FatektoolError:
            continue  # a damaged file cannot be restored, and is no reason to stop


def _stem(file: Path) -> str:
    return file.name.removesuffix(".json")
