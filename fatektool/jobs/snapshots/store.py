"""Snapshots on disk, for years, from cron: dated files in a folder, or lines at the end of a file.

A dated file is complete or absent. A line is appended in one write under a lock, so that two processes never
mix their lines; after a line that a crash left incomplete the next one begins on a new line. ``--keep``
removes old snapshots, by number or by days.
"""

from __future__ import annotations

import os
import re
import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Final

from fatektool.callbacks import ignore
from fatektool.errors import FatektoolError, FileWarning, UsageError
from fatektool.files.atomic import file_error, require_folder, require_place, sync, write_new, write_whole
from fatektool.files.times import stamp
from fatektool.system.renaming import remove_file
from fatektool.transport.lock import PortLock

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fatektool.jobs.snapshots.snapshot import Snapshot

_KEEP: Final = re.compile(r"([1-9][0-9]{0,8})(d?)", re.ASCII)
DATED: Final = re.compile(r"snapshot-st(\d\d+)-(\d{8}T\d{6}Z)(?:-(\d{1,9}))?\.(\w+)", re.ASCII)
"""A dated file's name: station, time, the number of its second from 2, ending."""
_START: Final = b'{"schema":"fatektool.snapshot/'
_OBJECT: Final = re.compile(rb'\{[ \t]*"')
_OURS: Final = re.compile(rb'\{[ \t]*"schema"[ \t]*:[ \t]*"fatektool\.snapshot/')
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

    Warns:
        FileWarning: it is written, and old ones could not be dropped.
    """
    require_folder(folder)
    stem = f"snapshot-st{snapshot.station:02}-{stamp(snapshot.time)}"
    path = write_new(folder, stem, suffix, encoded(text))
    if keep is not None:
        with _dropping(folder):
            _drop_files(folder, snapshot.station, suffix, keep, now or datetime.now(UTC))
    return path


@contextmanager
def _dropping(path: Path) -> Iterator[None]:
    """A failure here is a warning: the snapshot is already written."""
    try:
        yield
    except (OSError, FatektoolError) as error:
        why = error if isinstance(error, FatektoolError) else error.strerror or error
        message = f"the snapshot is written, but old ones in {path} could not be removed: {why}"
        warnings.warn(message, FileWarning, stacklevel=3)


def encoded(text: str) -> bytes:
    """Text as a file has it; a target that is no UTF-8 is shown with escapes."""
    return text.encode(errors="backslashreplace")


def _drop_files(folder: Path, station: int, suffix: str, keep: Keep, now: datetime) -> None:
    dated = []
    for path in folder.iterdir():
        match = DATED.fullmatch(path.name)
        if match and int(match[1]) == station and match[4] == suffix:
            dated.append((match[2], int(match[3] or 1), path))
    dated.sort()
    oldest = stamp(keep.oldest(now) + "Z")
    old = [path for time, _, path in dated if time < oldest] if keep.days else []
    if not keep.days:
        old = [path for *_, path in dated[: -keep.number]]
    for path in old:
        remove_file(path)


def append_line(
    path: Path,
    line: str,
    keep: Keep | None,
    *,
    now: datetime | None = None,
    wait_s: float = 60.0,
    waiting: Callable[[str], None] = ignore,
) -> None:
    """Append one line, under a lock, in one write, on disk when this returns.

    Args:
        path: the file; it is made if it is not there.
        line: with its newline.
        keep: what is kept of the file's snapshots; None for all.
        now: the present, for tests.
        wait_s: how long to wait for another process that appends.
        waiting: gets a note about that process.

    Raises:
        UsageError: the file cannot be written, or has other contents.
        DataError: the disk is full or broken; the file is as it was.
        PortBusy: another process locks the file for too long.

    Warns:
        FileWarning: the line is written, and old ones could not be dropped.
    """
    real = require_lines(path, keep)
    lock = PortLock(str(real), wait_s, waiting=waiting)
    lock.acquire()
    try:
        require_lines(path, keep)
        _append(real, line.encode())
        if keep is not None:
            with _dropping(path):
                _drop_lines(real, keep, now or datetime.now(UTC))
    except OSError as error:
        raise file_error("append to", path, error) from error
    finally:
        lock.release()


def require_lines(path: Path, keep: Keep | None) -> Path:
    """Check that a line can be appended here, and that it would not spoil a file of something else.

    Args:
        path: the file; it need not be there.
        keep: if it is not None, the file may have to be replaced.

    Returns:
        The path that it really has.

    Raises:
        UsageError: it has other contents, or cannot be written.
    """
    real = Path(os.path.realpath(path))
    if keep is not None or not real.is_file():
        require_place(path, overwrite=True)
    if not real.exists():
        return real
    if not os.access(real, os.W_OK):
        raise UsageError(f"{path} is not writable", hint="check its permissions", file=str(path))
    try:
        with real.open("rb") as file:
            start = file.read(len(_START)).strip()
    except OSError as error:
        raise file_error("read", path, error) from error
    if not _START.startswith(start) and not _OBJECT.match(start):
        raise UsageError(
            f"{path} has other content than snapshots, one per line, and is not changed",
            hint="name another file",
            file=str(path),
        )
    return real


def _append(path: Path, data: bytes) -> None:
    flags = os.O_RDWR | os.O_APPEND | os.O_CREAT | getattr(os, "O_BINARY", 0)
    with os.fdopen(os.open(path, flags, 0o640), "r+b", buffering=0) as file:
        size = file.seek(0, os.SEEK_END)
        if size:
            file.seek(size - 1)
            if file.read(1) != b"\n":  # a crash left half a line: close it off
                data = b"\n" + data
        try:
            written = file.write(data)
            if written != len(data):
                file.write(data[written:])  # says what the matter is
            sync(file.fileno(), path)
        except OSError:  # a full disk: take the half line back
            file.truncate(size)
            raise


def _drop_lines(path: Path, keep: Keep, now: datetime) -> None:
    """Leave out the lines of old snapshots, and half lines among them; what is none of ours stays."""
    lines = path.read_bytes().splitlines(keepends=True)
    oldest = keep.oldest(now).encode()
    left = keep.number
    kept = []
    for line in reversed(lines):
        time = _LINE_TIME.search(line)
        if not _OURS.match(line) and not _START.startswith(line.rstrip()):
            kept.append(line)
        elif keep.days:
            if time is not None and time[1] >= oldest:
                kept.append(line)
        elif left and line.endswith(b"}\n"):
            kept.append(line)
            left -= 1
    if len(kept) < len(lines):
        mode = path.stat().st_mode & 0o777
        write_whole(path, b"".join(reversed(kept)), overwrite=True)
        path.chmod(mode)  # whoever could read it still can
