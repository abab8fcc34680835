"""Communication tables: the registers from operand SR on, as words and as rows.

FBs link paper, sections 13.1.2 (CLINK, FUN151) and 13.2.2 (M-BUS, FUN150)::

    md0   count                   7 words each row              data of CPU link stations
    md3   count                   7 words each row              high-speed link, only port 2
    mbus  A550H  07H|count        7 words each row  reserved    data of Modbus slaves
    md1   mode   start|end code   length   1 byte each word     send, perhaps receive: any protocol
    md2   mode   start|end code   length   1 byte each word     receive, perhaps reply: any protocol

Nothing of a table is lost: high bytes that the PLC ignores, reserved words and unlisted codes are kept, so
that words -> table -> words is the identity. ``faults`` returns the faults of a table.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Generic, TypeVar

from fatektool.errors import DataError
from fatektool.plcports.checks import check_clink, check_high_speed, check_mbus
from fatektool.plcports.kinds import TableKind, misplaced
from fatektool.plcports.messages import MAX_MESSAGE, MessageTable
from fatektool.plcports.operands import require_range
from fatektool.plcports.results import Fault
from fatektool.plcports.rows import ROW_WORDS, SharedBlock, Transaction

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fatektool.protocol.elements import Element


R = TypeVar("R", Transaction, SharedBlock)

MBUS_MARK: Final = 0xA550
_NO_ROWS: Final = Fault(None, None, "the table has no transactions")


@dataclass(frozen=True, slots=True)
class CountedTable(ABC, Generic[R]):
    """A word with the number of rows, then the rows.

    Attributes:
        rows: 0 to 255 transactions or blocks.
        count_high: the high byte of the count, which the PLC ignores.
    """

    rows: tuple[R, ...]
    count_high: int = 0

    def __post_init__(self) -> None:
        _require_count(len(self.rows), self.count_high)

    def to_words(self) -> tuple[int, ...]:
        """The contents of the registers from SR on."""
        return self.count_high << 8 | len(self.rows), *(word for row in self.rows for word in row.to_words())

    def faults(self) -> list[Fault]:
        """Everything that the paper does not allow."""
        found = [fault for number, row in enumerate(self.rows) for fault in self._check(number, row)]
        return found if self.rows else [_NO_ROWS]

    @abstractmethod
    def _check(self, number: int, row: R) -> Iterable[Fault]:
        """Everything that the paper does not allow in one row."""


class ClinkTable(CountedTable[Transaction]):
    """MD0: transactions."""

    __slots__ = ()

    def _check(self, number: int, row: Transaction) -> Iterable[Fault]:
        return check_clink(number, row)


class HighSpeedTable(CountedTable[SharedBlock]):
    """MD3: blocks."""

    __slots__ = ()

    def _check(self, number: int, row: SharedBlock) -> Iterable[Fault]:
        return check_high_speed(number, row)


@dataclass(frozen=True, slots=True)
class MbusTable:
    """M-BUS.

    Attributes:
        rows: 0 to 255 transactions.
        mark: SR+0, A550H in a valid table.
        row_words: the high byte of SR+1, 7 in a valid table.
        reserved: the word after the last row; None to leave it unchanged.
    """

    rows: tuple[Transaction, ...]
    mark: int = MBUS_MARK
    row_words: int = ROW_WORDS
    reserved: int | None = None

    def __post_init__(self) -> None:
        _require_count(len(self.rows), self.row_words)
        require_range("mark", self.mark, 0xFFFF)
        require_range("reserved", self.reserved or 0, 0xFFFF)

    def to_words(self) -> tuple[int, ...]:
        """The contents of the registers from SR on."""
        words = [self.mark, self.row_words << 8 | len(self.rows)]
        words += [word for row in self.rows for word in row.to_words()]
        return tuple(words) if self.reserved is None else (*words, self.reserved)

    def faults(self) -> list[Fault]:
        """Everything that the paper does not allow."""
        found = []
        if self.mark != MBUS_MARK:
            found.append(Fault(None, 8, f"SR+0: expected A550, got {self.mark:04X}"))
        if self.row_words != ROW_WORDS:
            found.append(Fault(None, 8, f"SR+1: expected a high byte of 07, got {self.row_words:02X}"))
        found += [fault for number, row in enumerate(self.rows) for fault in check_mbus(number, row)]
        return found if self.rows else [*found, _NO_ROWS]


Table = ClinkTable | HighSpeedTable | MbusTable | MessageTable


def kind_of(table: Table) -> TableKind:
    """The instruction and mode of a table."""
    match table:
        case ClinkTable():
            return TableKind.MD0
        case HighSpeedTable():
            return TableKind.MD3
        case MbusTable():
            return TableKind.MBUS
        case MessageTable(receiver=receiver):
            return TableKind.MD2 if receiver else TableKind.MD1


def table_words(kind: TableKind, head: Sequence[int]) -> int:
    """The number of words of a table, including the word that M-BUS reserves.

    Args:
        kind: of the table.
        head: its first ``kind.head_words`` words, or more.
    """
    match kind:
        case TableKind.MD0 | TableKind.MD3:
            return 1 + ROW_WORDS * (head[0] & 0xFF)
        case TableKind.MBUS:
            return 2 + ROW_WORDS * (head[1] & 0xFF) + 1
        case _:
            return 3 + min(head[2], MAX_MESSAGE)


def parse_table(kind: TableKind, words: Sequence[int]) -> Table:
    """Parse a table from its words.

    Raises:
        DataError: too few or too many words.
    """
    count = table_words(kind, words) if len(words) >= kind.head_words else kind.head_words
    if len(words) != count:
        raise DataError(f"a table of {kind.value}: expected {count} words, got {len(words)}")
    match kind:
        case TableKind.MD0:
            return ClinkTable(tuple(map(Transaction.parse, _rows(words[1:]))), words[0] >> 8)
        case TableKind.MD3:
            return HighSpeedTable(tuple(map(SharedBlock.parse, _rows(words[1:]))), words[0] >> 8)
        case TableKind.MBUS:
            rows = tuple(map(Transaction.parse, _rows(words[2:-1])))
            return MbusTable(rows, words[0], words[1] >> 8, words[-1])
        case _:
            return MessageTable.parse(words, receiver=kind is TableKind.MD2)


def place_faults(start: Element, count: int) -> list[Fault]:
    """The faults of the place of a table.

    Args:
        start: operand SR.
        count: the number of words of the table.
    """
    reason = misplaced("SR", start, count)
    return [] if reason is None else [Fault(None, None, reason)]


def _rows(words: Sequence[int]) -> list[Sequence[int]]:
    return [words[start : start + ROW_WORDS] for start in range(0, len(words), ROW_WORDS)]


def _require_count(rows: int, high: int) -> None:
    require_range("number of transactions", rows, 255)
    require_range("high byte of the number of transactions", high, 255)
