"""Checks of the rows of a communication table against the paper, with the result code of each fault.

FBs link paper: the ranges are at the operand SR of each mode, the codes at its operand WR::

    2 length   3 command   4 data type   5 reference   6 incompatible types   A no answer

Where the paper is silent:

* It gives no code for a wrong station: such a fault has none. Reading from station 0 has A, because no PLC
  answers a broadcast.
* CLINK's code 3 is described for commands 'greater than 2'; command 0 is invalid too (as M-BUS says), so it
  also has 3.
* Code 5 is used for the whole range: all data must be within the references that the paper lists.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.plcports.operands import CLINK_TYPES, HIGH_SPEED_TYPES, MBUS_MASTER_TYPES, MBUS_SLAVE_TYPES
from fatektool.plcports.results import Fault

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fatektool.plcports.operands import DataType, TableOperand
    from fatektool.plcports.rows import SharedBlock, Transaction

READ: Final = 1
WRITE: Final = 2
WRITE_SINGLE: Final = 3
HIGH_SPEED: Final = 4

CLINK_COMMANDS: Final = {READ: "read", WRITE: "write"}
MBUS_COMMANDS: Final = {READ: "read", WRITE: "write", WRITE_SINGLE: "write-single"}
HIGH_SPEED_COMMANDS: Final = {HIGH_SPEED: "high-speed"}

MAX_CLINK: Final = 64
MAX_HIGH_SPEED: Final = 32
MAX_MBUS_REGISTERS: Final = 125
MAX_MBUS_DISCRETES: Final = 255
_MBUS_WRITABLE: Final = {0, 4}


def check_clink(number: int, row: Transaction) -> Iterator[Fault]:
    """Check a row of an MD0 table."""
    yield from _station(number, row.station, 0, 254)
    yield from _command(number, row.command, CLINK_COMMANDS)
    yield from _broadcast_read(number, row)
    yield from _length(number, row.length, MAX_CLINK)
    yield from _operand(number, "master", row.master, CLINK_TYPES, row.length)
    yield from _operand(number, "slave", row.slave, CLINK_TYPES, row.length)
    yield from _together(number, row, CLINK_TYPES, CLINK_TYPES)


def check_high_speed(number: int, row: SharedBlock) -> Iterator[Fault]:
    """Check a row of an MD3 table."""
    yield from _station(number, row.station, 1, 254)
    yield from _command(number, row.command, HIGH_SPEED_COMMANDS)
    yield from _length(number, row.length, MAX_HIGH_SPEED)
    yield from _operand(number, "data", row.data, HIGH_SPEED_TYPES, row.length)


def check_mbus(number: int, row: Transaction) -> Iterator[Fault]:
    """Check a row of an M-BUS table."""
    yield from _station(number, row.station, 0, 247)
    yield from _command(number, row.command, MBUS_COMMANDS)
    yield from _broadcast_read(number, row)
    kind = MBUS_MASTER_TYPES.get(row.master.type) or MBUS_SLAVE_TYPES.get(row.slave.type)
    registers = kind is not None and not kind.discrete
    yield from _length(number, row.length, MAX_MBUS_REGISTERS if registers else MAX_MBUS_DISCRETES)
    yield from _operand(number, "master", row.master, MBUS_MASTER_TYPES, row.length)
    yield from _operand(number, "slave", row.slave, MBUS_SLAVE_TYPES, row.length)
    read_only = row.slave.type in MBUS_SLAVE_TYPES and row.slave.type not in _MBUS_WRITABLE
    if read_only and row.command in {WRITE, WRITE_SINGLE}:
        written = row.slave.written(MBUS_SLAVE_TYPES)
        yield Fault(number, 4, f"slave {written}: an input cannot be written: expected type 0 or 4")
    yield from _together(number, row, MBUS_MASTER_TYPES, MBUS_SLAVE_TYPES)


def _station(number: int, station: int, first: int, last: int) -> Iterator[Fault]:
    if not first <= station <= last:
        yield Fault(number, None, f"station: expected {first} to {last}, got {station}")


def _command(number: int, command: int, known: Mapping[int, str]) -> Iterator[Fault]:
    if command not in known:
        names = ", ".join(f"{code} ({name})" for code, name in known.items())
        yield Fault(number, 3, f"command: expected {names}, got {command}")


def _broadcast_read(number: int, row: Transaction) -> Iterator[Fault]:
    if row.station == 0 and row.command == READ:
        yield Fault(number, 0xA, "station 0 is a broadcast, which no PLC answers: it cannot be read")


def _length(number: int, length: int, most: int) -> Iterator[Fault]:
    if not 1 <= length <= most:
        yield Fault(number, 2, f"length: expected 1 to {most}, got {length}")


def _operand(
    number: int, name: str, operand: TableOperand, types: Mapping[int, DataType], length: int
) -> Iterator[Fault]:
    kind = types.get(operand.type)
    if kind is None:
        known = ", ".join(map(str, types))
        yield Fault(number, 4, f"{name}: type: expected one of {known}, got {operand.type}")
        return
    written = f"{name} {kind.written(operand.reference)}"
    if not kind.first <= operand.reference <= kind.last:
        yield Fault(number, 5, f"{written}: expected {kind.written(kind.first)} to {kind.written(kind.last)}")
    elif operand.reference % kind.step:
        yield Fault(number, 5, f"{written}: expected a multiple of {kind.step}")
    else:
        end = operand.reference + max(length - 1, 0) * kind.stride
        if end > kind.last:
            yield Fault(
                number, 5, f"{written}: {length} from there end at {end}, past {kind.written(kind.last)}"
            )


def _together(
    number: int, row: Transaction, masters: Mapping[int, DataType], slaves: Mapping[int, DataType]
) -> Iterator[Fault]:
    master, slave = masters.get(row.master.type), slaves.get(row.slave.type)
    if master is not None and slave is not None and master.discrete != slave.discrete:
        names = {True: "discretes", False: "registers"}
        yield Fault(
            number,
            6,
            f"master {row.master.written(masters)} are {names[master.discrete]}, "
            f"slave {row.slave.written(slaves)} {names[slave.discrete]}",
        )
