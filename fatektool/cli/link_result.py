"""``link result``: what WR says of an instruction's last transaction, and what to do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.documents import where
from fatektool.cli.options import Connection, connection_options
from fatektool.cli.output import Voice, table
from fatektool.jobs.link_ports import ResultReport, read_result
from fatektool.jobs.link_table import parse_start
from fatektool.protocol.link_tables import TableKind

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.client import Plc
    from fatektool.protocol.elements import Element
    from fatektool.protocol.link_results import TransactionResult

KINDS = [kind.value for kind in TableKind]
_MESSAGES = {"md1", "md2"}
_RESULT_ALONE = {*_MESSAGES, "md3"}
"""Kinds whose WR+0 has a result code alone, and whose WR+1 is the instruction's own."""


@click.command("result", epilog="Example: fatektool link result R100 -p /dev/ttyUSB0")
@click.argument("wr", metavar="WR")
@click.option(
    "--kind",
    type=click.Choice(KINDS, case_sensitive=False),
    help="What the instruction does; md1 and md2 show what was received.",
)
@click.option("--check", is_flag=True, help="Exit 1 if the result is not 0.")
@connection_options
def result_command(wr: str, connection: Connection, voice: Voice, *, kind: str | None, check: bool) -> int:
    """Explain the registers from operand WR on: result, station, command, where the instruction stands."""
    start = parse_start(wr, "WR")
    with connection.open(voice) as plc:
        report = read_result(plc, start, message=kind in _MESSAGES)
        document = _document(plc, start, kind, report)
    voice.show(document, _lines(report, kind))
    return int(check and report.state.result.code != 0)


def result_document(result: TransactionResult, *, alone: bool = False) -> dict[str, Any]:
    """WR+0 and WR+1 as JSON has them; ``alone`` where there is a result code and nothing else."""
    return {
        "code": f"{result.code:X}",
        "meaning": result.meaning,
        "next_step": result.next_step,
        "transaction": None if alone else result.transaction,
        "station": None if alone else result.station,
        "command": None if alone else f"{result.command:02X}",
        "command_meaning": None if alone else result.command_meaning,
    }


def _document(plc: Plc, start: Element, kind: str | None, report: ResultReport) -> dict[str, Any]:
    operation = report.state.operation
    message = None
    if report.received_length is not None:
        message = {"length": report.received_length, "data": report.received.hex(" ").upper()}
    return {
        "schema": "fatektool.link-result/1",
        **where(plc),
        "wr": str(start),
        "kind": kind,
        "result": result_document(report.state.result, alone=kind in _RESULT_ALONE),
        "waiting": operation.waiting,
        "repeated": operation.repeated,
        "active": operation.active,
        "error": operation.error,
        "done": operation.done,
        "received": message,
        "words": [f"{word:04X}" for word in report.state.words],
    }


def _lines(report: ResultReport, kind: str | None) -> Iterator[str]:
    result, operation = report.state.result, report.state.operation
    rows: list[tuple[str, object]] = [("result", f"{result.code:X}, {result.meaning}")]
    if result.next_step is not None:
        rows.append(("do", result.next_step))
    if kind not in _RESULT_ALONE:
        command = result.command_meaning or "no command of a transaction"
        rows += [
            ("transaction", result.transaction),
            ("station", result.station),
            ("command", f"{result.command:02X}H, {command}"),
        ]
    outputs = {"ACT": operation.active, "ERR": operation.error, "DN": operation.done}
    rows += [
        ("outputs", " ".join(name for name, on in outputs.items() if on) or "none"),
        ("port", "waits for it, another instruction has it" if operation.waiting else "not waited for"),
        ("run", "not the first" if operation.repeated else "the first, or none yet"),
    ]
    if report.received_length is not None:
        data = report.received
        text = "".join(chr(byte) if 0x20 <= byte < 0x7F else "." for byte in data)
        rows.append(("received", f"{report.received_length} bytes"))
        if data:
            rows += [("data", data.hex(" ").upper()), ("text", text)]
    yield from table(rows)
