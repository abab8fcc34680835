"""The safety backup: the program that was in the PLC before a restore.

A restore that was killed half way leaves a program that is part previous, part new. When the same restore is
run again, a backup of *that* would be no use: so the safety backup of the first run, which its record names,
is used again, if all present pages come from it and FILE. Without a record the present program is saved,
whatever it is, and an older safety backup that fits is named.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import zip_longest
from typing import TYPE_CHECKING, ClassVar, Final

from fatektool.errors import FatektoolError
from fatektool.jobs.data.plan import are_data_between
from fatektool.jobs.programs.known import KnownPages
from fatektool.jobs.write_back.safety_copy import name_of, save_copy, start_of
from fatektool.program.archive import load_backup

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.program.archive import Backup
    from fatektool.program.data.part import DataPart
    from fatektool.program.image import Program

_MOST_LOOKED_AT: Final = 100


@dataclass(frozen=True, slots=True)
class SafetyBackup:
    """The safety copy of a program, and of the data if they are restored too.

    Attributes:
        present: what the PLC has.
        wanted: the program that is to be restored.
        file: where that came from.
        folder: where safety backups go; None for none.
        data: the data that are to be restored; None if they are not.
        earlier: the copy that an unfinished restore made, by its record; None if there is none.
    """

    key: ClassVar[str] = "safety_backup"

    present: Backup
    wanted: Program
    file: Path
    folder: Path | None
    data: DataPart | None = None
    earlier: Path | None = None

    @property
    def what(self) -> str:
        """What it is a copy of."""
        return "program" if self.data is None else "program and data"

    def find(self, folder: Path) -> Path | None:
        """The earlier copy, if all that the PLC has is of that copy or of the file.

        The pages alone do not prove that a restore was interrupted: of three versions of a program the middle
        one may well have the pages of the first and the last.
        """
        if self.earlier is None:
            return None
        try:
            old = load_backup(self.earlier)
        except FatektoolError:
            return None  # a damaged copy is of no use, and no reason to stop
        if not is_between(self.present.program, old.program, self.wanted):
            return None
        there = self.present.data
        if self.data is not None and (
            old.data is None or there is None or not are_data_between(there, old.data, self.data)
        ):
            return None
        beside = folder / self.earlier.name  # as the user names the folder
        return beside if beside.exists() and beside.samefile(self.earlier) else self.earlier

    @property
    def doubts(self) -> tuple[str, ...]:
        """What to say of a program that looks like half a restore of the file, without a record of one."""
        if self.folder is None or self.earlier is not None:
            return ()
        station = self.present.source.station
        found = find_safety_backup(self.present.program, self.wanted, station, self.file, self.folder)
        if found is None:
            return ()
        then = "if a restore was interrupted, the program before it is in that file"
        return (f"the PLC had pages of FILE and pages of {found}: {then}",)

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
    """The safety backup of what looks like half a restore of the same file.

    Args:
        present: the program in the PLC.
        wanted: the program that is to be restored.
        station: the PLC's station.
        file: where ``wanted`` came from.
        folder: where safety backups are.
    """
    for path, old in _safety_backups(station, file, folder):
        if old != present and is_between(present, old, wanted):
            return path
    return None


def is_between(present: Program, old: Program, wanted: Program) -> bool:
    """True if each page of a program is that of an old one or that of the one to be restored."""
    if old.ladder_words != present.ladder_words or len(old.pages) != len(present.pages):
        return False
    pages = zip_longest(present.pages, old.pages, wanted.pages)
    return all(page in {before, after} for page, before, after in pages)


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
