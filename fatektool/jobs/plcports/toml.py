"""A communication table as TOML, for people to read and to write; both ways, nothing lost.

::

    kind = "md0"                # md3, mbus likewise     kind = "md1"             # md2 likewise
                                                         mode = 0x01
    [[transaction]]                                      start_code = 0x02
    station = 2                                          end_code = 0x03
    command = "read"                                     data = "02 4F 4B 03"     # what is sent
    length = 4
    master = "R0"               # this PLC's             md3 has data = "R32" instead of master and slave
    slave = "R100"              # the other station's    mbus has slave = "400101"

What a table has beside that is written where it is not as usual: ``high_bytes`` (of the words of which the
PLC takes the low byte), ``count_high``, ``mark``, ``row_words``, ``reserved``, ``mode_high``, ``length`` of a
message. A command or type that no paper lists is a number: ``command = 7``, ``master = "20:100"``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import DataError, UsageError
from fatektool.files.plain_text import plain_text
from fatektool.files.strict_toml import read_toml
from fatektool.plcports.checks import CLINK_COMMANDS, HIGH_SPEED_COMMANDS, MBUS_COMMANDS
from fatektool.plcports.kinds import TableKind
from fatektool.plcports.messages import MessageTable
from fatektool.plcports.operands import (
    CLINK_TYPES,
    HIGH_SPEED_TYPES,
    MBUS_MASTER_TYPES,
    MBUS_SLAVE_TYPES,
    TableOperand,
)
from fatektool.plcports.rows import ROW_WORDS, SharedBlock, Transaction
from fatektool.plcports.tables import MBUS_MARK, ClinkTable, HighSpeedTable, MbusTable, Table

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fatektool.plcports.operands import DataType

MAX_TOML: Final = 1 << 20
_ROW_KEYS: Final = ("station", "command", "length", "master", "slave", "high_bytes")
_BLOCK_KEYS: Final = ("station", "command", "length", "data", "reserved", "high_bytes")
_MESSAGE_KEYS: Final = ("kind", "mode", "start_code", "end_code", "length", "data", "mode_high")
_TABLE_KEYS: Final = {
    TableKind.MD0: ("kind", "transaction", "count_high"),
    TableKind.MD3: ("kind", "transaction", "count_high"),
    TableKind.MBUS: ("kind", "transaction", "mark", "row_words", "reserved"),
    TableKind.MD1: _MESSAGE_KEYS,
    TableKind.MD2: _MESSAGE_KEYS,
}


def load_table(data: bytes, name: str) -> Table:
    """Read a table's TOML.

    Args:
        data: the file's bytes.
        name: its name, for messages.

    Raises:
        DataError: invalid TOML, an unknown key, a value that fits no word; says in which transaction, from 0.
    """
    try:
        document = read_toml(plain_text(data))
    except ValueError as error:  # UnicodeDecodeError and TOMLDecodeError among them
        raise DataError(f"{name}: invalid TOML: {error}", file=name) from error
    known = [kind.value for kind in TableKind]
    if document.get("kind") not in known:
        raise DataError(
            f"{name}: kind: expected one of {', '.join(known)}, got {_short(document.get('kind'))}",
            hint='begin with kind = "md0"',
            file=name,
        )
    kind = TableKind(document["kind"])
    part = _Part(document, name, _TABLE_KEYS[kind])
    try:
        if kind in {TableKind.MD1, TableKind.MD2}:
            return _message(part, receiver=kind is TableKind.MD2)
        rows = _rows(document.get("transaction", []), name)
        if kind is TableKind.MD3:
            return HighSpeedTable(tuple(map(_block, rows)), part.number("count_high", 0))
        if kind is TableKind.MD0:
            made = tuple(_row(row, CLINK_COMMANDS, CLINK_TYPES, CLINK_TYPES) for row in rows)
            return ClinkTable(made, part.number("count_high", 0))
        made = tuple(_row(row, MBUS_COMMANDS, MBUS_MASTER_TYPES, MBUS_SLAVE_TYPES) for row in rows)
        reserved = part.number("reserved") if "reserved" in document else None
        marks = part.number("mark", MBUS_MARK), part.number("row_words", ROW_WORDS)
        return MbusTable(made, *marks, reserved)
    except UsageError as error:  # a value that does not fit the table as a whole
        raise DataError(f"{name}: {error.message}", file=name) from error


class _Part:
    """Keys and values of one TOML table, each asked for by its type."""

    def __init__(self, values: Mapping[str, Any], where: str, keys: tuple[str, ...]) -> None:
        self._values = values
        self.where = where
        unknown = sorted(set(values) - set(keys))
        if unknown:
            raise DataError(f"{where}: unknown key {unknown[0]!r:.60}: expected one of {', '.join(keys)}")

    def _get(self, key: str, expected: str) -> Any:
        if key not in self._values:
            raise DataError(f"{self.where}: no {key}: expected {expected}")
        return self._values[key]

    def number(self, key: str, default: int | None = None) -> int:
        """A whole number."""
        value = self._values.get(key, default) if default is not None else self._get(key, "a whole number")
        if type(value) is not int:
            raise DataError(f"{self.where}: {key}: expected a whole number, got {_short(value)}")
        return value

    def text(self, key: str, expected: str) -> str:
        """A text."""
        value = self._get(key, expected)
        if not isinstance(value, str):
            raise DataError(f"{self.where}: {key}: expected {expected}, got {_short(value)}")
        return value

    def numbers(self, key: str, default: tuple[int, ...]) -> tuple[int, ...]:
        """Whole numbers."""
        value = self._values.get(key, list(default))
        if not isinstance(value, list) or not all(type(each) is int for each in value):
            raise DataError(f"{self.where}: {key}: expected whole numbers in brackets, got {_short(value)}")
        return tuple(value)

    def command(self, names: Mapping[int, str]) -> int:
        """A command by its name, or by its number."""
        expected = " or ".join(f'"{name}"' for name in names.values())
        value = self._get("command", expected)
        for code, name in names.items():
            if value == name:
                return code
        if type(value) is not int:
            raise DataError(f"{self.where}: command: expected {expected}, got {_short(value)}")
        return value

    def operand(self, key: str, types: Mapping[int, DataType]) -> TableOperand:
        """A type and a reference."""
        example = '"400001"' if types is MBUS_SLAVE_TYPES else '"R100"'
        text = self.text(key, f"a text such as {example}")
        try:
            return TableOperand.parse(text, types)
        except UsageError as error:
            raise DataError(f"{self.where}: {key}: {error.message}") from error


def _rows(value: object, name: str) -> Iterator[tuple[dict[str, Any], str]]:
    if not isinstance(value, list) or not all(isinstance(entry, dict) for entry in value):
        raise DataError(f"{name}: transaction: expected [[transaction]] tables")
    for number, entry in enumerate(value):
        yield entry, f"{name}: transaction {number}"


def _row(
    row: tuple[dict[str, Any], str],
    commands: Mapping[int, str],
    masters: Mapping[int, DataType],
    slaves: Mapping[int, DataType],
) -> Transaction:
    part = _Part(*row, _ROW_KEYS)
    try:
        return Transaction(
            part.number("station"),
            part.command(commands),
            part.number("length"),
            part.operand("master", masters),
            part.operand("slave", slaves),
            part.numbers("high_bytes", (0,) * 5),
        )
    except UsageError as error:
        raise DataError(f"{part.where}: {error.message}") from error


def _block(row: tuple[dict[str, Any], str]) -> SharedBlock:
    part = _Part(*row, _BLOCK_KEYS)
    try:
        return SharedBlock(
            part.number("station"),
            part.command(HIGH_SPEED_COMMANDS),
            part.number("length"),
            part.operand("data", HIGH_SPEED_TYPES),
            part.numbers("reserved", (0, 0)),
            part.numbers("high_bytes", (0,) * 4),
        )
    except UsageError as error:
        raise DataError(f"{part.where}: {error.message}") from error


def _message(part: _Part, *, receiver: bool) -> MessageTable:
    expected = 'bytes in hex such as "02 4F 4B 03"'
    groups = part.text("data", expected).split()
    for group in groups:
        if len(group) > 4 or not all(digit in "0123456789ABCDEFabcdef" for digit in group):
            raise DataError(f"{part.where}: data: expected {expected}, got {group!r:.60}")
    data = tuple(int(group, 16) for group in groups)
    length = part.number("length", len(data))
    return MessageTable(
        receiver,
        part.number("mode"),
        part.number("start_code", 0),
        part.number("end_code", 0),
        data,
        None if length == len(data) else length,
        part.number("mode_high", 0),
    )


def _short(value: object) -> str:
    try:
        return f"{value!r:.60}"
    except (ValueError, RecursionError):  # a whole number of thousands of digits
        return "a very long number"
