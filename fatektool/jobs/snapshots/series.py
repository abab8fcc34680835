"""The snapshots that a folder of dated files or an NDJSON file holds, one after the other.

There may be years of them, so they are read one at a time. Incomplete snapshots, such as a line that a crash
cut off, and those of other PLCs are left out and counted.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING

from fatektool.errors import DataError
from fatektool.files.atomic import file_error, read_bounded
from fatektool.jobs.snapshots.snapshot import MAX_SNAPSHOT, Snapshot, parse_snapshot
from fatektool.jobs.snapshots.store import DATED

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_READABLE = {"json", "ndjson"}


@dataclass(slots=True)
class LeftOut:
    """What is not in the series.

    Attributes:
        broken: lines or files that are not a complete snapshot.
        foreign: snapshots of other PLCs.
    """

    broken: int = 0
    foreign: int = 0


def snapshot_series(place: Path, newest: Snapshot, left_out: LeftOut) -> Iterator[Snapshot]:
    """The snapshots of one PLC, in the order of the files or lines.

    Args:
        place: a folder of dated files, or an NDJSON file.
        newest: the one that was just written there; it names the PLC, and is in the series in any case, be it
            that another process has dropped it meanwhile.
        left_out: gets the counts.

    Raises:
        UsageError: the place cannot be read.
        DataError: the disk is broken.
    """
    seen = False
    for data in _files(place, newest.station) if place.is_dir() else _lines(place):
        try:
            snapshot = parse_snapshot(data, str(place))
            datetime.fromisoformat(snapshot.time)  # digits in their places may yet be no day
        except (DataError, ValueError):
            left_out.broken += 1
            continue
        if (snapshot.station, snapshot.target) != (newest.station, newest.target):
            left_out.foreign += 1
            continue
        seen = seen or snapshot == newest
        yield snapshot
    if not seen:
        yield newest


def _files(folder: Path, station: int) -> Iterator[bytes]:
    try:
        found = [
            (match[2], int(match[3] or 1), path)
            for path in folder.iterdir()
            if (match := DATED.fullmatch(path.name)) and int(match[1]) == station and match[4] in _READABLE
        ]
    except OSError as error:
        raise file_error("read", folder, error) from error
    for *_, path in sorted(found):
        yield read_bounded(path, MAX_SNAPSHOT)


def _lines(path: Path) -> Iterator[bytes]:
    try:
        with path.open("rb") as file:
            while line := file.readline(MAX_SNAPSHOT):
                if not line.isspace():
                    yield line
    except OSError as error:
        raise file_error("read", path, error) from error
