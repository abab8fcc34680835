"""``diff``: two programs against each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.data_differences import ignore_option
from fatektool.cli.programs.differences import show_differences
from fatektool.cli.programs.program_files import (
    comments_from,
    comments_options,
    program_file,
    require_comments,
)
from fatektool.cli.shared.options import PATH, is_standard, voice_options
from fatektool.cli.shared.pairs import together
from fatektool.cli.shared.report import report_option
from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.program.data.compare import DataComparison
    from fatektool.project.program_file import ProgramFile


@click.command("diff", epilog="Example: fatektool diff monday.json tuesday.json")
@click.argument("a", type=PATH)
@click.argument("b", type=PATH)
@ignore_option
@comments_options
@report_option
@voice_options
def diff_command(
    a: Path,
    b: Path,
    voice: Voice,
    *,
    ignore: tuple[str, ...],
    report: Path | None,
    comments: Path | None,
    encoding: str | None,
) -> int:
    """Compare the programs A and B: exit 0 if they are the same, 1 if not. Needs no PLC.

    Each is a backup or a WinProladder project, of which the image is compared, in either byte order. -v shows
    the words that differ. Data that both have are compared as far as they ought to be constant.
    """
    from fatektool.project.comparison import compare_files

    if is_standard(a) and is_standard(b):
        raise UsageError("standard input has one program: give - for only one of the two")
    one, other = program_file(a, voice, encoding), program_file(b, voice, encoding)
    require_comments(comments, one, other)
    named = comments_from(comments, voice, encoding)
    texts = {**other.element_comments, **one.element_comments} if named is None else named.elements
    sides = (str(a), one.sha256), (str(b), other.sha256)
    data = _data_compared(one, other, voice, ignore)
    return show_differences(*sides, compare_files(one, other), voice, report, comments=texts, data=data)


def _data_compared(
    one: ProgramFile, other: ProgramFile, voice: Voice, ignore: Sequence[str]
) -> DataComparison | None:
    """The data of two files compared; None if not both have some."""
    from fatektool.program.data.compare import compare_data

    a, b = (None if each.backup is None else each.backup.data for each in (one, other))
    if a is not None and b is not None:
        return compare_data(a, b, ignore)
    if a is not b:
        voice.say(f"only {(one if b is None else other).name} has data: the programs alone are compared")
    together("ignore", holds=False, needs="two files with data")
    return None
