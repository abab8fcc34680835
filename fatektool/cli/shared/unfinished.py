"""Restores that did not complete, and who is warned of them.

A PLC's record lies in ``FATEKTOOL_STATE_DIR``, else in the user's state folder: ``fatektool`` in
``$XDG_STATE_HOME``, ``~/.local/state``, on Windows ``%LOCALAPPDATA%``. Its name is made of target and
station, and two names of one device are one. Each user has records of their own, unless the variable names
one folder for all. Paths are text here: each command that talks to a PLC looks for one, and pathlib is slow.
"""

from __future__ import annotations

import os
import re
from binascii import crc32
from typing import TYPE_CHECKING, Any, TypeGuard

from fatektool.errors import FatektoolError
from fatektool.transport.target import Target, TargetKind

if TYPE_CHECKING:
    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.programs.unfinished import Mark, Unfinished


def record_of(target: str, station: int) -> str | None:
    """The file that holds the record of a PLC; None for one that is new each time (``sim:``)."""
    line = line_name(target)
    if line == "sim:":
        return None
    readable = re.sub(r"[^A-Za-z0-9.]+", "-", line)[-60:].strip("-")
    told_apart = crc32(line.encode(errors="surrogateescape"))
    return f"{state_folder()}/unfinished-{readable}-st{station:02}-{told_apart:08x}.json"


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
    from fatektool.transport.serial_line.url import line_of

    return line_of(found.path)


def state_folder() -> str:
    """Where records lie."""
    named = os.environ.get("FATEKTOOL_STATE_DIR")
    if named:
        return named
    if os.name == "nt":
        base = os.environ.get("LOCALAPPDATA") or os.path.expanduser("~/AppData/Local")  # noqa: PTH111
    else:
        base = os.environ.get("XDG_STATE_HOME") or os.path.expanduser("~/.local/state")  # noqa: PTH111
    return f"{base}/fatektool"


def warn_of_unfinished(target: str, station: int, voice: Voice) -> None:
    """Warn of a restore into this PLC that did not complete, if there is one."""
    path = record_of(target, station)
    if not _is_there(path):
        return
    found = _load(path)
    if found is None:
        voice.warn(f"this PLC's restore is unfinished, and its record cannot be read: {path}")
        return
    voice.warn("\n".join(_lines(found, path)))


def unfinished_document(target: str, station: int) -> dict[str, Any] | None:
    """The record for JSON; None if there is none that can be read."""
    path = record_of(target, station)
    found = _load(path) if _is_there(path) else None
    return None if found is None else found.document()


def _lines(found: Unfinished, path: str) -> list[str]:
    """The record for a person. It names a port, behind which another PLC may be by now."""
    return [
        "this PLC's restore is unfinished: it must not RUN",
        f"  begun        {found.time}",
        f"  file         {found.file}",
        f"  old program  {found.safety_backup or 'not saved'}",
        f"  other PLC?   if another one is connected now, do not finish it here, and delete {path}",
        "  to finish it:",
        found.command,
    ]


def _is_there(path: str | None) -> TypeGuard[str]:
    return path is not None and os.path.exists(path)  # noqa: PTH110


def _load(path: str) -> Unfinished | None:
    from pathlib import Path

    from fatektool.jobs.programs.unfinished import Unfinished

    try:
        return Unfinished.load(Path(path))
    except FatektoolError:
        return None


def forget(target: str, station: int, voice: Voice) -> None:
    """Remove the record: the PLC holds a whole program."""
    path = record_of(target, station)
    if path is None:
        return
    try:
        os.unlink(path)  # noqa: PTH108
    except FileNotFoundError:
        return
    except OSError as error:
        voice.warn(f"the record of an unfinished restore stays: cannot remove {path}: {error.strerror}")
        return
    voice.detail(f"the record of an unfinished restore is removed: {path}")


class RestoreMark:
    """The record of the restore that is being done.

    Args:
        record: what it says.
        voice: is told what cannot be written.
        way_back: takes note too.
    """

    def __init__(self, record: Unfinished, voice: Voice, way_back: Mark) -> None:
        self._record = record
        self._voice = voice
        self._way_back = way_back
        self._before: Unfinished | None = None

    def begin(self) -> None:
        """Write the record. The way back of a restore that did not complete before this one is kept in it."""
        from dataclasses import replace

        self._way_back.begin()
        path = record_of(self._record.target, self._record.station)
        self._before = _load(path) if _is_there(path) else None
        record = self._record
        if self._before is not None and self._before.safety_backup is not None:
            record = replace(record, safety_backup=self._before.safety_backup)
        self._save(record)

    def end(self, *, proven: bool) -> None:
        """Remove it; or put the one back that was there, if what it tells of is as it was."""
        self._way_back.end(proven=proven)
        if proven or self._before is None:
            forget(self._record.target, self._record.station, self._voice)
        else:
            self._save(self._before)

    def _save(self, record: Unfinished) -> None:
        from pathlib import Path

        path = record_of(self._record.target, self._record.station)
        if path is None:
            return
        try:
            record.save(Path(path))
        except (OSError, FatektoolError) as error:
            why = error.message if isinstance(error, FatektoolError) else f"{path}: {error.strerror}"
            self._voice.warn(f"no record of this restore, should it not complete: {why}")
