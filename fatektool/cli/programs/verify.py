"""``verify``: is the PLC's program the one on file?"""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.data_differences import comparison_document, comparison_lines, ignore_option
from fatektool.cli.programs.differences import program_lines, say_how_to_see_words
from fatektool.cli.programs.documents import verify_document
from fatektool.cli.programs.program_files import comments_for, comments_options, program_file
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.output import passed
from fatektool.cli.shared.pairs import together
from fatektool.cli.shared.report import report_option, write_report
from fatektool.cli.shared.unfinished import DATA, forget, record_to_use, warn_of_unfinished
from fatektool.errors import UsageError
from fatektool.jobs.data.reading import read_data
from fatektool.jobs.programs.verify import compare_with_plc
from fatektool.program.data.compare import compare_data
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.program.data.part import DataPart
    from fatektool.project.program_file import ProgramFile


@click.command("verify", epilog="Example: fatektool verify press.json -p sim: || echo changed")
@click.argument("file", type=PATH)
@click.option("--data", is_flag=True, help="Compare the data of FILE too, if they ought to be constant.")
@ignore_option
@comments_options
@report_option
@connection_options
def verify_command(
    connection: Connection,
    voice: Voice,
    *,
    file: Path,
    data: bool,
    ignore: tuple[str, ...],
    report: Path | None,
    comments: Path | None,
    encoding: str | None,
) -> int:
    """Compare the PLC's program with FILE, a backup or a WinProladder project: exit 0 if the same, 1 if not.

    Pages that differ are read again. The PLC can be in RUN. -v shows the words that differ. --data compares
    what is kept without power, settings and disabled discretes too, and shows what else differs.
    """
    together("ignore", holds=data, needs="--data")
    on_file = program_file(file, voice, encoding)
    wanted = _data_of(on_file, file) if data else None
    texts = on_file.element_comments
    if comments is not None or not texts:
        texts = comments_for(connection, comments, voice, encoding)
    with connection.open(voice, needs=(Command.READ_PAGE,), finishes=True) as plc, voice.progress() as bar:
        result = compare_with_plc(plc, on_file, progress=bar.update)
        document = verify_document(plc, result, texts)
        compared = None
        if wanted is not None:
            there = read_data(plc, plc.detailed_status(), bar.update)
            keep = () if connection.entry is None else connection.entry.keep
            compared = compare_data(wanted, there, ignore, keep)
            document |= {"same": result.found.same and compared.same, "data": comparison_document(compared)}
    found = result.found
    address = connection.address
    if found.same:
        forget(record_to_use(address.target, address.station), voice)
        if compared is not None and compared.same:
            forget(record_to_use(address.target, address.station, *DATA), voice)
    warn_of_unfinished(address.target, address.station, voice)
    count = len(found.a.pages)
    same = f"same: the PLC's program is the one in {file}, {count} pages"
    if found.pages.b_has_more:
        voice.warn(f"the PLC has more than the {count} pages of {file}: the rest is not compared")
    if report is not None:
        from fatektool.report.program import verify_report

        write_report(report, verify_report(document, found.a, found.networks or (), texts))
    lines = program_lines(found, same, (str(file), "PLC"), texts, words=voice.verbose)
    data_lines = () if compared is None else comparison_lines(compared, (str(file), "PLC"))
    voice.show(document, chain(lines, data_lines, [f"took {passed(plc, result.duration_s)}"]))
    say_how_to_see_words(found, voice)
    return 0 if found.same and (compared is None or compared.same) else 1


def _data_of(on_file: ProgramFile, file: Path) -> DataPart:
    """The data in FILE.

    Raises:
        UsageError: there are none.
    """
    if on_file.backup is None or on_file.backup.data is None:
        raise UsageError(
            f"{file} has no data: expected a backup that was saved with --data",
            hint="leave --data out to compare the program alone",
        )
    return on_file.backup.data
