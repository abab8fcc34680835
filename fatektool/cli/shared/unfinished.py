"""The records of writes that did not complete, and the warning of them.

A record is a file in ``FATEKTOOL_STATE_DIR``, else in the user's state folder: ``fatektool`` in
``$XDG_STATE_HOME``, ``~/.local/state``, on Windows ``%LOCALAPPDATA%``. Its name is made of target and
station, and two names of one device are one::

    unfinished-dev-ttyUSB0-st01-1a2b3c4d.json             a restore
    unfinished-dev-ttyUSB0-st01-1a2b3c4d-5e6f7a8b.json    a write of values, one for each file

Each user has records of their own, unless the variable names one folder for all. Paths are text here: each
command that talks to a PLC looks for one, and pathlib is slow.
"""

from __future__ import annotations

import os
import re
import sys
from binascii import crc32
from typing import TYPE_CHECKING, Any, NamedTuple

from fatektool.errors import FatektoolError
from fatektool.transport.target import Target, TargetKind

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.write_back.record import Unfinished

DATA = ("data",)
"""What distinguishes the record of a restore of program and data from that of the program alone."""


def record_of(target: str, station: int, *about: str) -> str | None:
    """The file for the record of a write into this PLC; None for a PLC that is new each time (``sim:``).

    Args:
        target: as the user named it.
        station: the PLC's.
        about: what distinguishes a write of values from another one: command, file …; none for a restore.
    """
    line = line_name(target)
    if line == "sim:":
        return None
    readable = re.sub(r"[^A-Za-z0-9.]+", "-", line)[-60:].strip("-")
    which = "-".join(_number(text) for text in (line, "\0".join(about)) if text)
    return f"{state_folder()}/unfinished-{readable}-st{station:02}-{which}.json"


def _number(text: str) -> str:
    return f"{crc32(text.encode(errors='surrogateescape')):08x}"


def line_name(target: str) -> str:
    """What a line is called, the same for two names of one: a device's real path, ``host:port``.

    Raises:
        UsageError: there is no such target.
    """
    found = Target.parse(target)
    if found.kind is TargetKind.SIM:
        return f"sim:{os.path.realpath(found.path)}" if found.path else "sim:"
    if found.kind in {TargetKind.TCP, TargetKind.UDP}:
        return f"{found.host.lower()}:{found.port}"
    if found.kind is TargetKind.MODEM:  # many PLCs are called by one
        return target
    from fatektool.transport.serial_line.url import line_name

    return line_name(found.path)


def state_folder() -> str:
    """The folder of the records."""
    named = os.environ.get("FATEKTOOL_STATE_DIR")
    if named:
        return named
    if os.name == "nt":
        base = os.environ.get("LOCALAPPDATA") or os.path.expanduser("~/AppData/Local")  # noqa: PTH111
    else:
        base = os.environ.get("XDG_STATE_HOME") or os.path.expanduser("~/.local/state")  # noqa: PTH111
    return f"{base}/fatektool"


class Found(NamedTuple):
    """A record on disk, and what it says; None if it cannot be read."""

    path: str
    record: Unfinished | None


def records_of(target: str, station: int) -> Iterator[Found]:
    """The records of this PLC, that of a restore first; last those of an adapter that was plugged in again.

    ``/dev/serial/by-id/…`` may be another device then: such a record is known by the target that it names.
    """
    path = record_of(target, station)
    if path is None:
        return
    folder, _, name = path.rpartition("/")
    stem = name.removesuffix(".json")
    try:
        names = sorted(each for each in os.listdir(folder) if each.endswith(".json"))  # noqa: PTH208
    except OSError:  # no folder, no record
        return
    of_values = [each for each in names if each.startswith(f"{stem}-")]
    here = [name] * (name in names) + of_values
    for each in here:
        yield Found(f"{folder}/{each}", load(f"{folder}/{each}"))
    for each in names if _may_move(target) else ():
        if f"-st{station:02}-" in each and each not in here:
            record = load(f"{folder}/{each}")
            if record is not None and (record.target, record.station) == (target, station):
                yield Found(f"{folder}/{each}", record)


def _may_move(target: str) -> bool:
    """True if a target names a serial port by something else than its device: a link, a search."""
    return Target.parse(target).kind is TargetKind.SERIAL and line_name(target) != target


def record_to_use(target: str, station: int, *about: str) -> str | None:
    """``record_of``; or the record of the same write before the adapter was plugged in again."""
    path = record_of(target, station, *about)
    if path is not None and not os.path.exists(path):  # noqa: PTH110
        for found in records_of(target, station):
            if _about(found.path) == _about(path):
                return found.path
    return path


