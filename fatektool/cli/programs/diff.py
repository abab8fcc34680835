"""``diff``: two programs against each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.differences import show_differences
from fatektool.cli.programs.program_files import (
    comments_from,
    comments_options,
    program_file,
    require_comments,
)
from fatektool.cli.shared.options import PATH, is_standard, voice_options
from fatektool.cli.shared.report import report_option
from fatektool.errors import UsageError

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.output import Voice


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

    Each is a backup or a WinProladder project, of which the image is compared, in either byte order. -v shows
    the words that differ.
    """
    from fatektool.project.comparison import compare_files

    if is_standard(a) and is_standard(b):
        raise UsageError("standard input has one program: give - for only one of the two")
    one, other = program_file(a, voice, encoding), program_file(b, voice, encoding)
    require_comments(comments, one, other)
    named = comments_from(comments, voice, encoding)
    texts = {**other.element_comments, **one.element_comments} if named is None else named.elements
    sides = (str(a), one.sha256), (str(b), other.sha256)
    return show_differences(*sides, compare_files(one, other), voice, report, comments=texts)
