"""Rows of communication tables: seven words a transaction, both ways.

FBs link paper, sections 13.1.2 (MD0, MD3) and 13.2.2 (M-BUS)::

    word        0        1        2       3            4                5           6
    MD0, M-BUS  station  command  length  master type  master reference slave type  slave reference
    MD3         station  command  length  type         reference        reserved    reserved

The PLC uses the low byte of all words, except the references (and the reserved words). The high bytes are
kept in ``high_bytes``, so that a table is written back exactly as it was read.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.plcports.operands import TableOperand, require_range

if TYPE_CHECKING:
    from collections.abc import Sequence

ROW_WORDS: Final = 7
_NO_HIGH_BYTES: Final = (0, 0, 0, 0, 0)
_NO_HIGH_BYTES_MD3: Final = (0, 0, 0, 0)


def _require(row: Transaction | SharedBlock, high_bytes: int) -> None:
    for name in ("station", "command", "length"):
        require_range(name, getattr(row, name), 255)
    for value in row.high_bytes:
        require_range("high_bytes", value, 255)
    require_range("high_bytes: number", len(row.high_bytes), high_bytes)
    require_range("high_bytes: number missing", high_bytes - len(row.high_bytes), 0)


@dataclass(frozen=True, slots=True)
class Transaction:
    """A row of an MD0 or M-BUS table.

    Attributes:
        station: of the slave; 0 writes to all of them.
        command: 1 read, 2 write, in M-BUS 3 write single.
        length: the number of discretes, registers or words.
        master: the data in this PLC.
        slave: the data in the slave.
        high_bytes: of words 0, 1, 2, 3 and 5.

    Raises:
        UsageError: a value does not fit into its byte or word.
    """

    station: int
    command: int
    length: int
    master: TableOperand
    slave: TableOperand
    high_bytes: tuple[int, ...] = _NO_HIGH_BYTES

    def __post_init__(self) -> None:
        _require(self, len(_NO_HIGH_BYTES))

    def to_words(self) -> tuple[int, ...]:
        """The row as seven words."""
        low = (self.station, self.command, self.length, self.master.type, self.slave.type)
        station, command, length, master, slave = (
            high << 8 | byte for high, byte in zip(self.high_bytes, low, strict=True)
        )
        return station, command, length, master, self.master.reference, slave, self.slave.reference

    @classmethod
    def parse(cls, words: Sequence[int]) -> Transaction:
        """Parse seven words."""
        station, command, length, master, master_reference, slave, slave_reference = words
        return cls(
            station & 0xFF,
            command & 0xFF,
            length & 0xFF,
            TableOperand(master & 0xFF, master_reference),
            TableOperand(slave & 0xFF, slave_reference),
            tuple(word >> 8 for word in (station, command, length, master, slave)),
        )


@dataclass(frozen=True, slots=True)
class SharedBlock:
    """A row of an MD3 table: data that one station sends, and that all others store at the same addresses.

    Attributes:
        station: the sender, 1 to 254.
        command: 4.
        length: the number of registers, 1 to 32.
        data: the first register, the same in every PLC.
        reserved: words 5 and 6.
        high_bytes: of words 0 to 3.

    Raises:
        UsageError: a value does not fit into its byte or word.
    """

    station: int
    command: int
    length: int
    data: TableOperand
    reserved: tuple[int, ...] = (0, 0)
    high_bytes: tuple[int, ...] = _NO_HIGH_BYTES_MD3

    def __post_init__(self) -> None:
        _require(self, len(_NO_HIGH_BYTES_MD3))
        for value in self.reserved:
            require_range("reserved", value, 0xFFFF)
        require_range("reserved: number", len(self.reserved), 2)
        require_range("reserved: number missing", 2 - len(self.reserved), 0)

    def to_words(self) -> tuple[int, ...]:
        """The row as seven words."""
        low = (self.station, self.command, self.length, self.data.type)
        head = (high << 8 | byte for high, byte in zip(self.high_bytes, low, strict=True))
        return *head, self.data.reference, *self.reserved

    @classmethod
    def parse(cls, words: Sequence[int]) -> SharedBlock:
        """Parse seven words."""
        station, command, length, data, reference, *reserved = words
        return cls(
            station & 0xFF,
            command & 0xFF,
            length & 0xFF,
            TableOperand(data & 0xFF, reference),
            tuple(reserved),
            tuple(word >> 8 for word in (station, command, length, data)),
        )
