"""The result of a communication instruction's last transaction: result code, and the words WR+0 to WR+7.

FBs link paper, sections 13.1.2 (CLINK, FUN151) and 13.2.2 (M-BUS, FUN150)::

            high byte        low byte
    WR+0    result code      number of the transaction, from 0
    WR+1    station          command on the wire: 40 44 45 46 47H of FACON, 01 to 10H of Modbus
    WR+4    b0 waiting for the port   b4 not the first run   b12 ACT   b13 ERR   b14 DN
    others  used by the instruction itself

This is for MD0 and M-BUS. MD1 and MD2 have the result code in WR+0, and b0, b12, b13 and b14 of WR+4; WR+8 is
the number of received bytes, which follow from WR+9 on. MD3 has only the result code, in WR+0. The paper does
not say in which byte: here it is the high byte as in all other modes, or the low byte if the high one is 0
[E:md3-code-byte].
The results of a port in D4045 to D4052 are copies of WR+0 and WR+1. The meanings of the codes are in
``codes``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.plcports.kinds import TableKind

if TYPE_CHECKING:
    from collections.abc import Sequence

WR_WORDS: Final = 8
"""The number of words that an instruction uses from WR on."""
_BITS: Final = (0, 4, 12, 13, 14)
_MESSAGE_BITS: Final = (0, 12, 13, 14)
_BITS_OF: Final = {TableKind.MD1: _MESSAGE_BITS, TableKind.MD2: _MESSAGE_BITS, TableKind.MD3: ()}

_MODBUS_COMMANDS: Final = {
    0x01: "read discrete outputs (0xxxxx)",
    0x02: "read discrete inputs (1xxxxx)",
    0x03: "read holding registers (4xxxxx)",
    0x04: "read input registers (3xxxxx)",
    0x05: "force one coil",
    0x06: "preset one register",
    0x0F: "force several coils",
    0x10: "preset several registers",
}
_FACON_COMMANDS: Final = {
    0x40: "read system status",
    0x44: "read discretes",
    0x45: "write discretes",
    0x46: "read registers",
    0x47: "write registers",
}
_COMMANDS_OF: Final = {TableKind.MD0: _FACON_COMMANDS, TableKind.MBUS: _MODBUS_COMMANDS}


@dataclass(frozen=True, slots=True)
class Fault:
    """Something in a table that the paper does not allow.

    Attributes:
        row: the transaction, from 0 as WR+0 counts; None for the table as a whole.
        code: the result code that the instruction would have; None if the paper has none.
        reason: what is wrong, expected and got.
    """

    row: int | None
    code: int | None
    reason: str


@dataclass(frozen=True, slots=True)
class TransactionResult:
    """WR+0 and WR+1.

    Attributes:
        code: result code, 0 for success.
        transaction: the number of the row, from 0.
        station: the slave of the transaction.
        command: as sent on the line.
    """

    code: int
    transaction: int
    station: int
    command: int

    @classmethod
    def parse(cls, wr0: int, wr1: int) -> TransactionResult:
        """Parse the two words."""
        return cls(wr0 >> 8, wr0 & 0xFF, wr1 >> 8, wr1 & 0xFF)

    def to_words(self) -> tuple[int, int]:
        """The two words."""
        return self.code << 8 | self.transaction, self.station << 8 | self.command

    @property
    def none_yet(self) -> bool:
        """True if all is 0: a transaction always has a command, also with station 0."""
        return self.to_words() == (0, 0)

    def command_meaning(self, kind: TableKind | None = None) -> str | None:
        """The meaning of the command; None if this kind of instruction has no such command.

        Args:
            kind: of the instruction; None if not known.
        """
        commands = _FACON_COMMANDS | _MODBUS_COMMANDS if kind is None else _COMMANDS_OF.get(kind, {})
        return commands.get(self.command)


@dataclass(frozen=True, slots=True)
class Operation:
    """WR+4: the instruction's progress. None for bits that the mode does not have.

    Attributes:
        waiting: another instruction uses the port, and this one waits for it.
        repeated: not the first run of the instruction.
        active: output ACT.
        error: output ERR.
        done: output DN.
    """

    waiting: bool | None
    repeated: bool | None
    active: bool | None
    error: bool | None
    done: bool | None

    @classmethod
    def parse(cls, wr4: int, kind: TableKind | None = None) -> Operation:
        """Parse the word.

        Args:
            wr4: the word.
            kind: of the instruction; None if not known, then every bit is shown.
        """
        bits = _BITS if kind is None else _BITS_OF.get(kind, _BITS)
        return cls(*(bool(wr4 >> bit & 1) if bit in bits else None for bit in _BITS))


@dataclass(frozen=True, slots=True)
class InstructionState:
    """All state in the registers from WR on.

    Attributes:
        words: WR+0 to WR+7 as numbers.
        result: of the last transaction. For MD1 to MD3 only its code is valid.
        operation: the instruction's progress.
    """

    words: tuple[int, ...]
    result: TransactionResult
    operation: Operation

    @classmethod
    def parse(cls, words: Sequence[int], kind: TableKind | None = None) -> InstructionState:
        """Parse WR+0 to WR+7.

        Args:
            words: the eight words.
            kind: of the instruction; None if not known.
        """
        result = TransactionResult.parse(words[0], words[1])
        if kind is TableKind.MD3 and result.code == 0:
            result = TransactionResult(result.transaction, 0, 0, 0)
        return cls(tuple(words), result, Operation.parse(words[4], kind))
