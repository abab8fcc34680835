"""The JSON documents of ``history``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.cli.programs.documents import backup_summary, networks_document
from fatektool.files.times import utc

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from fatektool.history.checking import HistoryCheck
    from fatektool.history.history import LogEntry, RecordResult, Stored
    from fatektool.history.push import Pushed
    from fatektool.ladder.differences import NetworkChange
    from fatektool.program.archive import Backup


def record_document(
    found: RecordResult, backup: Backup, folder: Path, pushed: Pushed | None
) -> dict[str, Any]:
    """``fatektool.history-record/1``."""
    changes = found.changes
    return {
        "schema": "fatektool.history-record/1",
        "history": str(folder),
        "name": found.name,
        "changed": found.revision is not None,
        "revision": found.revision,
        "subject": found.subject,
        "pages_differ": None if changes is None else len(changes.pages),
        "words_differ": None if changes is None else changes.word_count,
        "sha256": backup.program.sha256,
        "warnings": list(found.warnings),
        "push": None
        if pushed is None
        else {"remote": pushed.remote, "revision": pushed.revision, "sent": pushed.sent},
    }


def log_document(found: Sequence[LogEntry], folder: Path, name: str | None, *, more: bool) -> dict[str, Any]:
    """``fatektool.history-log/1``."""
    return {
        "schema": "fatektool.history-log/1",
        "history": str(folder),
        "name": name,
        "changes": [
            {
                "revision": change.commit.revision,
                "time": utc(change.commit.time),
                "name": change.name,
                "subject": change.commit.subject,
                "author": change.commit.author,
                "removed": change.removed,
            }
            for change in found
        ],
        "more": more,
    }


def show_document(
    found: Stored, folder: Path, changes: Sequence[NetworkChange] | None = None
) -> dict[str, Any]:
    """``fatektool.history-show/1``."""
    return {
        "schema": "fatektool.history-show/1",
        **_where(found, folder),
        "author": found.commit.author,
        "subject": found.commit.subject,
        **backup_summary(found.backup),
        "faults": list(found.backup.program.header_faults),
        "networks": networks_document(changes),
    }


def export_document(found: Stored, folder: Path, file: Path) -> dict[str, Any]:
    """``fatektool.history-export/1``."""
    return {
        "schema": "fatektool.history-export/1",
        "file": str(file),
        **_where(found, folder),
        "created": found.backup.created,
        "sha256": found.backup.program.sha256,
    }


def _where(found: Stored, folder: Path) -> dict[str, Any]:
    return {
        "history": str(folder),
        "name": found.name,
        "revision": found.commit.revision,
        "recorded": utc(found.commit.time),
    }


def check_document(found: HistoryCheck, folder: Path) -> dict[str, Any]:
    """``fatektool.history-check/1``."""
    return {
        "schema": "fatektool.history-check/1",
        "history": str(folder),
        "whole": not found.faults,
        "commits": found.commits,
        "programs": found.programs,
        "names": list(found.names),
        "shallow": found.shallow,
        "faults": [
            {"revision": fault.revision, "name": fault.name, "message": fault.message}
            for fault in found.faults
        ],
    }
