"""A communication table and its check, as a document and as lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.cli.line.link.host import host_document
from fatektool.plcports.checks import CLINK_COMMANDS, HIGH_SPEED_COMMANDS, MBUS_COMMANDS
from fatektool.plcports.codes import meaning
from fatektool.plcports.messages import MessageTable
from fatektool.plcports.operands import CLINK_TYPES, HIGH_SPEED_TYPES, MBUS_MASTER_TYPES, MBUS_SLAVE_TYPES
from fatektool.plcports.settings import UNWATCHED
from fatektool.plcports.tables import HighSpeedTable, MbusTable, Table, kind_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from fatektool.jobs.plcports.host import LinkHost
    from fatektool.plcports.kinds import TableKind
    from fatektool.plcports.results import Fault

_ARROWS: Final = {1: "<-", 2: "->", 3: "->"}


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
        "transactions": None if message else _rows(table, faults),
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


def _rows(table: Table, faults: Iterable[Fault]) -> list[dict[str, Any]]:
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


def table_lines(table: Table, faults: Sequence[Fault]) -> Iterator[str]:
    """The table for people: rows, then what is wrong with them."""
    if isinstance(table, MessageTable):
        yield from _message_lines(table)
    else:
        yield from _row_lines(table, faults)
    for fault in faults:
        place = "table" if fault.row is None else f"transaction {fault.row}"
        said = "" if fault.code is None else meaning(fault.code, [kind_of(table)])
        code = "" if fault.code is None else f" (result {fault.code:X}: {said})"
        yield f"{place}: {fault.reason}{code}"
    if not faults:
        yield "all within the documented ranges"
    yield from table_notes(table)


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


def _row_lines(table: Table, faults: Sequence[Fault]) -> Iterator[str]:
    head = ("no.", "station", "command", "master", "", "slave", "length", "result")
    shared = isinstance(table, HighSpeedTable)
    if shared:
        head = ("no.", "sender", "command", "data", "", "all others", "length", "result")
    arrows = {name: _ARROWS[code] for code, name in MBUS_COMMANDS.items()}
    cells: list[tuple[str, ...]] = [head]
    for row in _rows(table, faults):
        station = "all" if row["station"] == 0 and not shared else row["station"]
        arrow = "->" if shared else arrows.get(row["command"], "?")
        code = "?" if row["code"] is None else row["code"]
        found = (row["transaction"], station, row["command"], row["master"], arrow, row["slave"])
        cells.append(tuple(map(str, (*found, row["length"], code))))
    widths = [max(len(line[column]) for line in cells) for column in range(len(head))]
    for line in cells:
        yield "  ".join(f"{cell:<{width}}" for cell, width in zip(line, widths, strict=True)).rstrip()


def _message_lines(table: MessageTable) -> Iterator[str]:
    data = table.message
    text = "".join(chr(byte) if 0x20 <= byte < 0x7F else "." for byte in data)
    codes = (("start code", table.start_code), ("end code", table.end_code))
    yield f"mode        {table.mode:02X}H, {table.modes.get(table.mode, 'no such mode')}"
    for name, code in codes:
        yield f"{name:<10}  {f'{code:02X}H' if code else 'none'}"
    yield f"length      {table.message_length}"
    if data:
        yield f"data        {data.hex(' ').upper()}"
        yield f"text        {text}"
