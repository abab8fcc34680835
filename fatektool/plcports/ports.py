"""The registers of the communication ports 1 to 4, and their meaning.

FBs link paper, sections 13.1.2 (interface signals) and 13.2 (R4047)::

    port                              1          2          3          4
    free, 0 = busy                    M1960      M1962      M1936      M1938
    last transaction finished         M1961      M1963      M1937      M1939
    communication parameters          R4146      R4158      R4043      R4044
    TX delay | RX time-out            R4147      R4159      R4045      R4048
    last result, two words            D4045      D4047      D4049      D4051

    D4043 = 56xxH   b1 to b4: the unit of the port's RX time-out is 0.1 s, else 0.01 s
    D4044 = 00xxH   b1 to b4: a transaction takes at least 2 scans, else 3
    D4044 = 56xxH   b1 to b4: one edge starts all transactions; only then the last results are kept
    R4047 = 55xxH   b1 to b4: the port is a Modbus RTU slave, else FATEK
    R4047 = 56xxH   two bits a port from b0 on: 0, 1 FATEK, 2 Modbus RTU, 3 Modbus ASCII; from OS 4.24 on

The bits of the communication parameters are in another chapter of the manual: they are shown as numbers. The
unit of TX delay is always 0.01 s. Without D4043, the unit of RX time-out is 0.01 s too.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.plcports.results import TransactionResult

if TYPE_CHECKING:
    from collections.abc import Mapping

PORTS: Final = (1, 2, 3, 4)
FATEK: Final = "FATEK"
RTU: Final = "Modbus RTU"
ASCII: Final = "Modbus ASCII"
_PROTOCOLS: Final = (FATEK, FATEK, RTU, ASCII)


@dataclass(frozen=True, slots=True)
class PortElements:
    """The elements with the settings of one port; ``result`` is the first of two."""

    free: str
    finished: str
    parameters: str
    times: str
    result: int


PORT_ELEMENTS: Final[Mapping[int, PortElements]] = {
    1: PortElements("M1960", "M1961", "R4146", "R4147", 4045),
    2: PortElements("M1962", "M1963", "R4158", "R4159", 4047),
    3: PortElements("M1936", "M1937", "R4043", "R4045", 4049),
    4: PortElements("M1938", "M1939", "R4044", "R4048", 4051),
}
COMMON_ELEMENTS: Final = ("R4047", "D4043", "D4044", "M1956", "R4148")


@dataclass(frozen=True, slots=True)
class Port:
    """One port. Values that the PLC does not have, or that depend on such, are None.

    Attributes:
        number: 1 to 4.
        free: False while an instruction uses it.
        finished: the last transaction of the table is done.
        protocol: its protocol as a slave.
        parameters: the register as a number.
        tx_delay_s: between two transactions, in seconds.
        rx_timeout_s: how long it waits for an answer, in seconds.
        rx_timeout_unit_s: 0.01 or 0.1.
        minimum_scans: scans that a transaction takes at least: 2 or 3.
        continuous: one edge starts all transactions.
        last_result: of the last transaction; the PLC keeps it only for continuous execution, else None.
    """

    number: int
    free: bool | None
    finished: bool | None
    protocol: str | None
    parameters: int | None
    tx_delay_s: float | None
    rx_timeout_s: float | None
    rx_timeout_unit_s: float | None
    minimum_scans: int | None
    continuous: bool | None
    last_result: TransactionResult | None


def slave_protocol(r4047: int, port: int, *, two_bits: bool = True) -> str:
    """The protocol of a port as a slave.

    Args:
        r4047: the register.
        port: 1 to 4; port 0 is always FATEK.
        two_bits: False for an OS that is known not to have 56xxH: then it is one of the other values.
    """
    match r4047 >> 8:
        case 0x55:
            return RTU if r4047 >> port & 1 else FATEK
        case 0x56 if two_bits:
            return _PROTOCOLS[r4047 >> 2 * (port - 1) & 3]
        case _:
            return FATEK


def timeout_unit_s(d4043: int, port: int) -> float:
    """The unit of a port's RX time-out, in seconds."""
    return 0.1 if d4043 >> 8 == 0x56 and d4043 >> port & 1 else 0.01


def minimum_scans(d4044: int, port: int) -> int:
    """The scans of the program that a transaction takes at least."""
    return 2 if d4044 >> 8 == 0 and d4044 >> port & 1 else 3


def is_continuous(d4044: int, port: int) -> bool:
    """True if one edge starts all transactions, one after the other."""
    return d4044 >> 8 == 0x56 and bool(d4044 >> port & 1)


def port_elements() -> tuple[str, ...]:
    """All elements that are read for the ports."""
    found = list(COMMON_ELEMENTS)
    for elements in PORT_ELEMENTS.values():
        found += [elements.free, elements.finished, elements.parameters, elements.times]
        found += [f"D{elements.result}", f"D{elements.result + 1}"]
    return tuple(found)


def decode_port(values: Mapping[str, int], number: int, *, two_bits: bool = True) -> Port:
    """One port.

    Args:
        values: raw, by element; elements that the PLC refused are missing.
        number: 1 to 4.
        two_bits: as for ``slave_protocol``.
    """
    own = PORT_ELEMENTS[number]
    r4047, d4043, d4044 = (values.get(name) for name in ("R4047", "D4043", "D4044"))
    times = values.get(own.times)
    unit = timeout_unit_s(d4043 or 0, number)
    continuous = None if d4044 is None else is_continuous(d4044, number)
    result = [values.get(f"D{own.result + place}") for place in (0, 1)] if continuous else [None, None]
    return Port(
        number,
        flag(values, own.free),
        flag(values, own.finished),
        None if r4047 is None else slave_protocol(r4047, number, two_bits=two_bits),
        values.get(own.parameters),
        None if times is None else hundredths(times >> 8),
        None if times is None else round((times & 0xFF) * unit, 2),
        None if times is None else unit,
        None if d4044 is None else minimum_scans(d4044, number),
        continuous,
        None if result[0] is None or result[1] is None else TransactionResult.parse(result[0], result[1]),
    )


def flag(values: Mapping[str, int], name: str) -> bool | None:
    """A discrete; None if it was not read."""
    value = values.get(name)
    return None if value is None else bool(value)


def hundredths(count: int) -> float:
    """A number of 0.01 s, in seconds."""
    return round(count / 100, 2)
