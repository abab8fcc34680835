"""The JSON documents of the commands for programs, and their parts that others show too."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.cli.shared.documents import where
from fatektool.cli.shared.image_words import image_warnings

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.jobs.programs.backup import BackupResult
    from fatektool.jobs.programs.restore import RestoreResult
    from fatektool.jobs.programs.verify import VerifyResult
    from fatektool.ladder.cross_reference import CrossReference, XrefFinding
    from fatektool.ladder.differences import NetworkChange
    from fatektool.ladder.instruction import Instruction
    from fatektool.ladder.networks import Network
    from fatektool.program.archive import Backup
    from fatektool.program.compare import Comparison
    from fatektool.program.data.part import DataPart
    from fatektool.project.comments import Comments
    from fatektool.project.comparison import ProgramComparison
    from fatektool.project.program_file import ProgramFile

_UNITS: Final = ("main", "sub")


def backup_summary(backup: Backup) -> dict[str, Any]:
    """The contents of a backup, without its pages."""
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
        "proof": None if backup.proof is None else backup.proof.document(),
        "sha256": backup.program.sha256,
        "data": None if backup.data is None else data_summary(backup.data),
        "warnings": image_warnings(backup.program),
    }


def data_summary(data: DataPart) -> dict[str, Any]:
    """What the data of a backup are, without their values."""
    return {**data.summary(), "disabled": dict(data.disabled)}


def saved_document(found: BackupResult, file: Path) -> dict[str, Any]:
    """``fatektool.backup-result/1``: what was written to a file."""
    return {
        "schema": "fatektool.backup-result/1",
        "file": str(file),
        "duration_s": round(found.duration_s, 3),
        **backup_summary(found.backup),
    }


def inspect_document(found: ProgramFile) -> dict[str, Any]:
    """``fatektool.inspect/1`` of a backup or of a project."""
    if found.backup is not None:
        parts = {**backup_summary(found.backup), "faults": list(found.program.header_faults)}
    else:
        parts = _project_summary(found)
    return {"schema": "fatektool.inspect/1", "file": found.name, "kind": found.kind, **parts}


def _project_summary(found: ProgramFile) -> dict[str, Any]:
    """The contents of a project, without its image."""
    project, comments, code = found.project, found.comments, found.code
    assert project is not None  # noqa: S101  # the caller's condition
    known = found.header.family is not None
    return {
        "project": {
            "name": comments.name,
            "model": project.model,
            "code_page": comments.code_page,
            "file_sha256": project.file_sha256,
            "image_bytes": len(project.memory.image),
            "elements_commented": len(comments.elements),
            "networks_commented": len(comments.networks),
            "units": [{"name": name, "address": place} for place, name in comments.units.items()],
        },
        "header": found.header_document,
        "page_count": found.page_count,
        "sha256": found.sha256,
        "networks": None if code is None else len(code.networks),
        "unknown_words": None if code is None else code.unknown_words,
        "warnings": image_warnings(found.program) if known else [],
        "faults": list(found.header.faults) if known else [],
    }


def diff_document(
    a: tuple[str, str],
    b: tuple[str, str],
    found: ProgramComparison,
    comments: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    """``fatektool.diff/1`` of two programs, each with its name and its hash."""
    return {
        "schema": "fatektool.diff/1",
        **{side: {"file": name, "sha256": sha256} for side, (name, sha256) in (("a", a), ("b", b))},
        **program_differences(found, comments),
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
    plc: Plc, result: VerifyResult, comments: Mapping[str, str] | None = None
) -> dict[str, Any]:
    """``fatektool.verify/1``: a file's program against the PLC's; ``comments`` are of elements."""
    return {
        "schema": "fatektool.verify/1",
        **where(plc),
        "file": result.file.name,
        "sha256": result.file.sha256,
        "duration_s": round(result.duration_s, 3),
        **program_differences(result.found, comments),
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
    data: dict[str, Any] | None,
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
        "data": data,
        "safety_backup": result.safety_backup,
        "mode_before": result.mode_before,
        "mode_after": result.mode_after,
        "warnings": list(result.warnings),
        "duration_s": round(duration_s, 3),
    }


def listing_document(found: ProgramFile, networks: Sequence[Network], comments: Comments) -> dict[str, Any]:
    """``fatektool.listing/1``."""
    from fatektool.project.comments import text_in  # the other documents have no comments of networks

    return {
        "schema": "fatektool.listing/1",
        "file": found.name,
        "header": found.header_document,
        "unknown_words": found.require_code().unknown_words,
        "networks": [
            {
                "number": network.number,
                "unit": _UNITS[network.unit],
                "comment": text_in(network.addresses, comments.networks),
                "instructions": [
                    _instruction_document(number, word, instruction)
                    for number, word, instruction in network.places
                ],
            }
            for network in networks
        ],
        "comments": dict(comments.elements),
    }


def _instruction_document(number: int, word: int, instruction: Instruction) -> dict[str, Any]:
    return {
        "number": number,
        "word": word,
        "words": [f"{each:04X}" for each in instruction.words],
        "text": instruction.text,
        "elements": list(instruction.elements),
        "known": instruction.known,
        "grade": instruction.grade.value,
    }


def xref_document(
    found: ProgramFile,
    reference: CrossReference,
    elements: Iterable[str],
    findings: Iterable[XrefFinding],
    comments: Mapping[str, str],
) -> dict[str, Any]:
    """``fatektool.xref/1``.

    Args:
        found: the program.
        reference: where each element of it is read and written.
        elements: those that are shown.
        findings: about these elements.
        comments: of elements.
    """
    return {
        "schema": "fatektool.xref/1",
        "file": found.name,
        "unknown_words": found.require_code().unknown_words,
        "elements": {
            element: {
                "reads": [place._asdict() for place in reference.uses(element).reads],
                "writes": [place._asdict() for place in reference.uses(element).writes],
                "comment": comments.get(element),
            }
            for element in elements
        },
        "findings": [
            {
                "kind": each.kind.value,
                "element": each.element,
                "where": [place._asdict() for place in each.where],
            }
            for each in findings
        ],
    }
