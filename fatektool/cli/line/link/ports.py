"""``link ports``: the state and settings of the communication ports."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.elements.values import warn_of
from fatektool.cli.line.link.documents import ports_document
from fatektool.cli.line.link.rows import detection_rows, high_speed_rows, modem_rows, port_rows
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.output import Voice, table
from fatektool.jobs.plcports.ports import PortsReport, read_ports

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.cli.shared.connection import Connection


@click.command("ports", epilog="Example: fatektool link ports -p sim:")
@connection_options
def ports_command(connection: Connection, voice: Voice) -> int:
    """Show the communication ports 1 to 4: state, protocol, time-outs, last result; high-speed link, modem.

    A register that this model does not have is shown as '-'; -v names it.
    """
    with connection.open(voice) as plc:
        report = read_ports(plc)
        document = ports_document(plc, report)
    voice.show(document, _lines(report))
    for warning in report.host.warnings():
        voice.warn(warning)
    if voice.verbose:
        warn_of(report.errors, voice)
    elif report.errors:
        voice.say(f"{len(report.errors)} of the registers are not in this PLC; -v names them")
    return 0


def _lines(report: PortsReport) -> Iterator[str]:
    for port in report.ports:
        yield from _block(f"port {port.number}", port_rows(port))
    yield from _block("messages", detection_rows(report.detection))
    yield from _block("high-speed link (port 2)", high_speed_rows(report.high_speed))
    yield from _block("modem (port 1)", modem_rows(report.modem))


def _block(title: str, rows: list[tuple[str, object]]) -> Iterator[str]:
    yield title
    for line in table((name, "-" if value is None else value) for name, value in rows):
        yield f"  {line}"
