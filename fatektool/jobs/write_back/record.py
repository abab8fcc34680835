"""The record of a write that has begun: on disk before its first request, removed when it is complete.

::

    {"schema": "fatektool.unfinished/1", "target": "/dev/ttyUSB0", "station": 1,
     "time": "2026-11-22T03:15:00Z", "file": "/srv/press.json",
     "safety_backup": "/srv/press.safety-st01-….json", "command": "fatektool restore …"}

``job`` is there as well if it is another one than ``restore``. A process that is killed leaves the record, so
that the next command that uses this PLC warns. A record that cannot be written does not stop a write; one
that cannot be read is reported.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Final, Protocol

from fatektool.errors import DataError
from fatektool.files.atomic import read_bounded, write_whole
from fatektool.files.strict_json import read_json

if TYPE_CHECKING:
    from pathlib import Path

SCHEMA: Final = "fatektool.unfinished/1"
RESTORE: Final = "restore"
_MAX_FILE: Final = 1 << 16


class WriteMark(Protocol):
    """Records a write: ``begin`` before its first request, ``end`` when it is complete or undone."""

    def begin(self, safety_copy: Path | None) -> None:
        """The next request writes.

        Args:
            safety_copy: where the state before is saved.
        """

    def end(self, *, complete: bool) -> None:
        """The write is complete; or, if not, the PLC has exactly its previous contents."""


class NoMark:
    """Records nothing."""

    def begin(self, safety_copy: Path | None) -> None:
        """Record nothing."""

    def end(self, *, complete: bool) -> None:
        """Record nothing."""


NO_MARK: Final = NoMark()


@dataclass(frozen=True, slots=True)
class Unfinished:
    """A write that was begun.

    Attributes:
        target: as the user named it.
        station: 1 to 254; over Modbus TCP also 0 and 255.
        time: when it began, UTC.
        file: what was to be written, its whole path; None if there is no file.
        safety_backup: where the state before it is saved; None if it was not saved.
        command: what finishes it.
        job: the command's name.
    """

    target: str
    station: int
    time: str
    file: str | None
    safety_backup: str | None
    command: str
    job: str = RESTORE

    def document(self) -> dict[str, Any]:
        """The record as JSON has it."""
        found = asdict(self)
        if self.job == RESTORE:
            del found["job"]
        return found

    def save(self, path: Path) -> None:
        """Write the record, on disk when this returns; the folder is made.

        Raises:
            OSError: the folder cannot be made.
            UsageError: it cannot be written there.
            DataError: the disk is full or broken.
        """
        path.parent.mkdir(mode=0o755, parents=True, exist_ok=True)
        text = json.dumps({"schema": SCHEMA} | self.document(), indent=1)
        write_whole(path, f"{text}\n".encode(), overwrite=True, mode=0o644)

    @classmethod
    def load(cls, path: Path) -> Unfinished:
        """Read a record.

        Raises:
            UsageError: there is none, or it may not be read.
            DataError: it is damaged.
        """
        try:
            found = read_json(read_bounded(path, _MAX_FILE))
        except ValueError as error:
            raise DataError(f"{path}: no record of a write: {error}", file=str(path)) from error
        if isinstance(found, dict):
            found.setdefault("job", RESTORE)
        if not isinstance(found, dict) or found.pop("schema", None) != SCHEMA or not _holds(found):
            raise DataError(f"{path}: no record of a write of this version", file=str(path))
        return cls(**found)


def _holds(found: dict[str, Any]) -> bool:
    kinds: dict[str, type | tuple[type, ...]] = dict.fromkeys(Unfinished.__slots__, str)
    kinds |= {"station": int, "safety_backup": (str, type(None))}
    if found.get("job") != RESTORE:
        kinds["file"] = (str, type(None))
    return found.keys() == kinds.keys() and all(isinstance(found[key], kind) for key, kind in kinds.items())
