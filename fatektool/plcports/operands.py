"""Operands in a row of a communication table: a type of data and a reference, as two words.

::

    CLINK, a PLC's own data            R100      type 12, reference 100
    M-BUS, a Modbus slave's data       400101    type 4, reference 101
    a type that no paper lists         20:100    type 20, reference 100

FBs link paper, section 13.1 (data types of MD0 and MD3) and 13.2 (those of M-BUS). The tables there call the
registers of timers and counters TR and CR; everywhere else they are RT and RC. Both are accepted.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping


@dataclass(frozen=True, slots=True)
class DataType:
    """A type of data in a table.

    Attributes:
        symbol: as in the paper; for a Modbus slave the first digit of the reference.
        first: the smallest reference.
        last: the largest reference.
        discrete: True for single discretes, False for words.
        step: a reference is a multiple of this.
        stride: the distance between consecutive data.
    """

    symbol: str
    last: int
    discrete: bool
    first: int = 0
    step: int = 1
    stride: int = 1

    def written(self, reference: int) -> str:
        """A reference of this type as text."""
        return f"{self.symbol}{reference:05}" if self.symbol.isdecimal() else f"{self.symbol}{reference}"


def _packed(symbol: str, last: int) -> DataType:
    return DataType(symbol, last, discrete=False, step=8, stride=16)


CLINK_TYPES: Final[Mapping[int, DataType]] = {
    0: DataType("X", 255, discrete=True),
    1: DataType("Y", 255, discrete=True),
    2: DataType("M", 1911, discrete=True),
    3: DataType("S", 999, discrete=True),
    4: DataType("T", 255, discrete=True),
    5: DataType("C", 255, discrete=True),
    6: _packed("WX", 240),
    7: _packed("WY", 240),
    8: _packed("WM", 1896),
    9: _packed("WS", 984),
    10: DataType("TR", 255, discrete=False),
    11: DataType("CR", 199, discrete=False),
    12: DataType("R", 3839, discrete=False),
    13: DataType("D", 4095, discrete=False),
}
"""MD0, of the master and of the slave."""

HIGH_SPEED_TYPES: Final[Mapping[int, DataType]] = {
    12: CLINK_TYPES[12],
    13: DataType("D", 3999, discrete=False),
}
"""MD3."""

MBUS_MASTER_TYPES: Final[Mapping[int, DataType]] = {
    1: CLINK_TYPES[1],
    2: CLINK_TYPES[2],
    3: CLINK_TYPES[3],
    **HIGH_SPEED_TYPES,
}
"""M-BUS, of the master: this PLC."""

MBUS_SLAVE_TYPES: Final[Mapping[int, DataType]] = {
    0: DataType("0", 65535, discrete=True, first=1),
    1: DataType("1", 65535, discrete=True, first=1),
    3: DataType("3", 65535, discrete=False, first=1),
    4: DataType("4", 65535, discrete=False, first=1),
}
"""M-BUS, of the Modbus slave: discrete outputs, discrete inputs, input registers, holding registers."""

_ALIASES: Final = {"RT": "TR", "RC": "CR"}
_WRITTEN: Final = re.compile(r"([A-Za-z]{1,2})([0-9]{1,5})", re.ASCII)
_MODBUS: Final = re.compile(r"([0134])([0-9]{4,5})", re.ASCII)
_CODED: Final = re.compile(r"([0-9]{1,3}):([0-9]{1,5})", re.ASCII)


@dataclass(frozen=True, slots=True)
class TableOperand:
    """A type and a reference.

    Attributes:
        type: the code of the type, 0 to 255.
        reference: of the first data, 0 to 65535.

    Raises:
        UsageError: one of them does not fit into its word.
    """

    type: int
    reference: int

    def __post_init__(self) -> None:
        require_range("type", self.type, 255)
        require_range("reference", self.reference, 0xFFFF)

    def written(self, types: Mapping[int, DataType]) -> str:
        """As text, with these types; ``20:100`` for an unknown type."""
        found = types.get(self.type)
        return f"{self.type}:{self.reference}" if found is None else found.written(self.reference)

    @classmethod
    def parse(cls, text: str, types: Mapping[int, DataType]) -> TableOperand:
        """Parse an operand, with these types.

        The reference may be outside the type's range: the checks report that.

        Raises:
            UsageError: it is not an operand.
        """
        written = text.strip()
        coded = _CODED.fullmatch(written)
        if coded is not None:
            return cls(int(coded[1]), int(coded[2]))
        match = (_MODBUS if types is MBUS_SLAVE_TYPES else _WRITTEN).fullmatch(written)
        if match is not None:
            symbol = match[1].upper()
            symbol = _ALIASES.get(symbol, symbol)
            for code, kind in types.items():
                if kind.symbol == symbol:
                    return cls(code, int(match[2]))
        examples = (
            "a Modbus reference such as 400001"
            if types is MBUS_SLAVE_TYPES
            else f"one of {' '.join(kind.symbol for kind in types.values())} and a number, such as R100"
        )
        raise UsageError(f"{text!r:.60}: expected {examples}")


def require_range(name: str, value: int, most: int) -> None:
    """Check that a value is from 0 to ``most``.

    Raises:
        UsageError: it is not.
    """
    if not 0 <= value <= most:
        raise UsageError(f"{name}: expected 0 to {most}, got {value}")
