"""``link modem``: the modem of port 1, shown and set."""

from __future__ import annotations

from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.elements.values import warn_of
from fatektool.cli.line.link.documents import host_document
from fatektool.cli.line.link.rows import modem_rows
from fatektool.cli.shared.addressee import Pace, look, time_row
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.documents import where
from fatektool.cli.shared.options import PATH, yes_option
from fatektool.cli.shared.output import Voice, table
from fatektool.cli.shared.pairs import apart
from fatektool.cli.shared.places import safety_folder
from fatektool.cli.shared.way_back import RegisterWrite, same_again
from fatektool.errors import PlcError
from fatektool.jobs.plcports.host import LinkHost, read_host
from fatektool.jobs.plcports.modem import ModemReport, ModemSettings, plan_modem, read_modem, write_modem
from fatektool.protocol.values import raw_text

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.client import Plc
    from fatektool.jobs.elements.writes import NotTaken
    from fatektool.jobs.plcports.tables import RegisterChange, WritePlan


@click.group("modem", epilog="Example: fatektool link modem show -p /dev/ttyUSB0")
def modem_command() -> None:
    """The modem of port 1, as the PLC's registers set it.

    To call a PLC through a modem on this computer, name it as the target: -p 'modem:/dev/ttyUSB0?number=…'.
    """


@modem_command.command("show", epilog="Example: fatektool link modem show -p /dev/ttyUSB0")
@connection_options
def show_command(connection: Connection, voice: Voice) -> int:
    """Show phone number, dialling, auto answer and state of the modem."""
    with connection.open(voice) as plc:
        report = read_modem(plc)
        host = read_host(plc)
        document = _document(plc, report, None, host)
    voice.show(document, table(_rows(report)))
    for warning in host.warnings():
        voice.warn(warning)
    warn_of(report.errors, voice)
    return PlcError.exit_code if not report.raw else 0


@modem_command.command(
    "set", epilog="Example: fatektool link modem set --number 02-28082192 --modem-on --tone -p /dev/ttyUSB0"
)
@click.option("--number", metavar="NUMBER", help="To call: digits, ',' for a pause, '#', '*' (R4140-R4145).")
@click.option("--modem-on/--modem-off", "on", default=None, help="A modem is on port 1, or not (R4149).")
@click.option("--pulse/--tone", "pulse", default=None, help="How it dials (M1959).")
@click.option(
    "--auto-answer",
    "rings",
    type=click.IntRange(0, 255),
    metavar="N",
    help="Rings before it answers (R4163).",
)
@click.option(
    "--dial-control",
    type=click.IntRange(1, 4),
    metavar="N",
    help="1: waits for no tone, 2: dial tone, 3: busy tone, 4: both (R4163).",
)
@click.option(
    "--profile",
    type=click.Choice(["factory", "user"]),
    help="The modem's settings: AT&F or AT&Y (R4163).",
)
@click.option("--dry-run", is_flag=True, help="Show what would be written, and write nothing.")
@click.option(
    "--safety-dir", type=PATH, metavar="DIR", help="Where the values before are saved; by default here."
)
@click.option("--no-safety-snapshot", is_flag=True, help="Do not save the values before: no way back.")
@yes_option
@connection_options
def set_command(
    connection: Connection,
    voice: Voice,
    *,
    number: str | None,
    on: bool | None,
    pulse: bool | None,
    rings: int | None,
    dial_control: int | None,
    profile: str | None,
    dry_run: bool,
    safety_dir: Path | None,
    no_safety_snapshot: bool,
    yes: bool,
) -> int:
    """Set the modem: what is named, and nothing else.

    Only what differs is written; the values before are saved as a safety snapshot first, which 'fatektool
    snapshot apply' puts back, and all is read back. What the PLC does not take is named (exit 4). If the line
    fails on the way (exit 6), the same command finishes it. A call through that modem itself may end when its
    settings change.
    """
    apart("no_safety_snapshot", "safety_dir")
    folder = None if no_safety_snapshot else safety_folder(safety_dir, None, voice, dry_run=dry_run)
    settings = ModemSettings(
        number, on, pulse, rings, dial_control, None if profile is None else int(profile == "user")
    )
    safety: str | None = None
    failed: list[NotTaken] = []
    with connection.open(voice, writes=not dry_run) as plc:
        pace = Pace(plc)
        plan = plan_modem(plc, settings)
        host = read_host(plc)
        if plan.changes and not dry_run:
            voice.require_answer(yes=yes, unchanged="nothing was written")
        for warning in host.warnings():
            voice.warn(warning)
        here = look(plc)
        if plan.changes and not dry_run:
            work = RegisterWrite(
                here,
                plan.present,
                "modem",
                folder,
                [time_row(plc, plan, pace)],
                map(_change_line, plan.changes),
                len(plan.changes),
                same_again(connection, "set"),
                "the modem was not set whole",
            )
            safety, failed = work.carry_out(voice, partial(write_modem, plc, plan), yes=yes)
        report = read_modem(plc)
        document = _document(plc, report, _set_document(plan, failed, safety=safety, dry_run=dry_run), host)
    document |= here.document()
    shown = [*_set_lines(plan, failed, report, dry_run=dry_run), *([here.line] if plan.changes else [])]
    voice.show(document, shown)
    warn_of({str(each.element): _did_not(each) for each in failed}, voice)
    return PlcError.exit_code if failed else 0


def _rows(report: ModemReport) -> Iterator[tuple[str, object]]:
    for name, value in modem_rows(report.modem):
        yield name, "-" if value is None else value


def _change_line(change: RegisterChange) -> str:
    bits = change.element.kind.bits
    return f"{change.element}  {raw_text(change.before, bits)} -> {raw_text(change.after, bits)}"


def _set_lines(
    plan: WritePlan, failed: list[NotTaken], report: ModemReport, *, dry_run: bool
) -> Iterator[str]:
    count = len(plan.changes)
    if not count:
        yield "same: nothing was written"
    elif dry_run:
        yield from map(_change_line, plan.changes)
        yield "dry run: nothing was written"
    else:
        yield f"{count - len(failed)} of {count} values written and read back, {plan.same} were the same"
    yield from table(_rows(report))


def _did_not(each: NotTaken) -> str:
    bits = each.element.kind.bits
    return each.words(lambda raw: raw_text(raw, bits))


def _document(
    plc: Plc, report: ModemReport, written: dict[str, Any] | None, host: LinkHost
) -> dict[str, Any]:
    return {
        "schema": "fatektool.link-modem/1",
        **where(plc),
        "os": host_document(host),
        "modem": asdict(report.modem),
        "registers": {
            name: bool(value) if name.startswith("M") else f"{value:04X}"
            for name, value in report.raw.items()
        },
        "errors": report.errors,
        "set": written,
    }


def _set_document(
    plan: WritePlan, failed: list[NotTaken], *, safety: str | None, dry_run: bool
) -> dict[str, Any]:
    return {
        "dry_run": dry_run,
        "changes": [
            {
                "element": str(change.element),
                "from": raw_text(change.before, change.element.kind.bits),
                "to": raw_text(change.after, change.element.kind.bits),
            }
            for change in plan.changes
        ],
        "same": plan.same,
        "written": 0 if dry_run else len(plan.changes) - len(failed),
        "not_taken": [
            {
                "element": str(each.element),
                "wanted": raw_text(each.wanted, each.element.kind.bits),
                "got": None if each.got is None else raw_text(each.got, each.element.kind.bits),
                "reason": each.reason,
            }
            for each in failed
        ],
        "safety_snapshot": safety,
    }
