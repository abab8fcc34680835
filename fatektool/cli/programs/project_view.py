"""What a project of the vendor's program holds, as ``inspect`` shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.cli.shared.image_words import image_warnings

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.program.headers.header import Sum
    from fatektool.project.program_file import ProgramFile


def project_document(found: ProgramFile) -> dict[str, Any]:
    """``fatektool.inspect/1`` of a project."""
    project, comments, code = found.project, found.comments, found.code
    assert project is not None  # noqa: S101  # the caller's condition
    known = found.header.family is not None
    return {
        "schema": "fatektool.inspect/1",
        "file": found.name,
        "kind": "project",
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


def project_rows(found: ProgramFile) -> Iterator[tuple[str, object]]:
    """The same for people."""
    project, comments, code = found.project, found.comments, found.code
    assert project is not None  # noqa: S101  # the caller's condition
    yield "file", f"{found.name}: a WinProladder project, cipher solved"
    yield "project", comments.name or "no name"
    yield "model", project.model or comments.model or "not named"
    header = found.header
    yield "header", header.text() if header.family is not None else "none known (FBE)"
    if header.checksum is not None:
        yield "checksum", sum_words(header.checksum)
    if code is not None:
        unknown = f", {code.unknown_words} words not understood" if code.unknown_words else ""
        yield "code", f"{len(code.words)} words in {len(code.networks)} networks{unknown}"
    for place, name in comments.units.items():
        yield "unit", f"{name}, from byte {place:04X}"
    sure = "" if comments.sure else ", which does not decode all"
    texts = f"{len(comments.elements)} of elements, {len(comments.networks)} of networks"
    yield "comments", f"{texts}, {comments.code_page}{sure}"
    yield "sha256", f"{found.sha256} of the image"


def sum_words(found: Sum) -> str:
    """A checksum, and whether it holds."""
    if found.valid:
        return f"{found.stored:04X}, holds"
    computed = "not to be computed" if found.computed is None else f"the code's is {found.computed:04X}"
    return f"{found.stored:04X}, DOES NOT HOLD: {computed}"
