"""What makes a backup reliable: it has a program, it is complete, and it is not too old."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError, UsageError
from fatektool.program.archive import load_backup, save_backup
from fatektool.program.data.compare import data_change
from fatektool.program.headers.header import PAGE_BYTES

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from fatektool.program.archive import Backup
    from fatektool.program.image import Program

_BACKUP: Final = b'"fatektool.backup/'
_LOOKED_AT: Final = 200


def require_ladder(program: Program) -> None:
    """Refuse an image without a program: after a valid header all bytes are the same.

    A PLC that lost its memory has such an image. Saved every night, it would replace the good backup.

    Raises:
        DataError: there is no ladder in it.
    """
    ladder = program.data[program.header.code_page * PAGE_BYTES :]
    if ladder == ladder[:1] * len(ladder):
        raise DataError(
            f"the program is empty: every byte of its ladder is {ladder[0]:02X}",
            hint="check the memory of the PLC; 'fatektool backup' saves an image that is meant to be empty",
        )


def former_backup(path: Path) -> Backup | None:
    """The backup that is about to be replaced; None if there is no file.

    Raises:
        DataError: it is damaged.
        UsageError: it is no backup at all, and must not be replaced.
    """
    if not path.exists():
        return None
    try:
        return load_backup(path)
    except DataError as error:
        with path.open("rb") as file:
            start = file.read(_LOOKED_AT)
        if start.strip() and _BACKUP not in start:
            raise UsageError(
                f"{path} is not a backup and is not replaced", hint="name another folder", file=str(path)
            ) from error
        raise


@dataclass(frozen=True, slots=True)
class Replaced:
    """A backup that took the place of the one before.

    Attributes:
        changed: True if the program, or data that ought to be constant, are other than before; None where
            there was no backup before.
        damaged: why the one before could not be read; None if it could, or was not there.
    """

    changed: bool | None
    damaged: str | None = None


def replace_backup(backup: Backup, path: Path, keep: Sequence[str] = ()) -> Replaced:
    """Write a backup in place of the one before. One that is damaged is replaced too.

    Args:
        backup: the new one.
        path: the file, which need not be there.
        keep: globs of the elements whose data ought to be constant; none for the default.

    Raises:
        UsageError: the file is no backup at all, or has data and the new one has none, and is kept; or it
            cannot be written.
        DataError: the disk is full or broken.
    """
    try:
        before = former_backup(path)
    except DataError as error:  # to replace it by a good one is what helps
        save_backup(backup, path, overwrite=True)
        return Replaced(None, error.message)
    if before is not None and before.data is not None and backup.data is None:
        raise UsageError(
            f"{path} has the PLC's data too, and is not replaced by the program alone",
            hint="add --data, or name another folder",
            file=str(path),
        )
    save_backup(backup, path, overwrite=True)
    if before is None:
        return Replaced(None)
    data = data_change(before.data, backup.data, keep)
    return Replaced(before.program != backup.program or data is not None)


def age_s(backup: Backup, now: datetime) -> float:
    """How old a backup is, in seconds; below 0 if it is of the future, which is a clock's fault."""
    created = datetime.fromisoformat(backup.created).astimezone(UTC)
    return (now - created).total_seconds()
