"""The safety copy of a write: on disk before the question, removed again if nothing was sent.

A copy has the name ``NAME.safety-st01-20261122T031500Z.json`` and never replaces a file.
"""

from __future__ import annotations

import os
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import FatektoolError
from fatektool.files.atomic import STANDARD, write_new
from fatektool.files.times import stamp

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.jobs.write_back.plan import SafetyCopy

_LONGEST_NAME: Final = 150
"""In bytes; 255 are all that a name may have, and station, time and a number come after it."""


@dataclass(slots=True)
class Kept:
    """The safety copy of one write.

    Attributes:
        path: where it is; None if nothing is saved.
        needed: True if something may have been written, so that the copy stays.
    """

    path: Path | None
    needed: bool = False


@contextmanager
def kept(copy: SafetyCopy) -> Iterator[Kept]:
    """Have the safety copy on disk: that of an unfinished run of the same write, or a new one.

    A new one is removed at the end unless it is needed, as after a question that was answered with no.

    Raises:
        UsageError: the folder cannot be written.
        DataError: the disk is full or broken.
    """
    path, new = None, False
    if copy.folder is not None:
        path = copy.find(copy.folder)
        if path is None:
            try:
                path, new = copy.save(copy.folder), True
            except FatektoolError as error:
                error.message = f"{error.message}: nothing was written into the PLC"
                raise
    found = Kept(path)
    try:
        yield found
    finally:
        if new and path is not None and not found.needed:
            with suppress(OSError):
                path.unlink()


def name_of(name: str, station: int) -> str:
    """What the names of all safety copies of a file begin with, up to the time.

    Args:
        name: the file's name without its suffix; ``-`` is standard input.
        station: the PLC's.
    """
    return f"{start_of(name)}.safety-st{station:02}-"


def start_of(name: str) -> str:
    """As much of a file's name as the name of a safety copy has space for."""
    known = "stdin" if name == STANDARD else name  # a name that begins with - is an option to others
    return os.fsencode(known)[:_LONGEST_NAME].decode(errors="ignore")


def save_copy(folder: Path, name: str, station: int, time: str, data: bytes) -> Path:
    """Write a safety copy under a new name; it is on disk when this returns.

    Args:
        folder: where to.
        name: the name, without its suffix, of the file that is written into the PLC.
        station: the PLC's.
        time: when the PLC was read, UTC, RFC 3339.
        data: the copy.

    Raises:
        UsageError: the folder cannot be written.
        DataError: the disk is full or broken.
    """
    return write_new(folder, f"{name_of(name, station)}{stamp(time)}", "json", data)
