"""``link result``: what WR says of an instruction's last transaction, and what to do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.line.link.host import host_document
from fatektool.cli.shared.documents import where
from fatektool.cli.shared.options import Connection, connection_options
from fatektool.cli.shared.output import Voice, table
from fatektool.jobs.plcports.host import LinkHost, read_host
from fatektool.jobs.plcports.ports import ResultReport, read_result
from fatektool.jobs.plcports.tables import parse_start
from fatektool.plcports.codes import TRANSACTIONS
from fatektool.plcports.kinds import TableKind
from fatektool.plcports.settings import ABNORMAL_STEP, UNWATCHED

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.client import Plc
    from fatektool.plcports.results import TransactionResult
    from fatektool.plcports.settings import HighSpeedLink
    from fatektool.protocol.elements import Element

KINDS = [kind.value for kind in TableKind]


@click.command("result", epilog="Example: fatektool link result R100 --kind md0 -p /dev/ttyUSB0")
@click.argument("wr", metavar="WR")
@click.option(
    "--kind",
    type=click.Choice(KINDS, case_sensitive=False),
    help="CLINK's mode (FUN151), or mbus (FUN150): codes differ by kind. md1 and md2 show what was "
    "received, md3 the errors of the running link.",
)
@click.option(
    "--check",
    is_flag=True,
    help="Exit 1 if the result is not 0, or, of md3, if R4058 or R4059 holds an error.",
)
@connection_options
def result_command(wr: str, connection: Connection, voice: Voice, *, kind: str | None, check: bool) -> int:
    """Explain the registers from operand WR on: result, station, command, where the instruction stands."""
    start = parse_start(wr, "WR")
    with connection.open(voice) as plc:
        report = read_result(plc, start, None if kind is None else TableKind(kind))
        host = read_host(plc)
        document = _document(plc, start, report, host)
    voice.show(document, _lines(report))
    for warning in host.warnings():
        voice.warn(warning)
    if check and report.kind is None and report.good:
        voice.warn("without --kind, 0 proves little: of md3 it says nothing of the stations; name the kind")
    return int(check and not report.good)


def result_document(
    result: TransactionResult,
    meaning: str,
    next_step: str | None,
    *,
    kind: TableKind | None = None,
    alone: bool = False,
) -> dict[str, Any]:
    """WR+0 and WR+1 as JSON has them; ``alone`` where there is a result code and nothing else."""
    return {
        "code": f"{result.code:X}",
        "meaning": meaning,
        "next_step": next_step,
        "transaction": None if alone else result.transaction,
        "station": None if alone else result.station,
        "command": None if alone else f"{result.command:02X}",
        "command_meaning": None if alone else result.command_meaning(kind),
    }


def _is_alone(report: ResultReport) -> bool:
    """True for a kind whose WR+0 has a result code alone, and whose WR+1 is the instruction's own."""
    return report.kind is not None and report.kind not in TRANSACTIONS


def _document(plc: Plc, start: Element, report: ResultReport, host: LinkHost) -> dict[str, Any]:
    operation, high_speed = report.state.operation, report.high_speed
    message = None
    if report.received_length is not None:
        message = {"length": report.received_length, "data": report.received.hex(" ").upper()}
    return {
        "schema": "fatektool.link-result/1",
        **where(plc),
        "os": host_document(host),
        "wr": str(start),
        "kind": None if report.kind is None else report.kind.value,
        "result": result_document(
            report.state.result,
            report.meaning,
            report.next_step,
            kind=report.kind,
            alone=_is_alone(report),
        ),
        "waiting": operation.waiting,
        "repeated": operation.repeated,
        "active": operation.active,
        "error": operation.error,
        "done": operation.done,
        "high_speed_link": None
        if high_speed is None
        else {
            "abnormal_station": high_speed.abnormal_station,
            "abnormal_code": high_speed.abnormal_code,
            "abnormal": high_speed.abnormal,
            "abnormal_count": high_speed.abnormal_count,
        },
        "received": message,
        "words": [f"{word:04X}" for word in report.state.words],
    }


def _lines(report: ResultReport) -> Iterator[str]:
    result, operation = report.state.result, report.state.operation
    rows: list[tuple[str, object]] = [("result", f"{result.code:X}, {report.meaning}")]
    if report.next_step is not None:
        rows.append(("do", report.next_step))
    if not _is_alone(report):
        command = result.command_meaning(report.kind) or "no command of such a transaction"
        rows += [
            ("transaction", result.transaction),
            ("station", result.station),
            ("command", f"{result.command:02X}H, {command}"),
        ]
    if operation.active is not None:
        outputs = {"ACT": operation.active, "ERR": operation.error, "DN": operation.done}
        rows += [
            ("outputs", " ".join(name for name, on in outputs.items() if on) or "none"),
            ("port", "waits for it, another instruction has it" if operation.waiting else "not waited for"),
        ]
    if operation.repeated is not None:
        rows.append(("run", "not the first" if operation.repeated else "the first, or none yet"))
    if report.high_speed is not None:
        rows += abnormal_rows(report.high_speed)
        rows += [] if report.high_speed.good else [("do", ABNORMAL_STEP)]
        rows.append(("note", UNWATCHED))
    if report.received_length is not None:
        data = report.received
        text = "".join(chr(byte) if 0x20 <= byte < 0x7F else "." for byte in data)
        rows.append(("received", f"{report.received_length} bytes"))
        if data:
            rows += [("data", data.hex(" ").upper()), ("text", text)]
    if report.kind is None:
        rows.append(("kind", "not named: --kind says which of these readings holds"))
    yield from table(rows)


def abnormal_rows(link: HighSpeedLink) -> list[tuple[str, object]]:
    """R4058 and R4059 by name and value; None for what the PLC does not have."""
    station, count = link.abnormal_station, link.abnormal_count
    logged = None
    if count is not None:
        logged = f"{count}, {link.abnormal}" if link.abnormal else count
    return [
        ("abnormal station", None if station is None else f"{station or 'none'} (R4058)"),
        ("abnormal answers", None if logged is None else f"{logged} (R4059)"),
    ]
