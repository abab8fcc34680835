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


@click.command("diff", epilog="Example: fatektool diff monday.json tuesday.json")
@click.argument("a", type=PATH)
@click.argument("b", type=PATH)
@report_option
@voice_options
def diff_command(a: Path, b: Path, voice: Voice, *, report: Path | None) -> int:
    """Compare the backups A and B: exit 0 if the programs are the same, 1 if not. Needs no PLC."""
    one, other = load_backup(a).program, load_backup(b).program
    found = compare(one, other)
    document = {
        "schema": "fatektool.diff/1",
        "a": {"file": str(a), "sha256": one.sha256},
        "b": {"file": str(b), "sha256": other.sha256},
        **differences(found),
    }
    voice.show(document, difference_lines(found, f"same: {len(one.pages)} pages", str(a), str(b)))
    if report is not None:
        from fatektool.report.program import diff_report

        write_report(report, diff_report(document, one, other, time=utc()))
    return 0 if found.same else 1
