"""Rows of communication tables: seven words a transaction, both ways.

FBs link paper, sections 13.1.2 (MD0, MD3) and 13.2.2 (M-BUS)::

    word        0        1        2       3            4                5           6
    MD0, M-BUS  station  command  length  master type  master reference slave type  slave reference
    MD3         station  command  length  type         reference        reserved    reserved

Of all words but the references (and the reserved ones) the PLC takes the low byte. What is in the high
byte is kept in ``high_bytes``, so that a table goes back as it came.
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
    require_range("high_bytes: how many", len(row.high_bytes), high_bytes)
    require_range("high_bytes: how many are missing", high_bytes - len(row.high_bytes), 0)


@dataclass(frozen=True, slots=True)
class Transaction:
    """A row of an MD0 or M-BUS table.

    Attributes:
        station: of the slave; 0 writes to all of them.
        command: 1 read, 2 write, in M-BUS 3 write single.
        length: how many discretes, registers or words.
        master: where the data are in this PLC.
        slave: where they are in the slave.
        high_bytes: of words 0, 1, 2, 3 and 5.

    Raises:
        UsageError: a value does not fit its byte or word.
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
        """Take seven words apart."""
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
    """A row of an MD3 table: data that one station sends, and all others have then at the same place.

    Attributes:
        station: who sends, 1 to 254.
        command: 4.
        length: how many registers, 1 to 32.
        data: where they are, in every PLC.
        reserved: words 5 and 6.
        high_bytes: of words 0 to 3.

    Raises:
        UsageError: a value does not fit its byte or word.
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
        require_range("reserved: how many", len(self.reserved), 2)
        require_range("reserved: how many are missing", 2 - len(self.reserved), 0)

    def to_words(self) -> tuple[int, ...]:
        """The row as seven words."""
        low = (self.station, self.command, self.length, self.data.type)
        head = (high << 8 | byte for high, byte in zip(self.high_bytes, low, strict=True))
        return *head, self.data.reference, *self.reserved

    @classmethod
    def parse(cls, words: Sequence[int]) -> SharedBlock:
        """Take seven words apart."""
        station, command, length, data, reference, *reserved = words
        return cls(
            station & 0xFF,
            command & 0xFF,
            length & 0xFF,
            TableOperand(data & 0xFF, reference),
            tuple(reserved),
            tuple(word >> 8 for word in (station, command, length, data)),
        )
