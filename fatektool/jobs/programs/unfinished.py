"""The record of a restore that has begun: written before the first page, removed when the program is proven.

::

    {"schema": "fatektool.unfinished/1", "target": "/dev/ttyUSB0", "station": 1,
     "time": "2026-11-22T03:15:00Z", "file": "/srv/press.json",
     "safety_backup": "/srv/press.safety-st01-….json", "command": "fatektool restore …"}

A process that is killed leaves it, and so whoever talks to that PLC next is warned. It is a help and no more:
what cannot be written is no reason not to restore, and what cannot be read says that there was one.
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
_MAX_FILE: Final = 1 << 16


class Mark(Protocol):
    """Takes note of a restore: ``begin`` before its first page, ``end`` when it is proven or undone."""

    def begin(self) -> None:
        """The next request writes a page."""

    def end(self, *, proven: bool) -> None:
        """The PLC holds the new program, proven; or, if not, what it held before, to the byte."""


@dataclass(frozen=True, slots=True)
class Unfinished:
    """A restore that was begun.

    Attributes:
        target: as the user named it.
        station: 1 to 254.
        time: when it began, UTC.
        file: what was to be restored, its whole path.
        safety_backup: where the last whole program before it lies; None if it was not saved.
        command: what finishes it.
    """

    target: str
    station: int
    time: str
    file: str
    safety_backup: str | None
    command: str

    def document(self) -> dict[str, Any]:
        """The record as JSON has it."""
        return asdict(self)

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
            raise DataError(f"{path}: no record of a restore: {error}", file=str(path)) from error
        if not isinstance(found, dict) or found.pop("schema", None) != SCHEMA or not _holds(found):
            raise DataError(f"{path}: no record of a restore of this version", file=str(path))
        return cls(**found)


def _holds(found: dict[str, Any]) -> bool:
    kinds: dict[str, type | tuple[type, ...]] = dict.fromkeys(Unfinished.__slots__, str)
    kinds |= {"station": int, "safety_backup": (str, type(None))}
    return found.keys() == kinds.keys() and all(isinstance(found[key], kind) for key, kind in kinds.items())
