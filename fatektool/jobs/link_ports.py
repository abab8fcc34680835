"""Reading the communication ports and what an instruction says of them.

One plan reads all of it; what the PLC refuses (a model without port 3, an FB without D4043) is missing from
the report and named, and nothing else is lost.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import PlcError, UsageError
from fatektool.jobs.registers import named, read_elements
from fatektool.protocol.elements import Element
from fatektool.protocol.link_ports import PORTS, Port, decode_port, port_elements
from fatektool.protocol.link_results import WR_WORDS, InstructionState
from fatektool.protocol.link_settings import (
    SETTING_ELEMENTS,
    HighSpeedLink,
    MessageDetection,
    Modem,
    decode_detection,
    decode_high_speed,
    decode_modem,
)

if TYPE_CHECKING:
    from fatektool.client import Plc

MAX_RECEIVED: Final = 511


@dataclass(frozen=True, slots=True)
class PortsReport:
    """All that the ports' registers say.

    Attributes:
        ports: 1 to 4.
        detection: of the end of a message.
        high_speed: the link of port 2.
        modem: of port 1.
        raw: values by element, unsigned.
        errors: what the PLC said of the elements that it refused.
    """

    ports: tuple[Port, ...]
    detection: MessageDetection
    high_speed: HighSpeedLink
    modem: Modem
    raw: dict[str, int]
    errors: dict[str, str]


def read_ports(plc: Plc) -> PortsReport:
    """Read the ports' registers.

    Raises:
        LineError: no answer.
    """
    names = (*port_elements(), *SETTING_ELEMENTS)
    reading = read_elements(plc, map(Element.parse, names))
    values = {str(element): value for element, value in reading.values.items()}
    return PortsReport(
        tuple(decode_port(values, number) for number in PORTS),
        decode_detection(values),
        decode_high_speed(values),
        decode_modem(values),
        values,
        {str(element): error for element, error in reading.errors.items()},
    )


@dataclass(frozen=True, slots=True)
class ResultReport:
    """What WR says, and in MD1 and MD2 what was received.

    Attributes:
        state: WR+0 to WR+7.
        received_length: WR+8; None where it was not asked for.
        received: the bytes from WR+9 on.
    """

    state: InstructionState
    received_length: int | None = None
    received: bytes = b""


def read_result(plc: Plc, start: Element, *, message: bool) -> ResultReport:
    """Read what an instruction says of its last transaction.

    Args:
        plc: the PLC.
        start: operand WR.
        message: True for MD1 and MD2, whose received bytes are read as well.

    Raises:
        UsageError: no register.
        PlcError: the PLC refused a register.
        LineError: no answer.
    """
    require_register(start, "WR")
    words = read_words(plc, start, WR_WORDS + message)
    state = InstructionState.parse(words[:WR_WORDS])
    if not message:
        return ResultReport(state)
    length = words[WR_WORDS]
    count = min(length, MAX_RECEIVED)
    data = read_words(plc, start.after(WR_WORDS + 1), count) if count else ()
    return ResultReport(state, length, bytes(word & 0xFF for word in data))


def require_register(start: Element, operand: str) -> None:
    """Check that an operand is an R or a D.

    Raises:
        UsageError: it is none.
    """
    if start.symbol not in {"R", "D"}:
        raise UsageError(f"{operand} {start}: expected a register R or D", element=str(start))


def read_words(plc: Plc, start: Element, count: int) -> tuple[int, ...]:
    """Read registers that follow each other, all of them.

    Raises:
        UsageError: they go past the last address there is.
        PlcError: the PLC refused some; says which.
        LineError: no answer.
    """
    elements = [start.after(place) for place in range(count)]
    reading = read_elements(plc, elements)
    if reading.errors:
        refused = named(map(str, reading.errors))
        raise PlcError(
            f"{count} registers from {start} were asked for, and the PLC refused {refused}: "
            f"{next(iter(reading.errors.values()))}",
            hint=f"is {start} where the table begins?",
            element=str(start),
        )
    return tuple(reading.values[element] for element in elements)
