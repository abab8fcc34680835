"""``monitor``: a program's networks beside what the PLC has now; why an element is on or off."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.program_files import comments_at, comments_options, program_file, warn_of_code
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.options import PATH
from fatektool.errors import PlcError

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice


@click.command("monitor", epilog="Example: fatektool monitor press.json --why Y4 -p /dev/ttyUSB0")
@click.argument("file", type=PATH)
@click.option("--why", metavar="ELEMENT", required=True, help="Say why ELEMENT is on or off, once.")
@comments_options
@connection_options
def monitor_command(
    connection: Connection,
    voice: Voice,
    *,
    file: Path,
    why: str,
    comments: Path | None,
    encoding: str | None,
) -> int:
    """Say why ELEMENT is on or off, by the program in FILE, a backup or a WinProladder project.

    It shows which instructions write the element, and which contacts on the way to them are open. The PLC is
    only read. A warning says so if its program is not the one in FILE, as far as that was compared.
    """
    from fatektool.cli.programs.monitor.why import explain
    from fatektool.jobs.monitor.why import Question

    found = program_file(file, voice, encoding)
    texts = comments_at(found, connection, comments, voice, encoding)
    code = found.require_code()
    warn_of_code(found, voice)
    answered = explain(connection, voice, found, Question(code, why), texts.elements)
    return 0 if answered else PlcError.exit_code
