"""``link result``: the result of an instruction's last transaction, and what to do."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.line.frame_view import printable
from fatektool.cli.line.link.documents import result_document
from fatektool.cli.line.link.kind import KIND
from fatektool.cli.line.link.rows import abnormal_rows
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.output import Voice, table
from fatektool.jobs.plcports.host import read_host
from fatektool.jobs.plcports.ports import ResultReport, read_result
from fatektool.jobs.plcports.tables import parse_start
from fatektool.plcports.kinds import TableKind
from fatektool.plcports.settings import ABNORMAL_STEP, UNWATCHED

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.cli.shared.connection import Connection


@click.command("result", epilog="Example: fatektool link result R100 --kind md0 -p sim:")
@click.argument("wr", metavar="WR")
@click.option(
    "--kind",
    type=KIND,
    help="Mode of CLINK (FUN151), or mbus (FUN150): result codes differ by kind. md1 and md2 also show the "
    "received data, md3 the errors of the running link.",
)
@click.option(
    "--check",
    is_flag=True,
    help="Exit 1 if the result is not 0, or with md3 if R4058 or R4059 has an error.",
)
@connection_options
def result_command(wr: str, connection: Connection, voice: Voice, *, kind: str | None, check: bool) -> int:
    """Explain the registers from operand WR on: result, station, command, state of the instruction."""
    start = parse_start(wr, "WR")
    with connection.open(voice) as plc:
        report = read_result(plc, start, None if kind is None else TableKind(kind))
        host = read_host(plc)
        document = result_document(plc, start, report, host)
    voice.show(document, _lines(report))
    for warning in host.warnings():
        voice.warn(warning)
    if check and report.kind is None and report.good:
        voice.warn(
            "result 0 without --kind is no proof: with md3 it says nothing about the stations; give --kind"
        )
    return int(check and not report.good)


def _lines(report: ResultReport) -> Iterator[str]:
    result, operation = report.state.result, report.state.operation
    rows: list[tuple[str, object]] = [("result", f"{result.code:X}, {report.meaning}")]
    if report.next_step is not None:
        rows.append(("do", report.next_step))
    if not report.code_alone:
        command = result.command_meaning(report.kind) or "not a command of this kind"
        rows += [
            ("transaction", result.transaction),
            ("station", result.station),
            ("command", f"{result.command:02X}H, {command}"),
        ]
    if operation.active is not None:
        outputs = {"ACT": operation.active, "ERR": operation.error, "DN": operation.done}
        rows += [
            ("outputs", " ".join(name for name, on in outputs.items() if on) or "none"),
            ("port", "waiting, another instruction uses it" if operation.waiting else "not waiting"),
        ]
    if operation.repeated is not None:
        rows.append(("run", "second or later" if operation.repeated else "first, or none yet"))
    if report.high_speed is not None:
        rows += abnormal_rows(report.high_speed)
        rows += [] if report.high_speed.good else [("do", ABNORMAL_STEP)]
        rows.append(("note", UNWATCHED))
    if report.received_length is not None:
        data = report.received
        rows.append(("received", f"{report.received_length} bytes"))
        if data:
            rows += [("data", data.hex(" ").upper()), ("text", printable(data))]
    if report.kind is None:
        rows.append(("kind", "not given: --kind selects one of these meanings"))
    yield from table(rows)
