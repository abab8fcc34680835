"""What a communication instruction says of its last transaction: result codes, and the words WR+0 to WR+7.

FBs link paper, sections 13.1.2 (CLINK, FUN151) and 13.2.2 (M-BUS, FUN150)::

            high byte        low byte
    WR+0    result code      number of the transaction, from 0
    WR+1    station          command on the wire: 40 44 45 46 47H of FACON, 01 to 10H of Modbus
    WR+4    b0 waiting for the port   b4 not the first run   b12 ACT   b13 ERR   b14 DN
    others  the instruction's own

MD1 and MD2 use the high byte of WR+0 alone; WR+8 tells how many bytes they received, WR+9 on the bytes.
The results of a port in D4045 to D4052 are WR+0 and WR+1 again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Sequence

WR_WORDS: Final = 8
"""The words that an instruction controls from WR on."""

MEANINGS: Final = {
    0x0: "the transaction was successful",
    0x2: "length error: 0 or more than the limit",
    0x3: "command code error",
    0x4: "data type error",
    0x5: "reference number error",
    0x6: "the data types of master and slave do not go together",
    0x7: "port error: not port 1 to 4",
    0x8: "invalid communication table",
    0xA: "no answer from the station within the time-out",
    0xB: "communication error: damaged data, or a Modbus exception, came back",
}

_TABLE: Final = "read the table with 'fatektool link table show': the transaction's row says what is wrong"
NEXT_STEPS: Final = {
    0x2: _TABLE,
    0x3: _TABLE,
    0x4: _TABLE,
    0x5: _TABLE,
    0x6: _TABLE,
    0x7: "give the instruction a port from 1 to 4 (operand Pt)",
    0x8: "check that operand SR is where the table begins: SR+0 is A550H, the high byte of SR+1 is 07H",
    0xA: "check that the station is on, its number and its line parameters, and the wiring; 'fatektool link "
    "ports' shows the time-out, which must be longer than the slowest station's scan",
    0xB: "check baud, format and protocol of both ends, cable, shield and termination; of a Modbus slave "
    "check that it has these references",
}

WIRE_COMMANDS: Final = {
    0x01: "read discrete outputs (0xxxxx)",
    0x02: "read discrete inputs (1xxxxx)",
    0x03: "read holding registers (4xxxxx)",
    0x04: "read input registers (3xxxxx)",
    0x05: "force one coil",
    0x06: "preset one register",
    0x0F: "force several coils",
    0x10: "preset several registers",
    0x40: "read system status",
    0x44: "read discretes",
    0x45: "write discretes",
    0x46: "read registers",
    0x47: "write registers",
}


def meaning(code: int) -> str:
    """A result code in words."""
    return MEANINGS.get(code, "a code that the paper does not list")


@dataclass(frozen=True, slots=True)
class Fault:
    """Something in a table that the paper does not allow.

    Attributes:
        row: the transaction, from 0 as WR+0 counts; None for the table as a whole.
        code: the result code that the instruction would give; None where the paper names none.
        reason: what, expected and found.
    """

    row: int | None
    code: int | None
    reason: str


@dataclass(frozen=True, slots=True)
class TransactionResult:
    """WR+0 and WR+1.

    Attributes:
        code: result code, 0 for success.
        transaction: which row, from 0.
        station: the slave of the transaction.
        command: what went over the wire.
    """

    code: int
    transaction: int
    station: int
    command: int

    @classmethod
    def parse(cls, wr0: int, wr1: int) -> TransactionResult:
        """Take the two words apart."""
        return cls(wr0 >> 8, wr0 & 0xFF, wr1 >> 8, wr1 & 0xFF)

    def to_words(self) -> tuple[int, int]:
        """The two words."""
        return self.code << 8 | self.transaction, self.station << 8 | self.command

    @property
    def meaning(self) -> str:
        """The code in words."""
        return meaning(self.code)

    @property
    def next_step(self) -> str | None:
        """What to do about the code; None where there is nothing to do, or nothing known."""
        return NEXT_STEPS.get(self.code)

    @property
    def command_meaning(self) -> str | None:
        """The command in words; None for a code that is no command."""
        return WIRE_COMMANDS.get(self.command)


@dataclass(frozen=True, slots=True)
class Operation:
    """WR+4: where the instruction stands.

    Attributes:
        waiting: another instruction has the port, this one waits for it.
        repeated: it is not the first time that the instruction runs.
        active: output ACT.
        error: output ERR.
        done: output DN.
    """

    waiting: bool
    repeated: bool
    active: bool
    error: bool
    done: bool

    @classmethod
    def parse(cls, wr4: int) -> Operation:
        """Take the word apart."""
        return cls(*(bool(wr4 >> bit & 1) for bit in (0, 4, 12, 13, 14)))


@dataclass(frozen=True, slots=True)
class InstructionState:
    """All that WR tells.

    Attributes:
        words: WR+0 to WR+7 as they are.
        result: of the last transaction.
        operation: where the instruction stands.
    """

    words: tuple[int, ...]
    result: TransactionResult
    operation: Operation

    @classmethod
    def parse(cls, words: Sequence[int]) -> InstructionState:
        """Take WR+0 to WR+7 apart."""
        return cls(tuple(words), TransactionResult.parse(words[0], words[1]), Operation.parse(words[4]))
