"""The JSON documents that commands print; each has a schema in ``fatektool/schemas``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.files.times import utc

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.errors import FatektoolError
    from fatektool.jobs.programs.restore import RestoreResult
    from fatektool.jobs.status import StatusReport
    from fatektool.ladder.differences import NetworkChange
    from fatektool.program.archive import Backup
    from fatektool.program.compare import Comparison
    from fatektool.project.comparison import ProgramComparison


def where(plc: Plc) -> dict[str, Any]:
    """When and where, as every document of a PLC begins."""
    return {
        "time": utc(),
        "target": plc.target,
        "station": plc.link.station,
        "protocol": plc.link.codec.name,
    }


def error_document(error: FatektoolError) -> dict[str, Any]:
    """``fatektool.error/1``."""
    return {
        "schema": "fatektool.error/1",
        "error": {
            "kind": error.kind,
            "exit_code": error.exit_code,
            "message": error.message,
            "hint": error.hint,
            "details": error.details,
        },
    }


def status_document(report: StatusReport) -> dict[str, Any]:
    """``fatektool.status/1``."""
    from fatektool.cli.shared.unfinished import (
        unfinished_document,  # loaded with the connection, if there is one
    )

    return {
        "schema": "fatektool.status/1",
        "time": report.time,
        "target": report.target,
        "station": report.station,
        "protocol": report.protocol,
        "status": report.flags.document(),
        "system": _system(report),
        "brief": {
            "status1": report.brief.status1,
            "status2": report.brief.status2,
            "status3": report.brief.status3,
            "model": report.brief.model,
        },
        "raw": {
            "brief": report.brief.to_bytes().hex().upper(),
            "detailed": None if report.detailed is None else report.detailed.raw.hex().upper(),
        },
        "unfinished_restore": unfinished_document(report.target, report.station),
    }


def _system(report: StatusReport) -> dict[str, Any] | None:
    """What 53 told, marked where the layout is assumed, and as it came where there is none."""
    from fatektool.protocol.status import DetailedStatus, RawStatus  # not before there is one

    match report.detailed:
        case DetailedStatus(system=system, assumed=assumed):
            return ({"layout": "assumed"} if assumed else {}) | system.document()
        case RawStatus(raw):
            return {"layout": "raw", "raw": raw.hex().upper()}
    return None


def backup_summary(backup: Backup) -> dict[str, Any]:
    """What a backup holds, without its pages."""
    from fatektool.cli.shared.image_words import image_warnings  # not before there is a program

    source = backup.source
    return {
        "created": backup.created,
        "tool": backup.tool,
        "source": {
            "target": source.target,
            "station": source.station,
            "protocol": source.protocol,
            "line": source.line,
        },
        "plc": backup.plc,
        "header": backup.header_document,
        "ladder_words": backup.program.ladder_words,
        "page_count": len(backup.program.pages),
        "passes": backup.passes,
        "sha256": backup.program.sha256,
        "warnings": image_warnings(backup.program),
    }


def saved_document(backup: Backup, file: Path, duration_s: float) -> dict[str, Any]:
    """``fatektool.backup-result/1``: what ``backup`` wrote."""
    return {
        "schema": "fatektool.backup-result/1",
        "file": str(file),
        "duration_s": round(duration_s, 3),
        **backup_summary(backup),
    }


def inspect_document(backup: Backup, file: Path) -> dict[str, Any]:
    """``fatektool.inspect/1``."""
    return {
        "schema": "fatektool.inspect/1",
        "file": str(file),
        "kind": "backup",
        **backup_summary(backup),
        "faults": list(backup.program.header_faults),
    }


def program_differences(
    found: ProgramComparison, comments: Mapping[str, str] | None = None
) -> dict[str, Any]:
    """Two programs' differences, networks and all: ``a`` is the file, or the first file.

    Args:
        found: the comparison.
        comments: of elements; those of networks that differ are in the document.
    """
    lines = (line for change in found.networks or () for line in change.diff)
    named = {element for line in lines for element in line.elements}
    told = {element: text for element, text in (comments or {}).items() if element in named}
    networks = networks_document(found.networks)
    return {**differences(found.pages), "networks": networks} | ({"comments": told} if told else {})


def networks_document(changes: Sequence[NetworkChange] | None) -> list[dict[str, Any]] | None:
    """The networks that differ; null where one of the programs has no mnemonics."""
    if changes is None:
        return None
    return [
        {
            "change": change.change.value,
            "a": None if change.a is None else change.a.number,
            "b": None if change.b is None else change.b.number,
            "lines": list(change.lines),
        }
        for change in changes
    ]


def differences(comparison: Comparison) -> dict[str, Any]:
    """Two programs' pages that differ: ``a`` is the file, or the first file."""
    return {
        "same": comparison.same,
        "a_ladder_words": comparison.a_ladder_words,
        "b_ladder_words": comparison.b_ladder_words,
        "b_has_more_pages": comparison.b_has_more,
        "pages_differ": len(comparison.pages),
        "words_differ": comparison.word_count,
        "differences": [
            {
                "page": page.page,
                "words": [
                    {"word": word.word, "a": f"{word.a:04X}", "b": f"{word.b:04X}"} for word in page.words
                ],
            }
            for page in comparison.pages
        ],
    }


def verify_document(
    plc: Plc,
    file: Path,
    sha256: str,
    found: ProgramComparison,
    duration_s: float,
    *,
    comments: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    """``fatektool.verify/1``: a file's program against the PLC's."""
    return {
        "schema": "fatektool.verify/1",
        **where(plc),
        "file": str(file),
        "sha256": sha256,
        "duration_s": round(duration_s, 3),
        **program_differences(found, comments),
    }


def restore_document(
    plc: Plc,
    file: Path,
    result: RestoreResult,
    *,
    dry_run: bool,
    pages_to_write: int,
    duration_s: float,
    model: str | None,
    source: dict[str, Any],
) -> dict[str, Any]:
    """``fatektool.restore/1``."""
    return {
        "schema": "fatektool.restore/1",
        **where(plc),
        "model": model,
        "file": str(file),
        "source": source,
        "dry_run": dry_run,
        "pages_to_write": pages_to_write,
        "pages_written": result.pages_written,
        "pages_equal": result.pages_equal,
        "verified": result.verified,
        "safety_backup": result.safety_backup,
        "mode_before": result.mode_before,
        "mode_after": result.mode_after,
        "warnings": list(result.warnings),
        "duration_s": round(duration_s, 3),
    }
