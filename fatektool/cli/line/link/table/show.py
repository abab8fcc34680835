"""``link table show``, ``check`` and ``save``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.line.link.documents import table_document
from fatektool.cli.line.link.kind import KIND
from fatektool.cli.line.link.table.view import table_lines
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.documents import where
from fatektool.cli.shared.options import PATH, voice_options
from fatektool.counts import counted
from fatektool.files.atomic import read_bounded, require_place, write_whole
from fatektool.jobs.plcports.host import LinkHost, read_host
from fatektool.jobs.plcports.tables import parse_start, read_table
from fatektool.jobs.plcports.toml import MAX_TOML, load_table
from fatektool.jobs.plcports.toml_text import dump_table
from fatektool.plcports.kinds import TableKind
from fatektool.plcports.tables import place_faults
from fatektool.plcports.versions import needs_of_table
from fatektool.system.shell import own_command_line

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from typing import TypeVar

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice

    F = TypeVar("F", bound=Callable[..., Any])


def kind_option(function: F) -> F:
    """``--kind``: it cannot be seen from the registers of a table."""
    return click.option(
        "--kind",
        type=KIND,
        required=True,
        help="Mode of CLINK (FUN151), or mbus (FUN150).",
    )(function)


@click.command("show", epilog="Example: fatektool link table show R500 --kind md0 -p sim:plc.state --check")
@click.argument("sr", metavar="SR")
@kind_option
@click.option("--check", is_flag=True, help="Exit 1 if the table has faults.")
@connection_options
def show_command(sr: str, connection: Connection, voice: Voice, *, kind: str, check: bool) -> int:
    """Show the table at SR, with the result code that each row would give."""
    start = parse_start(sr, "SR")
    with connection.open(voice) as plc:
        found = read_table(plc, start, TableKind(kind))
        faults = [*place_faults(start, len(found.to_words())), *found.faults()]
        host = read_host(plc, needs_of_table(found))
        document = table_document(found, faults, str(start), None, where(plc), host=host)
    voice.show(document, table_lines(found, faults))
    for warning in host.warnings():
        voice.warn(warning)
    return int(check and bool(faults))


@click.command("check", epilog="Example: fatektool link table check table.toml")
@click.argument("file", type=PATH)
@voice_options
def check_command(file: Path, voice: Voice) -> int:
    """Check the table in FILE: exit 0 if it has no faults, 1 if it has. Needs no PLC."""
    found = load_table(read_bounded(file, MAX_TOML), str(file))
    faults = found.faults()
    host = LinkHost(None, needs_of_table(found))
    voice.show(table_document(found, faults, None, str(file), None, host=host), table_lines(found, faults))
    for need in host.needs:
        voice.say(f"{need.what} needs PLC OS {need.version} or later")
    return 1 if faults else 0


@click.command(
    "save", epilog="Example: fatektool link table save R500 again.toml --kind md0 -p sim:plc.state"
)
@click.argument("sr", metavar="SR")
@click.argument("file", type=PATH)
@kind_option
@click.option("--force", is_flag=True, help="Replace FILE.")
@connection_options
def save_command(sr: str, file: Path, connection: Connection, voice: Voice, *, kind: str, force: bool) -> int:
    """Save the table at SR to FILE, as TOML. Faults are saved as they are, with a warning."""
    start = parse_start(sr, "SR")
    require_place(file, overwrite=force)
    with connection.open(voice) as plc:
        found = read_table(plc, start, TableKind(kind))
        faults = [*place_faults(start, len(found.to_words())), *found.faults()]
        host = read_host(plc, needs_of_table(found))
        document = table_document(found, faults, str(start), str(file), where(plc), host=host)
    write_whole(file, dump_table(found).encode(), overwrite=force)
    count = len(found.to_words())
    voice.show(document, [f"saved {file}: {kind}, {counted(count, 'register')} from {start}"])
    for warning in host.warnings():
        voice.warn(warning)
    if faults:
        check = own_command_line("link", "table", "check", str(file))
        voice.warn(f"the table has {counted(len(faults), 'fault')}; to see them run: {check}")
    return 0
