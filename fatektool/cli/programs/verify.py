"""``verify``: is the PLC's program the one on file?"""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.differences import program_lines, say_how_to_see_words
from fatektool.cli.programs.documents import verify_document
from fatektool.cli.programs.program_files import comments_for, comments_options, program_file
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.report import report_option, write_report
from fatektool.cli.shared.unfinished import forget, record_of, warn_of_unfinished
from fatektool.counts import spent
from fatektool.jobs.programs.verify import compare_with_plc
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice


@click.command("verify", epilog="Example: fatektool verify press.json -p sim: || echo changed")
@click.argument("file", type=PATH)
@comments_options
@report_option
@connection_options
def verify_command(
    connection: Connection,
    voice: Voice,
    *,
    file: Path,
    report: Path | None,
    comments: Path | None,
    encoding: str | None,
) -> int:
    """Compare the PLC's program with FILE, a backup or a WinProladder project: exit 0 if the same, 1 if not.

    Pages that differ are read again. The PLC can be in RUN. -v shows the words that differ.
    """
    on_file = program_file(file, voice, encoding)
    texts = on_file.element_comments
    if comments is not None or not texts:
        texts = comments_for(connection, comments, voice, encoding)
    with connection.open(voice, needs=(Command.READ_PAGE,), finishes=True) as plc, voice.progress() as bar:
        result = compare_with_plc(plc, on_file, progress=bar.update)
        document = verify_document(plc, result, texts)
    found = result.found
    if found.same:
        forget(record_of(connection.address.target, connection.address.station), voice)
    warn_of_unfinished(connection.address.target, connection.address.station, voice)
    count = len(found.a.pages)
    same = f"same: the PLC's program is the one in {file}, {count} pages"
    if found.pages.b_has_more:
        voice.warn(f"the PLC has more than the {count} pages of {file}: the rest is not compared")
    if report is not None:
        from fatektool.report.program import verify_report

        write_report(report, verify_report(document, found.a, found.networks or (), texts))
    lines = program_lines(found, same, (str(file), "PLC"), texts, words=voice.verbose)
    voice.show(document, chain(lines, [f"took {spent(result.duration_s)}"]))
    say_how_to_see_words(found, voice)
    return 0 if found.same else 1
