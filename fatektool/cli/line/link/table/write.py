"""``link table write``: a communication table into the PLC, with a way back."""

from __future__ import annotations

import shlex
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.elements.values import warn_of
from fatektool.cli.line.link.documents import fault_documents, host_document
from fatektool.cli.line.link.table.view import table_lines
from fatektool.cli.shared.addressee import Pace, look, time_row
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.documents import where
from fatektool.cli.shared.options import PATH, yes_option
from fatektool.cli.shared.pairs import apart
from fatektool.cli.shared.places import safety_folder
from fatektool.cli.shared.way_back import RegisterWrite, same_again
from fatektool.errors import DataError, PlcError
from fatektool.files.atomic import read_bounded
from fatektool.jobs.plcports.host import LinkHost, read_host
from fatektool.jobs.plcports.tables import WritePlan, parse_start, plan_write, write_plan
from fatektool.jobs.plcports.toml import MAX_TOML, load_table
from fatektool.plcports.tables import kind_of, place_faults
from fatektool.plcports.versions import needs_of_table

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc
    from fatektool.jobs.elements.writes import NotTaken
    from fatektool.plcports.results import Fault
    from fatektool.plcports.tables import Table
    from fatektool.protocol.elements import Element


@click.command(
    "write", epilog="Example: fatektool link table write press.toml R5000 -p /dev/ttyUSB0 --dry-run"
)
@click.argument("file", type=PATH)
@click.argument("sr", metavar="SR")
@click.option("--dry-run", is_flag=True, help="Show what would be written, and write nothing.")
@click.option("--force", "faulty", is_flag=True, help="Write a table that has faults.")
@click.option(
    "--safety-dir", type=PATH, metavar="DIR", help="Where the words before are saved; by default beside FILE."
)
@click.option("--no-safety-snapshot", is_flag=True, help="Do not save the words before: no way back.")
@yes_option
@connection_options
def write_command(
    file: Path,
    sr: str,
    connection: Connection,
    voice: Voice,
    *,
    dry_run: bool,
    faulty: bool,
    safety_dir: Path | None,
    no_safety_snapshot: bool,
    yes: bool,
) -> int:
    """Put the table in FILE into the PLC, from SR on.

    Only what differs is written; the words before are saved as a safety snapshot first, which 'fatektool
    snapshot apply' puts back, and all is read back. What the PLC does not take is named (exit 4): registers
    that are configured as ROR take nothing. If the line fails on the way (exit 6), the same command finishes
    it.
    """
    apart("no_safety_snapshot", "safety_dir")
    start = parse_start(sr, "SR")
    table = load_table(read_bounded(file, MAX_TOML), str(file))
    folder = None if no_safety_snapshot else safety_folder(safety_dir, file, voice, dry_run=dry_run)
    words = table.to_words()
    faults = [*place_faults(start, len(words)), *table.faults()]
    _require_good(file, table, faults, force=faulty)
    safety: str | None = None
    failed: list[NotTaken] = []
    with connection.open(voice, writes=not dry_run) as plc:
        pace = Pace(plc)
        plan = plan_write(plc, start, words)
        host = read_host(plc, needs_of_table(table))
        if plan.changes and not dry_run:
            voice.require_answer(yes=yes, unchanged="nothing was written")
        for warning in host.warnings():
            voice.warn(warning)
        here = look(plc)
        if plan.changes and not dry_run:
            if plan.present.running:
                voice.warn("the PLC is in RUN: an instruction may use the table while it is half new")
            work = RegisterWrite(
                here,
                plan.present,
                file.stem,
                folder,
                [("file", file), ("to", f"{start}, {len(words)} registers"), time_row(plc, plan, pace)],
                table_lines(table, faults),
                len(plan.changes),
                same_again(connection, "write"),
                "the table was not written whole",
            )
            safety, failed = work.carry_out(voice, partial(write_plan, plc, plan), yes=yes)
        document = _document(
            plc,
            file,
            start,
            table=table,
            faults=faults,
            plan=plan,
            failed=failed,
            safety=safety,
            host=host,
            dry_run=dry_run,
        )
    document |= here.document()
    shown = [*_result_lines(plan, failed, dry_run=dry_run), *([here.line] if plan.changes else [])]
    voice.show(document, shown)
    warn_of({str(each.element): _did_not(each) for each in failed}, voice)
    return PlcError.exit_code if failed else 0


def _require_good(file: Path, table: Table, faults: Sequence[Fault], *, force: bool) -> None:
    if not faults or force:
        return
    first = faults[0]
    place = "" if first.row is None else f"transaction {first.row}: "
    more = f" and {len(faults) - 1} more" if len(faults) > 1 else ""
    raise DataError(
        f"{file}: the table has faults: {place}{first.reason}{more}: nothing was written",
        hint=f"'fatektool link table check {shlex.quote(str(file))}' shows all; --force writes it as it is",
        file=str(file),
        faults=fault_documents(kind_of(table), faults),
    )


def _did_not(each: NotTaken) -> str:
    return each.words(lambda raw: f"{raw:04X}")


def _result_lines(plan: WritePlan, failed: list[NotTaken], *, dry_run: bool) -> Iterator[str]:
    count = len(plan.changes)
    if not count:
        yield "same: nothing was written"
    elif dry_run:
        for change in plan.changes:
            yield f"{change.element}  {change.before:04X} -> {change.after:04X}"
        yield "dry run: nothing was written"
    else:
        yield f"{count - len(failed)} of {count} registers written and read back, {plan.same} were the same"


def _document(
    plc: Plc,
    file: Path,
    start: Element,
    *,
    table: Table,
    faults: Sequence[Fault],
    plan: WritePlan,
    failed: list[NotTaken],
    safety: str | None,
    host: LinkHost,
    dry_run: bool,
) -> dict[str, Any]:
    return {
        "schema": "fatektool.link-write/1",
        **where(plc),
        "os": host_document(host),
        "file": str(file),
        "sr": str(start),
        "kind": kind_of(table).value,
        "dry_run": dry_run,
        "faults": fault_documents(kind_of(table), faults),
        "changes": [
            {
                "element": str(change.element),
                "from": f"{change.before:04X}",
                "to": f"{change.after:04X}",
            }
            for change in plan.changes
        ],
        "same": plan.same,
        "written": 0 if dry_run else len(plan.changes) - len(failed),
        "not_taken": [
            {
                "element": str(each.element),
                "wanted": f"{each.wanted:04X}",
                "got": None if each.got is None else f"{each.got:04X}",
                "reason": each.reason,
            }
            for each in failed
        ],
        "safety_snapshot": safety,
    }
