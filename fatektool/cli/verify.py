"""``verify``: is the PLC's program the one on file?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.differences import difference_lines
from fatektool.cli.documents import verify_document
from fatektool.cli.options import PATH, Connection, connection_options
from fatektool.cli.report import report_option, write_report
from fatektool.jobs.verify import verify
from fatektool.program.archive import load_backup
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.output import Voice


@click.command("verify", epilog="Example: fatektool verify press.json -p /dev/ttyUSB0 || mail the-team")
@click.argument("file", type=PATH)
@report_option
@connection_options
def verify_command(connection: Connection, voice: Voice, *, file: Path, report: Path | None) -> int:
    """Compare the PLC's program with the backup FILE: exit 0 if they are the same, 1 if not.

    What seems to differ is read twice. The PLC may run.
    """
    backup = load_backup(file)
    with connection.open(voice, needs=(Command.READ_PAGE,)) as plc, voice.progress() as bar:
        clock = plc.link.transport.clock
        began = clock()
        found = verify(plc, backup.program, progress=bar.update)
        document = verify_document(plc, file, backup.program, found, clock() - began)
    same = f"same: the PLC's program is the one in {file}, {len(backup.program.pages)} pages"
    if found.b_has_more:
        count = len(backup.program.pages)
        voice.warn(f"the PLC has more than the {count} pages of {file}: page {count} and on are not compared")
    voice.show(document, difference_lines(found, same, "file", "PLC"))
    if report is not None:
        from fatektool.report.program import verify_report

        write_report(report, verify_report(document, backup.program))
    return 0 if found.same else 1
