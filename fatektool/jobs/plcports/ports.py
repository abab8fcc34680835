"""Reading the communication ports and what an instruction says of them.

One plan reads all of it; what the PLC refuses (a model without port 3, an FB without D4043) is missing from
the report and named, and nothing else is lost.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError, PlcError, UsageError
from fatektool.jobs.elements.reads import named, read_elements
from fatektool.jobs.plcports.host import LinkHost, read_host
from fatektool.plcports.codes import NONE_YET, TRANSACTIONS, meaning, next_step
from fatektool.plcports.kinds import TableKind, misplaced
from fatektool.plcports.ports import PORTS, Port, decode_port, port_elements
from fatektool.plcports.results import WR_WORDS, InstructionState
from fatektool.plcports.settings import (
    SETTING_ELEMENTS,
    HighSpeedLink,
    MessageDetection,
    Modem,
    decode_detection,
    decode_high_speed,
    decode_modem,
)
from fatektool.plcports.versions import MODBUS_ASCII, needs_of_ports
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.plcports.results import TransactionResult

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
        host: which PLC it is, and what R4047 needs of it.
    """

    ports: tuple[Port, ...]
    detection: MessageDetection
    high_speed: HighSpeedLink
    modem: Modem
    raw: dict[str, int]
    errors: dict[str, str]
    host: LinkHost


_KEPT_BY: Final = (*TRANSACTIONS, TableKind.MD1)
"""The instructions whose last result a port keeps; the registers do not say which of them it was."""


def kept_meaning(result: TransactionResult) -> str:
    """The last result that a port keeps, in words."""
    return NONE_YET if result.none_yet else meaning(result.code, _KEPT_BY)


def kept_next_step(result: TransactionResult) -> str | None:
    """What to do about the last result that a port keeps; None where there is nothing to do."""
    return next_step(result.code, _KEPT_BY)


def read_ports(plc: Plc) -> PortsReport:
    """Read the ports' registers.

    Raises:
        LineError: no answer.
    """
    names = (*port_elements(), *SETTING_ELEMENTS)
    reading = read_elements(plc, map(Element.parse, names))
    values = {str(element): value for element, value in reading.values.items()}
    host = read_host(plc, needs_of_ports(values.get("R4047")))
    two_bits = MODBUS_ASCII.met(host.os_version) is not False
    return PortsReport(
        tuple(decode_port(values, number, two_bits=two_bits) for number in PORTS),
        decode_detection(values),
        decode_high_speed(values),
        decode_modem(values),
        values,
        {str(element): error for element, error in reading.errors.items()},
        host,
    )


@dataclass(frozen=True, slots=True)
class ResultReport:
    """What WR says, and in MD1 and MD2 what was received.

    Attributes:
        kind: of the instruction; None where it was not named.
        state: WR+0 to WR+7.
        high_speed: R4058 and R4059, where a running high-speed link has its errors; None for other kinds.
        received_length: WR+8; None where it was not asked for.
        received: the bytes from WR+9 on.
    """

    kind: TableKind | None
    state: InstructionState
    high_speed: HighSpeedLink | None = None
    received_length: int | None = None
    received: bytes = b""

    @property
    def meaning(self) -> str:
        """The result code in words; every reading of it where the kind is not known."""
        if self.kind in TRANSACTIONS and self.state.result.none_yet:
            return NONE_YET
        return meaning(self.state.result.code, self._kinds)

    @property
    def next_step(self) -> str | None:
        """What to do about the result code; None where there is nothing to do."""
        if self.kind in TRANSACTIONS and self.state.result.none_yet:
            return "check that the instruction has run, and that this is its operand WR"
        return next_step(self.state.result.code, self._kinds)

    @property
    def good(self) -> bool:
        """No error is known: neither in the result code, nor on the high-speed link."""
        return self.state.result.code == 0 and (self.high_speed is None or self.high_speed.good)

    @property
    def code_alone(self) -> bool:
        """True for a kind whose WR+0 has only a result code, and whose WR+1 is for internal use."""
        return self.kind is not None and self.kind not in TRANSACTIONS

    @property
    def _kinds(self) -> tuple[TableKind, ...]:
        return tuple(TableKind) if self.kind is None else (self.kind,)


def read_result(plc: Plc, start: Element, kind: TableKind | None = None) -> ResultReport:
    """Read what an instruction says of its last transaction.

    Args:
        plc: the PLC.
        start: operand WR.
        kind: of the instruction. Of MD1 and MD2 the received bytes are read as well, of MD3 R4058 and
            R4059.

    Raises:
        UsageError: no register that can hold a result, or too near the end of such registers.
        PlcError: the PLC refused a register.
        DataError: the length that WR+8 gives reaches past the registers that can hold it.
        LineError: no answer.
    """
    hint = f"check that {start} is the instruction's operand WR"
    message = kind is not None and kind.is_message
    reason = misplaced("WR", start, WR_WORDS + message)
    if reason is not None:
        raise UsageError(reason, hint=hint, element=str(start))
    words = read_words(plc, start, WR_WORDS + message, hint)
    state = InstructionState.parse(words[:WR_WORDS], kind)
    if kind is TableKind.MD3:
        log = read_words(plc, Element("R", 4058), 2, "a PLC without them has no high-speed link (MD3)")
        return ResultReport(kind, state, decode_high_speed({"R4058": log[0], "R4059": log[1]}))
    if not message:
        return ResultReport(kind, state)
    length = words[WR_WORDS]
    count = min(length, MAX_RECEIVED)
    reason = misplaced("WR", start, WR_WORDS + 1 + count)
    if reason is not None:
        raise DataError(
            f"WR+8 says that {length} bytes were received; {reason}", hint=hint, element=str(start)
        )
    data = read_words(plc, start.after(WR_WORDS + 1), count, hint) if count else ()
    return ResultReport(kind, state, None, length, bytes(word & 0xFF for word in data))


def require_register(start: Element, operand: str) -> None:
    """Check that an operand is an R or a D.

    Raises:
        UsageError: it is none.
    """
    if start.symbol not in {"R", "D"}:
        raise UsageError(f"{operand} {start}: expected a register R or D", element=str(start))


def read_words(plc: Plc, start: Element, count: int, hint: str | None = None) -> tuple[int, ...]:
    """Read registers that follow each other, all of them.

    Args:
        plc: the PLC.
        start: the first.
        count: how many.
        hint: what to look at if the PLC refuses some; by default whether the table begins there.

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
            hint=hint or f"check that the table begins at {start}",
            element=str(start),
        )
    return tuple(reading.values[element] for element in elements)
