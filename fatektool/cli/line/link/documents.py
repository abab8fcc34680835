"""The JSON documents of ``link``, and their parts."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from fatektool.cli.shared.documents import where
from fatektool.jobs.plcports.ports import kept_meaning, kept_next_step
from fatektool.plcports.checks import CLINK_COMMANDS, HIGH_SPEED_COMMANDS, MBUS_COMMANDS
from fatektool.plcports.codes import meaning
from fatektool.plcports.messages import MessageTable
from fatektool.plcports.operands import CLINK_TYPES, HIGH_SPEED_TYPES, MBUS_MASTER_TYPES, MBUS_SLAVE_TYPES
from fatektool.plcports.settings import UNWATCHED
from fatektool.plcports.tables import HighSpeedTable, MbusTable, Table, kind_of
from fatektool.protocol.values import raw_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.jobs.plcports.host import LinkHost
    from fatektool.jobs.plcports.modem import ModemReport
    from fatektool.jobs.plcports.ports import PortsReport, ResultReport
    from fatektool.jobs.snapshots.write_values import ValuesPlan, Written
    from fatektool.plcports.kinds import TableKind
    from fatektool.plcports.results import Fault, TransactionResult
    from fatektool.protocol.elements import Element


def host_document(host: LinkHost) -> dict[str, Any]:
    """The key ``os`` of the documents of ``link``."""
    return {
        "version": host.os_version,
        "fbs": host.fbs,
        "needs": [
            {"what": need.what, "version": need.version, "met": need.met(host.os_version)}
            for need in host.needs
        ],
    }


def ports_document(plc: Plc, report: PortsReport) -> dict[str, Any]:
    """``fatektool.link-ports/1``."""
    return {
        "schema": "fatektool.link-ports/1",
        **where(plc),
        "os": host_document(report.host),
        "ports": [
            asdict(port)
            | {
                "parameters": _hex(port.parameters),
                "last_result": None if port.last_result is None else _kept_document(port.last_result),
            }
            for port in report.ports
        ],
        "message_detection": asdict(report.detection),
        "high_speed_link": asdict(report.high_speed)
        | {"abnormal": report.high_speed.abnormal, "parameters": _hex(report.high_speed.parameters)},
        "modem": asdict(report.modem),
        "registers": {
            name: bool(value) if name.startswith("M") else f"{value:04X}"
            for name, value in report.raw.items()
        },
        "errors": report.errors,
    }


def _kept_document(result: TransactionResult) -> dict[str, Any]:
    return _transaction(result, kept_meaning(result), kept_next_step(result))


def _hex(word: int | None) -> str | None:
    return None if word is None else f"{word:04X}"


def _transaction(
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


def result_document(plc: Plc, start: Element, report: ResultReport, host: LinkHost) -> dict[str, Any]:
    """``fatektool.link-result/1``."""
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
        "result": _transaction(
            report.state.result,
            report.meaning,
            report.next_step,
            kind=report.kind,
            alone=report.code_alone,
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


def table_document(
    table: Table,
    faults: Sequence[Fault],
    start: str | None,
    file: str | None,
    place: dict[str, Any] | None,
    *,
    host: LinkHost,
) -> dict[str, Any]:
    """``fatektool.link-table/1``.

    Args:
        table: the table.
        faults: what is wrong with it.
        start: operand SR; None for a table in a file.
        file: the file; None for a table in a PLC.
        place: when and where it was read; None for a table in a file.
        host: the PLC; one of which nothing is known for a table in a file.
    """
    message = None
    if isinstance(table, MessageTable):
        message = {
            "mode": table.mode,
            "mode_meaning": table.modes.get(table.mode),
            "start_code": table.start_code,
            "end_code": table.end_code,
            "length": table.message_length,
            "data": table.message.hex(" ").upper(),
        }
    return {
        "schema": "fatektool.link-table/1",
        **(place or {"time": None, "target": None, "station": None, "protocol": None}),
        "os": host_document(host),
        "sr": start,
        "file": file,
        "kind": kind_of(table).value,
        "ok": not faults,
        "faults": fault_documents(kind_of(table), faults),
        "transactions": None if message else row_documents(table, faults),
        "message": message,
        "notes": [note.removeprefix("note: ") for note in table_notes(table)],
        "words": [f"{word:04X}" for word in table.to_words()],
    }


def fault_documents(kind: TableKind, faults: Iterable[Fault]) -> list[dict[str, Any]]:
    """Faults of a table of this kind as JSON has them."""
    return [
        {
            "transaction": fault.row,
            "code": None if fault.code is None else f"{fault.code:X}",
            "meaning": None if fault.code is None else meaning(fault.code, [kind]),
            "reason": fault.reason,
        }
        for fault in faults
    ]


def row_documents(table: Table, faults: Iterable[Fault]) -> list[dict[str, Any]]:
    """Each transaction in words, with the result code that it would give."""
    codes: dict[int, str | None] = {}
    for fault in faults:
        if fault.row is not None and codes.get(fault.row) is None:
            codes[fault.row] = None if fault.code is None else f"{fault.code:X}"
    rows = []
    if isinstance(table, HighSpeedTable):
        for number, block in enumerate(table.rows):
            data = block.data.written(HIGH_SPEED_TYPES)
            command = HIGH_SPEED_COMMANDS.get(block.command, str(block.command))
            rows.append((number, block.station, command, block.length, data, data))
    elif not isinstance(table, MessageTable):
        mbus = isinstance(table, MbusTable)
        masters, slaves = (MBUS_MASTER_TYPES, MBUS_SLAVE_TYPES) if mbus else (CLINK_TYPES, CLINK_TYPES)
        commands = MBUS_COMMANDS if mbus else CLINK_COMMANDS
        for number, row in enumerate(table.rows):
            command = commands.get(row.command, str(row.command))
            master, slave = row.master.written(masters), row.slave.written(slaves)
            rows.append((number, row.station, command, row.length, master, slave))
    names = ("transaction", "station", "command", "length", "master", "slave")
    return [dict(zip(names, row, strict=True)) | {"code": codes.get(row[0], "0")} for row in rows]


def table_notes(table: Table) -> list[str]:
    """What the paper says of a table of this kind that no check of its rows can find."""
    if not isinstance(table, HighSpeedTable) or not table.rows:
        return []
    senders = sorted({row.station for row in table.rows})
    listed = ", ".join(map(str, senders))
    alone = (
        [f"note: only station {listed} sends: if it is the master, no absent slave is detected at all"]
        if len(senders) == 1
        else []
    )
    watched = f"note: {UNWATCHED} (senders here: {listed}); let the receiving PLC watch a bit that changes"
    procedure = "note: when the link runs, write 0 to R4058 until it stays 0: then the network works"
    return [*alone, watched, f"{procedure}; 'fatektool link result WR --kind md3' shows R4058 and R4059"]


def modem_document(
    plc: Plc, report: ModemReport, host: LinkHost, changes: dict[str, Any] | None
) -> dict[str, Any]:
    """``fatektool.link-modem/1``; ``changes`` are those of ``set``, None for ``show``."""
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
        "set": changes,
    }


def table_write_document(
    plc: Plc,
    file: Path,
    start: Element,
    changes: dict[str, Any],
    *,
    table: Table,
    faults: Sequence[Fault],
    host: LinkHost,
) -> dict[str, Any]:
    """``fatektool.link-write/1``: the table as in ``table_document``, and ``changes`` of its registers."""
    return {
        "schema": "fatektool.link-write/1",
        **where(plc),
        "os": host_document(host),
        "file": str(file),
        "sr": str(start),
        "kind": kind_of(table).value,
        "faults": fault_documents(kind_of(table), faults),
        **changes,
    }


def changes_document(plan: ValuesPlan, done: Written, *, dry_run: bool) -> dict[str, Any]:
    """What was to be written and what came of it, for JSON, in hex."""
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
        "written": 0 if dry_run else len(plan.changes) - len(done.not_taken),
        "not_taken": [
            {
                "element": str(each.element),
                "wanted": raw_text(each.wanted, each.element.kind.bits),
                "got": None if each.got is None else raw_text(each.got, each.element.kind.bits),
                "reason": each.reason,
            }
            for each in done.not_taken
        ],
        "safety_snapshot": None if done.safety is None else str(done.safety),
    }
