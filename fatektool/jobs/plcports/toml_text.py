"""A communication table as the text of a TOML file; ``link_toml`` shows the form, and reads it.

What is as usual is left out, so that a table that people wrote comes back as they wrote it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.plcports.checks import CLINK_COMMANDS, HIGH_SPEED_COMMANDS, MBUS_COMMANDS
from fatektool.plcports.messages import MessageTable
from fatektool.plcports.operands import CLINK_TYPES, HIGH_SPEED_TYPES, MBUS_MASTER_TYPES, MBUS_SLAVE_TYPES
from fatektool.plcports.rows import ROW_WORDS, SharedBlock, Transaction
from fatektool.plcports.tables import MBUS_MARK, ClinkTable, HighSpeedTable, MbusTable, Table, kind_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fatektool.plcports.operands import DataType


def dump_table(table: Table) -> str:
    """A table as TOML, as ``load_table`` reads it."""
    return "\n".join([*_lines(table), ""])


def _lines(table: Table) -> Iterator[str]:
    yield f'kind = "{kind_of(table).value}"'
    match table:
        case MessageTable():
            yield from _message_lines(table)
        case ClinkTable():
            yield from _unusual("count_high", table.count_high, 0)
            for row in table.rows:
                yield from _row_lines(row, CLINK_COMMANDS, CLINK_TYPES, CLINK_TYPES)
        case HighSpeedTable():
            yield from _unusual("count_high", table.count_high, 0)
            for block in table.rows:
                yield from _block_lines(block)
        case MbusTable():
            yield from _unusual("mark", table.mark, MBUS_MARK)
            yield from _unusual("row_words", table.row_words, ROW_WORDS)
            yield from _unusual("reserved", table.reserved, None)
            for row in table.rows:
                yield from _row_lines(row, MBUS_COMMANDS, MBUS_MASTER_TYPES, MBUS_SLAVE_TYPES)


def _unusual(key: str, value: int | None, usual: int | None) -> Iterator[str]:
    if value is not None and value != usual:
        yield f"{key} = 0x{value:02X}"


def _head(row: Transaction | SharedBlock, commands: Mapping[int, str]) -> Iterator[str]:
    name = commands.get(row.command)
    yield ""
    yield "[[transaction]]"
    yield f"station = {row.station}"
    yield f"command = {row.command}" if name is None else f'command = "{name}"'
    yield f"length = {row.length}"


def _row_lines(
    row: Transaction,
    commands: Mapping[int, str],
    masters: Mapping[int, DataType],
    slaves: Mapping[int, DataType],
) -> Iterator[str]:
    yield from _head(row, commands)
    yield f'master = "{row.master.written(masters)}"'
    yield f'slave = "{row.slave.written(slaves)}"'
    yield from _high_bytes(row)


def _block_lines(row: SharedBlock) -> Iterator[str]:
    yield from _head(row, HIGH_SPEED_COMMANDS)
    yield f'data = "{row.data.written(HIGH_SPEED_TYPES)}"'
    if any(row.reserved):
        yield f"reserved = {list(row.reserved)}"
    yield from _high_bytes(row)


def _high_bytes(row: Transaction | SharedBlock) -> Iterator[str]:
    if any(row.high_bytes):
        yield f"high_bytes = {list(row.high_bytes)}"


def _message_lines(table: MessageTable) -> Iterator[str]:
    yield f"mode = 0x{table.mode:02X}  # {table.modes.get(table.mode, 'no such mode')}"
    yield from _unusual("mode_high", table.mode_high, 0)
    yield f"start_code = 0x{table.start_code:02X}"
    yield f"end_code = 0x{table.end_code:02X}"
    if table.message_length != len(table.data):
        yield f"length = {table.message_length}"
    words = (f"{word:02X}" if word < 0x100 else f"{word:04X}" for word in table.data)
    yield f'data = "{" ".join(words)}"'
