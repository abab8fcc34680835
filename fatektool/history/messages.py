"""The text of a commit: the PLC, and what changed.

::

    press-3: N0009 changed, N0031 added (4 words in 2 pages)

    networks N0009 changed, N0031 added
    pages    3, 5
    sha256   1cfe93ed… before
    sha256   9a0b5c1d… after
    program  FB30, 13184 words
    source   station 1 on tcp://192.168.2.3, facon
    read     2026-11-22T03:15:00Z by fatektool 0.1.0

The author is the PLC, with the time at which its program was read. The committer is fatektool on this
computer, with the time of the recording. Everything is printable text, each value on its own line.
"""

from __future__ import annotations

import re
import socket
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from fatektool.counts import counted
from fatektool.program.image import ranges

if TYPE_CHECKING:
    from fatektool.program.archive import Backup
    from fatektool.program.compare import Comparison


def subject(
    name: str,
    found: Comparison | None,
    networks: str | None = None,
    *,
    damaged: bool = False,
    data: str | None = None,
) -> str:
    """The first line of the message.

    Args:
        name: the PLC.
        found: the comparison of the old program with the new one; None if there is no old one.
        networks: the networks that differ, in words; None if a program has no mnemonics.
        damaged: True if there is an old one that cannot be read.
        data: what changed in the data, in words; None for nothing.
    """
    if found is not None and found.same and data is not None:
        return f"{name}: {data}"
    more = f"; {data}" if data is not None else ""
    if found is None:
        return f"{name}: new backup, the previous one is damaged" if damaged else f"{name}: first backup"
    if found.a_ladder_words != found.b_ladder_words:
        size = f"ladder size {found.a_ladder_words} -> {found.b_ladder_words} words, "
    else:
        size = ""
    words = f"{counted(found.word_count, 'word')} in {counted(len(found.pages), 'page')}"
    if networks is None:
        return f"{name}: {size}{words} changed{more}"
    return f"{name}: {size}{networks} ({words}){more}"


def message(
    first_line: str, found: Comparison | None, old: Backup | None, new: Backup, networks: str | None = None
) -> bytes:
    """The whole message.

    Args:
        first_line: the subject.
        found: the comparison of the old program with the new one; None if there is no old one.
        old: the previous backup; None if there is none that can be read.
        new: the backup that is recorded.
        networks: all networks that differ, in words; None if a program has no mnemonics.
    """
    source = new.source
    line = f", {source.line}" if source.line else ""
    rows = []
    if networks is not None:
        rows.append(("networks", networks))
    if found is not None and old is not None:
        rows += [("pages", ranges(found.page_numbers)), ("sha256", f"{old.program.sha256} before")]
    rows += [
        ("sha256", f"{new.program.sha256}{' after' if old is not None else ''}"),
        ("program", f"{new.program.header.text()}, {new.program.ladder_words} words"),
        ("source", f"station {source.station} on {source.target}, {source.protocol}{line}"),
        ("read", f"{new.created} by {new.tool}"),
    ]
    if new.data is not None:
        rows.append(("data", f"{new.data.sha256}, read {new.data.time}"))
    body = "".join(f"{key:<8} {_plain(value)}\n" for key, value in rows)
    return f"{_plain(first_line)}\n\n{body}".encode()


def author(name: str, backup: Backup) -> bytes:
    """The PLC as the author of a commit: ``press-3 <station-1@192.168.2.3:500>``."""
    place = backup.source.target.rpartition("://")[2]
    return f"{name} <station-{backup.source.station}@{_address(place)}>".encode()


def committer() -> bytes:
    """The committer: fatektool on this computer."""
    return f"fatektool <fatektool@{_address(socket.gethostname())}>".encode()


def read_at(backup: Backup, otherwise: int) -> int:
    """When the program was read, in seconds since 1970; ``otherwise`` if that is not a valid time for git."""
    try:
        return max(0, int(datetime.fromisoformat(backup.created).astimezone(UTC).timestamp()))
    except (ValueError, OverflowError):
        return otherwise


def _address(text: str) -> str:
    return re.sub(r"[^\w.:/+-]+", "-", text).strip("-.:") or "unknown"


def _plain(text: str) -> str:
    return "".join(char if char.isprintable() else "?" for char in text)
