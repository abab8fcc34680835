"""``diff``: two backups against each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.differences import difference_lines
from fatektool.cli.documents import differences
from fatektool.cli.options import PATH, voice_options
from fatektool.cli.report import report_option, write_report
from fatektool.jobs.times import utc
from fatektool.program.archive import load_backup
from fatektool.program.compare import compare

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.output import Voice
    from fatektool.program.image import Program


@click.command("diff", epilog="Example: fatektool diff monday.json tuesday.json")
@click.argument("a", type=PATH)
@click.argument("b", type=PATH)
@report_option
@voice_options
def diff_command(a: Path, b: Path, voice: Voice, *, report: Path | None) -> int:
    """Compare the backups A and B: exit 0 if the programs are the same, 1 if not. Needs no PLC."""
    return show_difference((str(a), load_backup(a).program), (str(b), load_backup(b).program), voice, report)


def show_difference(
    a: tuple[str, Program], b: tuple[str, Program], voice: Voice, report: Path | None = None
) -> int:
    """Print what differs between two programs, each with what it is called; give the exit code."""
    (a_name, one), (b_name, other) = a, b
    found = compare(one, other)
    document = {
        "schema": "fatektool.diff/1",
        "a": {"file": a_name, "sha256": one.sha256},
        "b": {"file": b_name, "sha256": other.sha256},
        **differences(found),
    }
    voice.show(document, difference_lines(found, f"same: {len(one.pages)} pages", a_name, b_name))
    if report is not None:
        from fatektool.report.program import diff_report

        write_report(report, diff_report(document, one, other, time=utc()))
    return 0 if found.same else 1
