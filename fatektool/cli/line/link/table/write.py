"""``link table write``: write a communication table into the PLC."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.elements.values import warn_of
from fatektool.cli.line.link.documents import changes_document, fault_documents, table_write_document
from fatektool.cli.line.link.table.view import table_lines
from fatektool.cli.shared.addressee import ExchangeTime
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.put_values import (
    change_line,
    not_taken_words,
    offer_of,
    put_values,
    result_lines,
)
from fatektool.cli.shared.write_back import WriteCommand
from fatektool.cli.shared.write_options import Terms, write_options
from fatektool.counts import counted
from fatektool.errors import DataError, PlcError
from fatektool.files.atomic import read_bounded
from fatektool.jobs.plcports.host import read_host
from fatektool.jobs.plcports.tables import parse_start, plan_write
from fatektool.jobs.plcports.toml import MAX_TOML, load_table
from fatektool.plcports.tables import kind_of, place_faults
from fatektool.plcports.versions import needs_of_table
from fatektool.system.shell import own_command_line

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.plcports.results import Fault
    from fatektool.plcports.tables import Table


@click.command("write", epilog="Example: fatektool link table write table.toml R500 -p sim: --dry-run")
@click.argument("file", type=PATH)
@click.argument("sr", metavar="SR")
@click.option("--force", "faulty", is_flag=True, help="Write a table that has faults.")
@write_options("values", "snapshot")
@connection_options
def write_command(
    file: Path, sr: str, connection: Connection, voice: Voice, *, faulty: bool, terms: Terms
) -> int:
    """Write the table in FILE into the PLC, from SR on.

    Only what differs is written. The previous values are saved as a safety snapshot first, which 'fatektool
    snapshot apply' writes back, and all is read back. Values that do not take are named (exit 4): registers
    that are configured as ROR are read-only. If the line fails on the way (exit 6), the same command writes
    what is left.
    """
    start = parse_start(sr, "SR")
    table = load_table(read_bounded(file, MAX_TOML), str(file))
    writing = WriteCommand(connection, voice, terms, file, str(start))
    words = table.to_words()
    faults = [*place_faults(start, len(words)), *table.faults()]
    _require_good(file, table, faults, force=faulty)
    with writing.open() as plc:
        pace = ExchangeTime(plc)
        plan = plan_write(plc, start, words)
        host = read_host(plc, needs_of_table(table))
        writing.require_answer(changes=bool(plan.changes))
        for warning in host.warnings():
            voice.warn(warning)
        if plan.changes and plan.present.running:
            voice.warn("the PLC is in RUN: an instruction may use the table while it is half new")
        rows = [("file", file), ("to", f"{start}, {counted(len(words), 'register')}")]
        offer = offer_of(plc, plan, writing, pace, rows=rows, lines=table_lines(table, faults))
        done = put_values(plc, plan, offer, pace, file.stem)
        changes = changes_document(plan, done, dry_run=terms.dry_run)
        document = table_write_document(plc, file, start, changes, table=table, faults=faults, host=host)
    document |= offer.here.document()
    voice.show(document, result_lines(plan, done, offer, pace, *map(change_line, plan.changes)))
    warn_of(not_taken_words(done), voice)
    return PlcError.exit_code if done.not_taken else 0


def _require_good(file: Path, table: Table, faults: Sequence[Fault], *, force: bool) -> None:
    if not faults or force:
        return
    first = faults[0]
    place = "" if first.row is None else f"transaction {first.row}: "
    more = f" and {len(faults) - 1} more" if len(faults) > 1 else ""
    check = own_command_line("link", "table", "check", str(file))
    raise DataError(
        f"{file}: the table has faults: {place}{first.reason}{more}: nothing was written",
        hint=f"--force writes it as it is; to see all of them run: {check}",
        file=str(file),
        faults=fault_documents(kind_of(table), faults),
    )
