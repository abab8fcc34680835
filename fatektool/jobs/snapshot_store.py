"""Snapshots on disk, for years, from cron: dated files in a folder, or lines at the end of a file.

A dated file is whole or absent. A line is appended in one write under a lock, so that two processes never mix
theirs; a line that a crash left unfinished is closed off by the next one. ``--keep`` drops what is too old,
counted in snapshots or in days.
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError
from fatektool.jobs.times import stamp
from fatektool.program.files import file_error, free_name, require_folder, write_whole
from fatektool.transport.lock import PortLock

if TYPE_CHECKING:
    from fatektool.jobs.snapshot import Snapshot

_KEEP: Final = re.compile(r"([1-9][0-9]{0,8})(d?)", re.ASCII)
_DATED: Final = re.compile(r"fatek-st(\d\d+)-(\d{8}T\d{6}Z)(?:-\d+)?\.(\w+)", re.ASCII)
_LINE_TIME: Final = re.compile(rb'"time":\s*"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d)')


@dataclass(frozen=True, slots=True)
class Keep:
    """How many snapshots, or of how many days, are kept."""

    number: int
    days: bool

    @classmethod
    def parse(cls, text: str) -> Keep:
        """Read ``100`` (snapshots) or ``30d`` (days).

        Raises:
            UsageError: it is neither.
        """
        match = _KEEP.fullmatch(text)
        if match is None:
            raise UsageError(f"--keep {text!r}: expected a number of snapshots (100) or of days (30d)")
        return cls(int(match[1]), bool(match[2]))

    def oldest(self, now: datetime) -> str:
        """The stamp of the oldest day that is kept."""
        return (now - timedelta(days=min(self.number, 365_000))).strftime("%Y-%m-%dT%H:%M:%S")


def save_dated(
    snapshot: Snapshot,
    text: str,
    folder: Path,
    *,
    suffix: str,
    keep: Keep | None = None,
    now: datetime | None = None,
) -> Path:
    """Write a snapshot to a file of its own, named after station and time, and drop old ones.

    Args:
        snapshot: what ``text`` shows.
        text: the file's content.
        folder: where to.
        suffix: the file's ending, without its dot.
        keep: what is kept of this station's files with this ending; None for all.
        now: the present, for tests.

    Raises:
        UsageError: the folder cannot be written.
        DataError: the disk is full or broken.
    """
    require_folder(folder)
    path = free_name(folder, f"fatek-st{snapshot.station:02}-{stamp(snapshot.time)}", suffix)
    write_whole(path, text.encode(), overwrite=False)
    if keep is not None:
        _drop_files(folder, snapshot.station, suffix, keep, now or datetime.now(UTC))
    return path


def _drop_files(folder: Path, station: int, suffix: str, keep: Keep, now: datetime) -> None:
    dated = []
    for path in folder.iterdir():
        match = _DATED.fullmatch(path.name)
        if match and int(match[1]) == station and match[3] == suffix:
            dated.append((match[2], path.name, path))
    dated.sort()
    oldest = stamp(keep.oldest(now) + "Z")
    old = (
        [path for time, _, path in dated if time < oldest]
        if keep.days
        else [p for *_, p in dated[: -keep.number]]
    )
    for path in old:
        path.unlink(missing_ok=True)


def append_line(path: Path, line: str, keep: Keep | None, now: datetime | None = None) -> None:
    """Append one line, under a lock, in one write, on disk when this returns.

    Args:
        path: the file; it is made if it is not there.
        line: with its newline.
        keep: what is kept of the file's lines; None for all.
        now: the present, for tests.

    Raises:
        UsageError: the file cannot be written.
        DataError: the disk is full or broken.
        PortBusy: another process holds the file for long.
    """
    real = Path(os.path.realpath(path))
    lock = PortLock(str(real), 60.0)
    lock.acquire()
    try:
        _append(real, line.encode())
        if keep is not None:
            _drop_lines(real, keep, now or datetime.now(UTC))
    except OSError as error:
        raise file_error("append to", path, error) from error
    finally:
        lock.release()


def _append(path: Path, data: bytes) -> None:
    flags = os.O_RDWR | os.O_APPEND | os.O_CREAT | getattr(os, "O_BINARY", 0)
    with os.fdopen(os.open(path, flags, 0o640), "r+b", buffering=0) as file:
        size = file.seek(0, os.SEEK_END)
        if size:
            file.seek(size - 1)
            if file.read(1) != b"\n":
                data = b"\n" + data
        written = file.write(data)
        if written != len(data):  # a full disk: take the half line back
            file.truncate(size)
            raise OSError(28, "No space left on device")
        os.fsync(file.fileno())


def _drop_lines(path: Path, keep: Keep, now: datetime) -> None:
    lines = path.read_bytes().splitlines(keepends=True)
    if keep.days:
        oldest = keep.oldest(now).encode()
        kept = [line for line in lines if (time := _LINE_TIME.search(line)) is None or time[1] >= oldest]
    else:
        kept = lines[-keep.number :]
    if len(kept) < len(lines):
        write_whole(path, b"".join(kept), overwrite=True)