def _about(path: str) -> str:
    """The part of a record's name after the line's number."""
    return path.rpartition("-st")[2].removesuffix(".json").partition("-")[2].partition("-")[2]


def load(path: str | None) -> Unfinished | None:
    """A record; None if there is none that can be read."""
    if path is None or not os.path.exists(path):  # noqa: PTH110
        return None
    from pathlib import Path

    from fatektool.jobs.write_back.record import Unfinished

    try:
        return Unfinished.load(Path(path))
    except FatektoolError:
        return None


def warn_of_unfinished(target: str, station: int, voice: Voice, *, but: str | None = None) -> None:
    """Warn of writes into this PLC that did not complete.

    Args:
        target: as the user named it.
        station: the PLC's.
        voice: warns.
        but: the record of the write that is being done now.
    """
    for path, record in records_of(target, station):
        if path == but:
            continue
        if record is None:
            voice.warn(f"a write into this PLC did not complete, and its record cannot be read: {path}")
        else:
            voice.warn("\n".join(_lines(record, path)))


def unfinished(target: str, station: int) -> list[Unfinished]:
    """The records of this PLC that can be read."""
    return [record for _, record in records_of(target, station) if record is not None]


def unfinished_documents(target: str, station: int) -> dict[str, Any]:
    """The same for JSON: a restore, or null, and writes of values."""
    restore, writes = None, []
    for record in unfinished(target, station):
        found = record.document()
        if "job" not in found:
            restore = found
        else:
            of_values = {name: found[name] for name in ("job", "time", "file", "command")}
            writes.append(of_values | {"safety_snapshot": record.safety_backup})
    return {"unfinished_restore": restore, "unfinished_writes": writes}


def _lines(record: Unfinished, path: str) -> Iterator[str]:
    """A record for a person. It names a port, to which another PLC may be connected by now."""
    from fatektool.cli.shared.output import shown_time, table
    from fatektool.jobs.write_back.record import RESTORE

    program = record.job == RESTORE
    if program:
        yield "a restore into this PLC did not complete: do not switch it to RUN"
    else:
        yield f"'{record.job}' into this PLC did not complete: some of the values may have been written"
    rows: list[tuple[str, object]] = [("started", shown_time(record.time, sys.stderr))]
    if record.file is not None:
        rows.append(("file", record.file))
    saved = f"saved in {record.safety_backup}" if record.safety_backup else "not saved"
    rows += [
        (f"previous {'program' if program else 'values'}", saved),
        ("other PLC?", f"if another one is connected now, do not finish it here, and delete {path}"),
    ]
    for row in table(rows):
        yield f"  {row}"
    yield "  to finish it, run:"
    yield record.command


def forget(path: str | None, voice: Voice) -> None:
    """Remove a record: the write is complete, or undone."""
    if path is None or not os.path.exists(path):  # noqa: PTH110
        return
    from pathlib import Path

    from fatektool.system.renaming import remove_file

    try:
        remove_file(Path(path))
    except OSError as error:
        voice.warn(
            f"the record of a write that did not complete stays: cannot remove {path}: {error.strerror}"
        )
        return
    voice.detail(f"the record of a write that did not complete is removed: {path}")


def forget_those_undone(target: str, station: int, copy: Path, voice: Voice) -> None:
    """Remove the records of writes of values whose safety copy is in the PLC again."""
    for path, record in records_of(target, station):
        if record is not None and record.safety_backup == str(copy.absolute()):
            forget(path, voice)


class RecordMark:
    """The record of the write that is being done.

    Args:
        path: its file; None for none.
        record: what it says, but for the safety copy.
        voice: warns if it cannot be written.
    """

    def __init__(self, path: str | None, record: Unfinished, voice: Voice) -> None:
        self._path = path
        self._record = record
        self._voice = voice
        self._before: Unfinished | None = None

    def begin(self, safety_copy: Path | None) -> None:
        """Write the record; it keeps the safety copy that an earlier record names."""
        from dataclasses import replace

        self._before = load(self._path)
        copy = None if safety_copy is None else str(safety_copy.absolute())
        if self._before is not None and self._before.safety_backup is not None:
            copy = self._before.safety_backup
        self._save(replace(self._record, safety_backup=copy))

    def end(self, *, complete: bool) -> None:
        """Remove it; or put the one back that was there before, if the PLC is as it was."""
        if complete or self._before is None:
            forget(self._path, self._voice)
        else:
            self._save(self._before)

    def _save(self, record: Unfinished) -> None:
        from pathlib import Path

        if self._path is None:
            return
        try:
            record.save(Path(self._path))
        except (OSError, FatektoolError) as error:
            why = error.message if isinstance(error, FatektoolError) else f"{self._path}: {error.strerror}"
            self._voice.warn(f"no record of this write, should it not complete: {why}")
