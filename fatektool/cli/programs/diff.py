"""``diff``: two programs against each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.differences import program_lines
from fatektool.cli.programs.program_files import (
    comments_from,
    comments_options,
    program_file,
    require_comments,
)
from fatektool.cli.shared.documents import program_differences
from fatektool.cli.shared.options import PATH, voice_options
from fatektool.cli.shared.report import report_option, write_report
from fatektool.errors import UsageError
from fatektool.files.times import utc

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.project.comparison import ProgramComparison


STDIN = "-"


@click.command("diff", epilog="Example: fatektool diff monday.json tuesday.json")
@click.argument("a", type=PATH)
@click.argument("b", type=PATH)
@comments_options
@report_option
@voice_options
def diff_command(
    a: Path, b: Path, voice: Voice, *, report: Path | None, comments: Path | None, encoding: str | None
) -> int:
    """Compare the programs A and B: exit 0 if they are the same, 1 if not. Needs no PLC.

    Each is a backup or a WinProladder project: of that the image is compared, whatever the order of bytes.
    """
    from fatektool.project.comparison import compare_files

    if str(a) == str(b) == STDIN:
        raise UsageError("standard input holds one program: expected - for one of the two")
    one, other = program_file(a, voice, encoding), program_file(b, voice, encoding)
    require_comments(comments, one, other)
    named = comments_from(comments, voice, encoding)
    texts = {**other.element_comments, **one.element_comments} if named is None else named.elements
    sides = (str(a), one.sha256), (str(b), other.sha256)
    return show_difference(*sides, compare_files(one, other), voice, report, comments=texts)


def show_difference(
    a: tuple[str, str],
    b: tuple[str, str],
    found: ProgramComparison,
    voice: Voice,
    report: Path | None = None,
    *,
    comments: Mapping[str, str] | None = None,
) -> int:
    """Print what differs between two programs, each with its name and its hash; give the exit code."""
    (a_name, a_hash), (b_name, b_hash) = a, b
    document = {
        "schema": "fatektool.diff/1",
        "a": {"file": a_name, "sha256": a_hash},
        "b": {"file": b_name, "sha256": b_hash},
        **program_differences(found, comments),
    }
    code = ", same code" if found.same_code else ""
    same = f"same: {len(found.a.pages)} pages{code}"
    if report is not None and found.b is not None:
        from fatektool.report.program import diff_report

        write_report(report, diff_report(document, found.a, found.b, time=utc()))
    voice.show(document, program_lines(found, same, a_name, b_name, comments))
    return 0 if found.same else 1
