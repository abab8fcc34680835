"""Modbus PDUs and checksums, by pymodbus: the only file that uses it, and loads it only when needed.

::

    function(1) · offset(2) · count(2)                      01 02 03 04 request, 0F 10 answer
    function(1) · offset(2) · value(2)                      05 06, request and answer; 05: FF00 on, 0000 off
    function(1) · offset(2) · count(2) · n(1) · n bytes     0F 10 request
    function(1) · n(1) · n bytes                            01 02 03 04 answer
    function + 80(1) · exception(1)                         any answer

pymodbus accepts some invalid PDUs: it drops bytes after a PDU, accepts any value for 'on', and does not check
a byte count. So the parsed PDU is encoded again, and accepted only if the result has the same bytes.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Final

from fatektool.errors import FrameError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pymodbus.framer import FramerAscii, FramerRTU
    from pymodbus.pdu import ModbusPDU

EXCEPTION: Final = 0x80
READ_COILS: Final = 0x01
READ_DISCRETE_INPUTS: Final = 0x02
READ_HOLDING_REGISTERS: Final = 0x03
READ_INPUT_REGISTERS: Final = 0x04
WRITE_COIL: Final = 0x05
WRITE_REGISTER: Final = 0x06
WRITE_COILS: Final = 0x0F
WRITE_REGISTERS: Final = 0x10

FUNCTION_WORDS: Final = {
    READ_COILS: "read coils",
    READ_DISCRETE_INPUTS: "read discrete inputs",
    READ_HOLDING_REGISTERS: "read holding registers",
    READ_INPUT_REGISTERS: "read input registers",
    WRITE_COIL: "write one coil",
    WRITE_REGISTER: "write one register",
    WRITE_COILS: "write coils",
    WRITE_REGISTERS: "write registers",
}
READS: Final = frozenset({READ_COILS, READ_DISCRETE_INPUTS, READ_HOLDING_REGISTERS, READ_INPUT_REGISTERS})
OF_BITS: Final = frozenset({READ_COILS, READ_DISCRETE_INPUTS, WRITE_COIL, WRITE_COILS})


@dataclass(frozen=True, slots=True)
class Pdu:
    """The contents of a PDU.

    Attributes:
        function: 01 to 06, 0F, 10.
        offset: the address; 0 in the answer to a read, which has none.
        count: of elements; in a read's answer as many as its bytes have.
        bits: states of coils or inputs; in the answer to a read with the rest of the last byte.
        registers: values.
        exception: 0 for none.
    """

    function: int
    offset: int = 0
    count: int = 0
    bits: Sequence[bool] = ()
    registers: Sequence[int] = ()
    exception: int = 0


def request_bytes(pdu: Pdu) -> bytes:
    """A request."""
    return _written(_requests()[pdu.function], pdu)


def answer_bytes(pdu: Pdu) -> bytes:
    """An answer."""
    if pdu.exception:
        return bytes([pdu.function | EXCEPTION, pdu.exception])
    return _written(_answers()[pdu.function], pdu)


def parse_request(data: bytes) -> Pdu:
    """Parse a request.

    Raises:
        FrameError: another function, or an invalid form.
    """
    return _read(_requests(), data)


def parse_answer(data: bytes) -> Pdu:
    """Parse an answer or an exception.

    Raises:
        FrameError: another function, or an invalid form.
    """
    if data[:1] >= b"\x80":
        if len(data) != 2 or not data[1]:
            raise FrameError("exception: expected its code and nothing else", raw=data)
        return Pdu(data[0] & ~EXCEPTION, exception=data[1])
    return _read(_answers(), data)


def crc_bytes(data: bytes) -> bytes:
    """The CRC of RTU, as sent."""
    return _rtu().compute_CRC(data).to_bytes(2, "big")


def lrc_byte(data: bytes) -> int:
    """The LRC of ASCII."""
    return _ascii().compute_LRC(data)


def _read(classes: dict[int, type[ModbusPDU]], data: bytes) -> Pdu:
    from pymodbus.exceptions import ModbusException

    kind = classes.get(data[0]) if data else None
    if kind is None:
        raise FrameError(f"function {data[:1].hex().upper() or 'none'} is not supported", raw=data)
    read = kind()
    try:
        read.decode(data[1:])
        said = Pdu(data[0], read.address, read.count, tuple(read.bits), tuple(read.registers))
        again = _written(kind, said)
    except (ModbusException, ValueError, IndexError, struct.error) as error:
        raise FrameError(f"{FUNCTION_WORDS[data[0]]}: {error}", raw=data) from error
    if again != data:
        raise FrameError(f"{FUNCTION_WORDS[data[0]]}: invalid lengths or values", raw=data)
    return said


def _written(kind: type[ModbusPDU], pdu: Pdu) -> bytes:
    made = kind()
    made.address = pdu.offset
    made.bits = list(pdu.bits)
    made.registers = list(pdu.registers)
    made.count = pdu.count or len(pdu.bits) or len(pdu.registers)
    return bytes([pdu.function]) + made.encode()


@cache
def _requests() -> dict[int, type[ModbusPDU]]:
    from pymodbus.pdu import bit_message, register_message

    return {
        READ_COILS: bit_message.ReadCoilsRequest,
        READ_DISCRETE_INPUTS: bit_message.ReadDiscreteInputsRequest,
        READ_HOLDING_REGISTERS: register_message.ReadHoldingRegistersRequest,
        READ_INPUT_REGISTERS: register_message.ReadInputRegistersRequest,
        WRITE_COIL: bit_message.WriteSingleCoilRequest,
        WRITE_REGISTER: register_message.WriteSingleRegisterRequest,
        WRITE_COILS: bit_message.WriteMultipleCoilsRequest,
        WRITE_REGISTERS: register_message.WriteMultipleRegistersRequest,
    }


@cache
def _answers() -> dict[int, type[ModbusPDU]]:
    from pymodbus.pdu import bit_message, register_message

    return {
        READ_COILS: bit_message.ReadCoilsResponse,
        READ_DISCRETE_INPUTS: bit_message.ReadDiscreteInputsResponse,
        READ_HOLDING_REGISTERS: register_message.ReadHoldingRegistersResponse,
        READ_INPUT_REGISTERS: register_message.ReadInputRegistersResponse,
        WRITE_COIL: bit_message.WriteSingleCoilResponse,
        WRITE_REGISTER: register_message.WriteSingleRegisterResponse,
        WRITE_COILS: bit_message.WriteMultipleCoilsResponse,
        WRITE_REGISTERS: register_message.WriteMultipleRegistersResponse,
    }


@cache
def _rtu() -> type[FramerRTU]:
    from pymodbus.framer import FramerRTU

    return FramerRTU


@cache
def _ascii() -> type[FramerAscii]:
    from pymodbus.framer import FramerAscii

    return FramerAscii
