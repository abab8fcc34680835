"""A communication table and its check, as lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.cli.line.frame_view import printable
from fatektool.cli.line.link.documents import row_documents, table_notes
from fatektool.plcports.checks import MBUS_COMMANDS
from fatektool.plcports.codes import meaning
from fatektool.plcports.messages import MessageTable
from fatektool.plcports.tables import HighSpeedTable, Table, kind_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fatektool.plcports.results import Fault

_ARROWS: Final = {1: "<-", 2: "->", 3: "->"}


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


def _row_lines(table: Table, faults: Sequence[Fault]) -> Iterator[str]:
    head = ("no.", "station", "command", "master", "", "slave", "length", "result")
    shared = isinstance(table, HighSpeedTable)
    if shared:
        head = ("no.", "sender", "command", "data", "", "all others", "length", "result")
    arrows = {name: _ARROWS[code] for code, name in MBUS_COMMANDS.items()}
    cells: list[tuple[str, ...]] = [head]
    for row in row_documents(table, faults):
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
    codes = (("start code", table.start_code), ("end code", table.end_code))
    yield f"mode        {table.mode:02X}H, {table.modes.get(table.mode, 'no such mode')}"
    for name, code in codes:
        yield f"{name:<10}  {f'{code:02X}H' if code else 'none'}"
    yield f"length      {table.message_length}"
    if data:
        yield f"data        {data.hex(' ').upper()}"
        yield f"text        {printable(data)}"
