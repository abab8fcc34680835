"""Requests as Modbus PDUs, and the answers back, by a map.

::

    ReadDiscretes     01, 02     ReadRegisters     03, 04; of words of discretes (WM8) 01, 02
    WriteDiscretes    0F, or 05 for one            ControlDiscrete   05, set and reset only
    WriteRegisters    10, or 06 for one; of words of discretes 0F

A run of 32-bit counters includes those between, see ``sizes``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, TypeVar, cast

from fatektool.errors import FrameError, GatewayTimeout, PlcBusy, PlcRefused, UsageError
from fatektool.protocol.commands import (
    Control,
    ControlDiscrete,
    ReadDiscretes,
    Request,
    WriteDiscretes,
    WriteRegisters,
)
from fatektool.protocol.modbus import pdu as modbus_pdu
from fatektool.protocol.modbus.map import ModbusArea
from fatektool.protocol.modbus.pdu import Pdu
from fatektool.protocol.modbus.sizes import answer_size, count_of, first_of, most, of_bits, units_of
from fatektool.protocol.plc_errors import asked

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fatektool.protocol.modbus.map import ModbusMap

A = TypeVar("A")

MEANINGS: Final = {
    0x01: "illegal function",
    0x02: "illegal data address, not in the PLC's Modbus map",
    0x03: "illegal data value, or too many at once",
    0x04: "the PLC could not execute it",
    0x05: "accepted, not completed yet",
    0x06: "the PLC is busy",
    0x08: "a parity error in the PLC's memory",
}
GATEWAY: Final = {0x0A: "no path to the PLC", 0x0B: "no answer from the PLC"}
_AT_THE_GATEWAY: Final = {
    0x0A: "check that the gateway's table has this station, at the right port, and check --station; "
    "an overloaded gateway reports the same",
    0x0B: "check that the PLC is on, its station, and that the gateway's serial port has its speed and "
    "format; a PLC slower than the gateway's own time-out has the same effect",
}
_NO_PATH: Final = 0x0A
_ACCEPTED: Final = 0x05
_BUSY: Final = (_ACCEPTED, 0x06)
_NEXT: Final = {
    0x01: "check that it is a FATEK PLC: others have other functions",
    0x02: "'fatektool modbus map' shows the standard map; a PLC with R3968 = A55AH needs --modbus-map",
}
_READS: Final = {
    ModbusArea.COIL: 0x01,
    ModbusArea.DISCRETE_INPUT: 0x02,
    ModbusArea.HOLDING_REGISTER: 0x03,
    ModbusArea.INPUT_REGISTER: 0x04,
}
AREAS: Final = {function: area for area, function in _READS.items()} | {
    modbus_pdu.WRITE_COIL: ModbusArea.COIL,
    modbus_pdu.WRITE_COILS: ModbusArea.COIL,
    modbus_pdu.WRITE_REGISTER: ModbusArea.HOLDING_REGISTER,
    modbus_pdu.WRITE_REGISTERS: ModbusArea.HOLDING_REGISTER,
}


# --- requests -------------------------------------------------------------------------------------


def function_of(request: Request[Any], modbus_map: ModbusMap) -> int:
    """The function of this request.

    Raises:
        UsageError: Modbus has no such request.
    """
    if not request.writes:
        return _READS[modbus_map.place(first_of(request), count_of(request)).area]
    one = units_of(request) == 1
    if of_bits(first_of(request).symbol):
        return modbus_pdu.WRITE_COIL if one else modbus_pdu.WRITE_COILS
    return modbus_pdu.WRITE_REGISTER if one else modbus_pdu.WRITE_REGISTERS


def request_pdu(request: Request[Any], modbus_map: ModbusMap) -> bytes:
    """A request as a PDU.

    Raises:
        UsageError: an element without a reference, too many of them, or a command that Modbus does not have.
    """
    first, count = first_of(request), count_of(request)
    limit = most(first.symbol, writes=request.writes)
    if not 1 <= count <= limit:
        raise UsageError(f"{request.command.words} from {first}: expected 1 to {limit} elements, got {count}")
    if isinstance(request, ControlDiscrete) and request.control not in {Control.SET, Control.RESET}:
        raise UsageError(f"Modbus has no such command: {request.control.name.lower()} {first}")
    place = modbus_map.place(first, count, writes=request.writes)
    function = function_of(request, modbus_map)
    if not request.writes:
        return modbus_pdu.request_bytes(Pdu(function, place.offset, place.count))
    values = _written(request)
    if of_bits(first.symbol):
        return modbus_pdu.request_bytes(Pdu(function, place.offset, bits=tuple(map(bool, values))))
    return modbus_pdu.request_bytes(Pdu(function, place.offset, registers=values))


def _written(request: Request[Any]) -> tuple[int, ...]:
    """The bits or registers of a write, the lowest first."""
    match request:
        case ControlDiscrete(control):
            return (int(control is Control.SET),)
        case WriteDiscretes(_, values):
            return tuple(map(int, values))
        case WriteRegisters(first, values):
            each = 1 if of_bits(first.symbol) else 16
            mask = (1 << each) - 1
            return tuple(
                value >> shift & mask for value in values for shift in range(0, first.kind.bits, each)
            )
    raise TypeError(f"{type(request).__name__} writes nothing")


# --- answers --------------------------------------------------------------------------------------


def parse_answer(request: Request[A], pdu: bytes, modbus_map: ModbusMap) -> A:
    """The answer to this request in a PDU.

    Raises:
        PlcRefused: an exception.
        PlcBusy: a temporary exception.
        GatewayTimeout: a gateway reports that it got no answer.
        FrameError: not an answer to this request, by length or content.
    """
    said = modbus_pdu.parse_answer(pdu)
    if said.exception:
        raise _refusal(request, said)
    place = modbus_map.place(first_of(request), count_of(request), writes=request.writes)
    if request.writes:
        _check_echo(request, said, place.offset, place.count, pdu)
        return cast("A", None)
    expected = answer_size(request)
    if len(pdu) != expected:
        raise FrameError(f"answer to {asked(request)}: expected {expected} bytes, got {len(pdu)}", raw=pdu)
    if isinstance(request, ReadDiscretes):
        return cast("A", tuple(said.bits[: request.count]))
    first = first_of(request)
    if of_bits(first.symbol):
        values = _joined(said.bits[: place.count], first.kind.bits)
    elif first.symbol == "DRC":
        values = _joined(said.registers, 2)[::2]
    else:
        values = _joined(said.registers, first.kind.words)
    return cast("A", values)


def answer_pdu(request: Request[A], answer: A, modbus_map: ModbusMap) -> bytes:
    """The answer to a request as a PDU; the registers between 32-bit counters are 0."""
    first = first_of(request)
    place = modbus_map.place(first, count_of(request), writes=request.writes)
    function = function_of(request, modbus_map)
    if request.writes:
        values = _written(request)
        bits, registers = (tuple(map(bool, values)), ()) if of_bits(first.symbol) else ((), values)
        if len(values) == 1:
            return modbus_pdu.answer_bytes(Pdu(function, place.offset, bits=bits, registers=registers))
        return modbus_pdu.answer_bytes(Pdu(function, place.offset, len(values)))
    values = tuple(map(int, cast("Sequence[int]", answer)))
    if of_bits(first.symbol):
        bits = tuple(bool(value >> bit & 1) for value in values for bit in range(first.kind.bits))
        return modbus_pdu.answer_bytes(Pdu(function, bits=bits))
    registers = tuple(value >> shift & 0xFFFF for value in values for shift in range(0, first.kind.bits, 16))
    if first.symbol == "DRC":
        padded = [word for at in range(0, len(registers), 2) for word in (*registers[at : at + 2], 0, 0)]
        registers = tuple(padded[:-2])
    return modbus_pdu.answer_bytes(Pdu(function, registers=registers))


def exception_text(code: int) -> str:
    """The meaning of an exception."""
    if code in GATEWAY:
        return f"the gateway reports: {GATEWAY[code]}"
    return MEANINGS.get(code, "a code that Modbus does not list")


def _check_echo(request: Request[Any], said: Pdu, offset: int, count: int, pdu: bytes) -> None:
    """A write's answer repeats the address, and the value or the count."""
    values = _written(request)
    same = (
        (tuple(map(int, said.bits)) or tuple(said.registers)) == values
        if len(values) == 1
        else said.count == count
    )
    if said.offset != offset or not same:
        raise FrameError(f"answer to {asked(request)}: it repeats another write", raw=pdu)


def _joined(parts: Sequence[int], each: int) -> tuple[int, ...]:
    """Bits or registers joined to values, a number of them for each, the lowest first."""
    width = 16 if each < 16 else 1
    return tuple(
        sum(int(part) << (place * width) for place, part in enumerate(parts[at : at + each]))
        for at in range(0, len(parts), each)
    )


def _refusal(request: Request[Any], said: Pdu) -> PlcRefused | PlcBusy | GatewayTimeout:
    code = said.exception
    if code in GATEWAY:
        return GatewayTimeout(
            f"{exception_text(code)} (exception {code:02X})",
            handed_on=code != _NO_PATH,
            hint=_AT_THE_GATEWAY[code],
        )
    meaning = exception_text(code)
    if code in _BUSY:
        return PlcBusy(
            f"the PLC did not {asked(request)} (Modbus function {said.function:02X}): exception {code:02X}, "
            f"{meaning}",
            code=code,
            command=said.function,
            accepted=code == _ACCEPTED,
        )
    return PlcRefused(
        f"the PLC refused to {asked(request)} (Modbus function {said.function:02X}): exception {code:02X}, "
        f"{meaning}",
        code=code,
        command=said.function,
        hint=_NEXT.get(code),
    )
