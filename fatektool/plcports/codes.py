"""The meanings of the result codes of communication instructions: one table for each kind.

FBs link paper, chapter 13, "Result code" under operand WR of each mode. A code that a mode does not list is
not explained by another mode's list. 0 of MD3 means that the table's format is correct; it does not include
the stations: errors of a running high-speed link are in R4058 and R4059 (section 13.1.2, MD3).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.plcports.kinds import TableKind

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping


class Words(NamedTuple):
    """The meaning of a code.

    Attributes:
        meaning: as in the paper.
        next_step: what to do; None if there is nothing to do.
    """

    meaning: str
    next_step: str | None


_SUCCESS: Final = Words("the transaction was successful", None)
_ROW: Final = "read the table with 'fatektool link table show': the row of the transaction shows the fault"
_COMMAND: Final = Words("command code error", _ROW)
_DATA_TYPE: Final = Words("data type error", _ROW)
_REFERENCE: Final = Words("reference number error", _ROW)
_TOGETHER: Final = Words("the data types of master and slave are incompatible", _ROW)
_SILENCE: Final = Words(
    "no answer from the station within the time-out",
    "check that the station is on, its number and its line parameters, and the wiring; 'fatektool link "
    "ports' shows the time-out, which must be longer than the slowest station's scan",
)
_LINE: Final = "check baud, format and protocol of both ends, cable, shield and termination"

CODES: Final[Mapping[TableKind, Mapping[int, Words]]] = {
    TableKind.MD0: {
        0x0: _SUCCESS,
        0x2: Words("length error: 0, or more than 64", _ROW),
        0x3: _COMMAND,
        0x4: _DATA_TYPE,
        0x5: _REFERENCE,
        0x6: _TOGETHER,
        0xA: _SILENCE,
        0xB: Words("communication error: damaged data received", _LINE),
    },
    TableKind.MD1: {
        0x0: _SUCCESS,
        0x2: Words("length error: 0, or more than 511", "set the length in SR+2 to 1 to 511"),
        0xA: Words(
            "no answer from the device within the time-out",
            "check that the device is on, its line parameters, the wiring, the start and end code in SR+1; "
            "'fatektool link ports' shows the time-out, which must be longer than the device takes",
        ),
        0xB: Words("communication error: damaged data received", _LINE),
    },
    TableKind.MD2: {
        0x0: _SUCCESS,
        0x2: Words("length error: 0, or more than 511", "set the length of the reply in SR+2 to 1 to 511"),
        0xA: Words(
            "the ladder program of this PLC did not prepare its reply within the time-out",
            "check the ladder program: it must write the reply, then its length (SR+2), in time; "
            "'fatektool link ports' shows the time-out, which must be longer than the program takes",
        ),
        0xB: Words("communication error: damaged data received", _LINE),
    },
    TableKind.MD3: {
        0x0: Words("the table's format is correct; the stations are not checked", None),
        0x2: Words("length error: 0, or more than 32", _ROW),
        0x3: Words("command code error: it is not 4", _ROW),
        0x4: Words("data type error: it is neither 12 nor 13", _ROW),
        0x5: _REFERENCE,
    },
    TableKind.MBUS: {
        0x0: _SUCCESS,
        0x2: Words("length error: 0, or over the limit", _ROW),
        0x3: _COMMAND,
        0x4: _DATA_TYPE,
        0x5: _REFERENCE,
        0x6: _TOGETHER,
        0x7: Words("port error: not port 1 to 4", "give the instruction a port from 1 to 4 (operand Pt)"),
        0x8: Words(
            "invalid communication table",
            "check that operand SR is the start of the table: SR+0 is A550H, the high byte of SR+1 is 07H",
        ),
        0xA: _SILENCE,
        0xB: Words(
            "communication error: damaged data, or a Modbus exception, received",
            f"{_LINE}; check that the slave has these references",
        ),
    },
}

TRANSACTIONS: Final = (TableKind.MD0, TableKind.MBUS)
"""The kinds whose WR+0 and WR+1 name transaction, station and command."""
UNLISTED: Final = "a code that the paper does not list"
NONE_YET: Final = "no transaction yet: these words are all 0"


def meaning(code: int, kinds: Collection[TableKind]) -> str:
    """The meaning of a result code.

    Args:
        code: the result code.
        kinds: the possible instructions. If the code differs between them, each meaning is returned.
    """
    return _joined(code, kinds, 0) or UNLISTED


def next_step(code: int, kinds: Collection[TableKind]) -> str | None:
    """What to do about a code; None if there is nothing to do, or nothing known."""
    return _joined(code, kinds, 1)


def _joined(code: int, kinds: Collection[TableKind], part: int) -> str | None:
    readings: dict[str, list[str]] = {}
    for kind in kinds:
        text = CODES[kind].get(code, (None, None))[part]
        if text is not None:
            readings.setdefault(text, []).append(kind.value)
    if len(kinds) == 1 or (len(readings) == 1 and len(next(iter(readings.values()))) == len(kinds)):
        return next(iter(readings), None)
    return "; ".join(f"{', '.join(names)}: {text}" for text, names in readings.items()) or None
