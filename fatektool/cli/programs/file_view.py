"""The contents of a backup or project, as rows of name and value."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.cli.programs.data_view import data_rows
from fatektool.cli.shared.colour import bad, joined, word
from fatektool.cli.shared.output import shown_time
from fatektool.counts import counted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.program.archive import Backup
    from fatektool.program.headers.header import Sum
    from fatektool.project.program_file import ProgramFile


def backup_rows(found: Backup, file: str) -> Iterator[tuple[str, object]]:
    """The contents of a backup; ``file`` is its name."""
    program, source = found.program, found.source
    used = sum(page != b"\xff" * len(page) for page in program.pages[1:])
    status = found.plc["status"]
    yield "file", f"{file}: complete, hash and header checked"
    yield "created", f"{shown_time(found.created)} by {found.tool}"
    yield (
        "source",
        f"station {source.station} on {source.target}, {source.protocol}, {source.line or 'no serial line'}",
    )
    yield "PLC then", word("RUN" if status.get("running") else "STOP")
    header = program.header
    yield "header", header.text()
    if header.checksum is not None:
        yield "checksum", _sum_words(header.checksum)
    yield (
        "ladder size",
        f"{counted(program.ladder_words, 'word')}, {counted(len(program.pages), 'page')}, {used} not empty",
    )
    yield "pages", found.proof_words
    yield "sha256", program.sha256
    yield from data_rows(found.data)


def project_rows(found: ProgramFile) -> Iterator[tuple[str, object]]:
    """The contents of a project."""
    project, comments, code = found.project, found.comments, found.code
    assert project is not None  # noqa: S101  # the caller's condition
    yield "file", f"{found.name}: a WinProladder project, cipher solved"
    yield "project", comments.name or "no name"
    yield "model", project.model or comments.model or "not named"
    header = found.header
    yield "header", header.text() if header.family is not None else "not known (FBE)"
    if header.checksum is not None:
        yield "checksum", _sum_words(header.checksum)
    if code is not None:
        unknown = f", {code.unknown_words} unknown words" if code.unknown_words else ""
        yield (
            "code",
            f"{counted(len(code.words), 'word')} in {counted(len(code.networks), 'network')}{unknown}",
        )
    for place, name in comments.units.items():
        yield "unit", f"{name}, from byte {place:04X}"
    sure = "" if comments.sure else ", which does not decode all of them"
    texts = f"{len(comments.elements)} of elements, {len(comments.networks)} of networks"
    yield "comments", f"{texts}, {comments.code_page}{sure}"
    yield "sha256", f"{found.sha256} of the image"


def _sum_words(found: Sum) -> str:
    """A checksum, and whether it is correct."""
    if found.valid:
        return f"{found.stored:04X}, correct"
    computed = "cannot be computed" if found.computed is None else f"that of the code is {found.computed:04X}"
    return joined(f"{found.stored:04X}, ", bad("WRONG"), f": {computed}")
