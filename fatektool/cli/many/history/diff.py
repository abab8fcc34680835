"""``history diff``: a PLC's program at two revisions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.many.history.options import history_option
from fatektool.cli.programs.differences import show_differences
from fatektool.cli.shared.options import completing, voice_options
from fatektool.cli.shared.report import report_option
from fatektool.history.history import History
from fatektool.program.data.compare import compare_data
from fatektool.project.comparison import compare_programs

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.output import Voice


@click.command("diff", epilog="Example: fatektool history diff press-3 ~1 --history plc-history")
@click.argument("name", shell_complete=completing("complete_history"))
@click.argument("a", required=False, default="~1")
@click.argument("b", required=False, default="HEAD")
@report_option
@history_option
@voice_options
def diff_command(name: str, a: str, b: str, folder: Path, voice: Voice, *, report: Path | None) -> int:
    """Compare a program at two revisions.

    B defaults to the newest revision, A to the one before the last change. Exit 0 if the program is the same,
    1 if it differs.
    """
    history = History(folder)
    one, other = history.show(name, a), history.show(name, b)
    old, new = one.backup.program, other.backup.program
    sides = (one.label, old.sha256), (other.label, new.sha256)
    before, after = one.backup.data, other.backup.data
    data = None if before is None or after is None else compare_data(before, after)
    return show_differences(*sides, compare_programs(old, new), voice, report, data=data)
