"""Which PLCs have the functions that the FBs link paper describes, as far as command 53 shows.

FBs link paper, section 13.2: Modbus slave types 1 and 3 of M-BUS "OS version 4.22↑"; R4047 = 56xxH, the only
way to Modbus ASCII, "FBs PLC OS V4.24 or later". All of chapter 13 is of the FBs series, whose OS is 4 or
later.

53 has one nibble for each digit of the OS version (FACON paper, 53), so a PLC with 4.20 to 4.29 reports 4.2:
the second decimal is not known. That the nibble is the first decimal is an assumption [E:os-digit]: the
paper's examples are 3.0 and 3.1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.plcports.tables import MbusTable
from fatektool.protocol.status import FBS_OS_MAJOR

if TYPE_CHECKING:
    from fatektool.plcports.tables import Table

_INPUT_TYPES: Final = {1, 3}
_ASCII_OR_RTU: Final = 0x56


@dataclass(frozen=True, slots=True)
class Need:
    """A function that only newer PLCs have.

    Attributes:
        what: its name.
        tenths: first decimal of the OS version, which 53 has: 2 of 4.24.
        hundredths: second decimal, which 53 does not have: 4 of 4.24.
    """

    what: str
    tenths: int
    hundredths: int

    @property
    def version(self) -> str:
        """The OS version as text."""
        return f"{FBS_OS_MAJOR}.{self.tenths}{self.hundredths}"

    def met(self, os_version: str | None) -> bool | None:
        """Whether a PLC has it; None if its OS version does not decide it.

        Args:
            os_version: as in 53, ``4.2``; None if not known.
        """
        found = _digits(os_version)
        if found is None or found == (FBS_OS_MAJOR, self.tenths):
            return None
        return found > (FBS_OS_MAJOR, self.tenths)


MODBUS_ASCII: Final = Need("R4047 = 56xxH (and with it Modbus ASCII)", 2, 4)
INPUT_TYPES: Final = Need("reading slave types 1 and 3 (discrete inputs, input registers)", 2, 2)


def is_fbs(os_version: str | None) -> bool | None:
    """Whether a PLC is an FBs, by its OS version; None if not known."""
    found = _digits(os_version)
    return None if found is None else found[0] >= FBS_OS_MAJOR


def needs_of_ports(r4047: int | None) -> tuple[Need, ...]:
    """The functions that the protocols of the ports need."""
    return (MODBUS_ASCII,) if r4047 is not None and r4047 >> 8 == _ASCII_OR_RTU else ()


def needs_of_table(table: Table) -> tuple[Need, ...]:
    """The functions that the rows of a table need."""
    if isinstance(table, MbusTable) and any(row.slave.type in _INPUT_TYPES for row in table.rows):
        return (INPUT_TYPES,)
    return ()


def _digits(os_version: str | None) -> tuple[int, int] | None:
    major, _, minor = (os_version or "").partition(".")
    try:
        return int(major, 16), int(minor, 16)
    except ValueError:
        return None
