"""``link modem``: the modem of port 1, shown and set."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.elements.values import warn_of
from fatektool.cli.line.link.documents import changes_document, modem_document
from fatektool.cli.line.link.rows import modem_rows
from fatektool.cli.shared.addressee import ExchangeTime
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.output import Voice, table
from fatektool.cli.shared.put_values import (
    change_line,
    not_taken_words,
    offer_of,
    put_values,
    result_lines,
)
from fatektool.cli.shared.write_back import WriteCommand
from fatektool.cli.shared.write_options import Terms, write_options
from fatektool.errors import PlcError
from fatektool.jobs.plcports.host import read_host
from fatektool.jobs.plcports.modem import ModemReport, ModemSettings, plan_modem, read_modem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.cli.shared.connection import Connection


@click.group("modem", epilog="Example: fatektool link modem show -p sim:")
def modem_command() -> None:
    """The modem of port 1, as the PLC's registers set it.

    To call a PLC through a modem on this computer, name it as the target: -p "modem:/dev/ttyUSB0?number=…".
    """


@modem_command.command("show", epilog="Example: fatektool link modem show -p sim:")
@connection_options
def show_command(connection: Connection, voice: Voice) -> int:
    """Show phone number, dialling, auto answer and state of the modem."""
    with connection.open(voice) as plc:
        report = read_modem(plc)
        host = read_host(plc)
        document = modem_document(plc, report, host, None)
    voice.show(document, table(_rows(report)))
    for warning in host.warnings():
        voice.warn(warning)
    warn_of(report.errors, voice)
    return PlcError.exit_code if not report.raw else 0


@modem_command.command(
    "set", epilog="Example: fatektool link modem set --number 02-28082192 --modem-on --tone -p sim: --yes"
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
@write_options("values", "snapshot", "in this folder")
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
    terms: Terms,
) -> int:
    """Set the modem: what is named, and nothing else.

    Only what differs is written. The previous values are saved as a safety snapshot first, which 'fatektool
    snapshot apply' writes back, and all is read back. Values that do not take are named (exit 4). If the line
    fails on the way (exit 6), the same command writes what is left. A call through that modem itself may end
    when its settings change.
    """
    settings = ModemSettings(
        number, on, pulse, rings, dial_control, None if profile is None else int(profile == "user")
    )
    writing = WriteCommand(connection, voice, terms, None, repr(settings))
    with writing.open() as plc:
        pace = ExchangeTime(plc)
        plan = plan_modem(plc, settings)
        host = read_host(plc)
        writing.require_answer(changes=bool(plan.changes))
        for warning in host.warnings():
            voice.warn(warning)
        offer = offer_of(plc, plan, writing, pace, rows=[], lines=map(change_line, plan.changes))
        done = put_values(plc, plan, offer, pace, "modem")
        report = read_modem(plc)
        changes = changes_document(plan, done, dry_run=terms.dry_run)
        document = modem_document(plc, report, host, changes)
    document |= offer.here.document()
    voice.show(document, [*result_lines(plan, done, offer, pace), *table(_rows(report))])
    warn_of(not_taken_words(done), voice)
    return PlcError.exit_code if done.not_taken else 0


def _rows(report: ModemReport) -> Iterator[tuple[str, object]]:
    for name, value in modem_rows(report.modem):
        yield name, "-" if value is None else value
