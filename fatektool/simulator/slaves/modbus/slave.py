"""Modbus for simulated PLCs: one function here for each function of Modbus.

::

    01 02  address count                     states, eight a byte, the first in bit 0
    03 04  address count                     values of 2 bytes
    05     address FF00 on, 0000 off         the same
    06     address value                     the same
    15     address count n, n bytes          address count
    16     address count n, n bytes          address count
    else                                     function + 80, exception

Exceptions: 01 an unknown function, 02 an address outside the map, 03 an invalid value or count. They are
checked in this order: function, form and count (03), addresses (02); nothing is written unless the whole
request is valid. ``map`` has the elements of the addresses, by R3968 at that moment.

No answer: to a wrong checksum or an unknown station. A broadcast (station 0) is executed by every PLC, and
none answers. Over TCP there is no broadcast: units 0 and 255 are the PLC at the address itself, the first
one, which executes and answers. Many clients always send 0. In a real PLC, R4047 sets the protocol of its
ports; here it is the command line.
"""

from __future__ import annotations

from struct import pack
from typing import TYPE_CHECKING

from fatektool.simulator.refusal import Refusal, RefusalCode
from fatektool.simulator.slaves.base import BROADCAST, RequestFrame, RequestKind, SlaveType, addressed
from fatektool.simulator.slaves.modbus.map import LONG_COUNTER, Piece, pieces

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.simulator.plc import SimulatedPlc
    from fatektool.simulator.slaves.modbus.framing import SlaveFraming

MAX_READ_BITS, MAX_READ_WORDS = 2000, 125
MAX_WRITE_BITS, MAX_WRITE_WORDS = 1968, 123
ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE = 1, 2, 3
_WRITES = {b"\x05", b"\x06", b"\x0f", b"\x10"}
_EXCEPTIONS = {RefusalCode.ILLEGAL_ADDRESS: ILLEGAL_ADDRESS, RefusalCode.ILLEGAL_VALUE: ILLEGAL_VALUE}


class ModbusSlave:
    """The Modbus slave of one line.

    Args:
        plcs: the PLCs on the line by station.
        framing: RTU, ASCII or TCP, used only by this line.
    """

    def __init__(self, plcs: Mapping[int, SimulatedPlc], framing: SlaveFraming) -> None:
        self.plcs = plcs
        self._framing = framing

    @property
    def delimiters(self) -> tuple[bytes, ...]:
        """The bytes that begin and end an answer."""
        return self._framing.delimiters

    def cut(self, data: bytes) -> list[RequestFrame]:
        """Receive bytes, in any pieces; returns the requests that they complete."""
        own = self._framing.own_units
        return [
            RequestFrame(
                found.end,
                found.raw,
                next(iter(self.plcs), 1) if found.body[0] in own else found.body[0],
                found.body[1:2],
                found.body[2:],
                RequestKind.WRITE if found.body[1:2] in _WRITES else RequestKind.OTHER,
            )
            for found in self._framing.feed(data)
        ]

    def answer(self, request: RequestFrame) -> bytes | None:
        """Execute a request; None for a broadcast and for unknown stations."""
        if request.station == BROADCAST:
            for plc in self.plcs.values():
                _execute(plc, request)
            return None
        here = addressed(self.plcs, request.station)
        if here is None:
            return None
        return self._framing.sealed(bytes((request.station,)) + _execute(here, request), request.raw)

    def readdressed(self, answer: bytes, station: int) -> bytes:
        """The same answer from another station, with a correct checksum."""
        return self._framing.readdressed(answer, station)

    def reset(self) -> None:
        """Drop an incomplete request."""
        self._framing.reset()


def _execute(plc: SimulatedPlc, request: RequestFrame) -> bytes:
    function = request.command[0]
    serve = _FUNCTIONS.get(function)
    if serve is None:
        return bytes((function | 0x80, ILLEGAL_FUNCTION))
    try:
        return request.command + serve(plc, function, request.data)
    except Refusal as refusal:
        return bytes((function | 0x80, _EXCEPTIONS.get(RefusalCode(refusal.code), ILLEGAL_VALUE)))


def _two(data: bytes) -> tuple[int, int]:
    if len(data) != 4:
        raise Refusal(RefusalCode.ILLEGAL_VALUE)
    return int.from_bytes(data[:2], "big"), int.from_bytes(data[2:], "big")


def _span(data: bytes, most: int) -> tuple[int, int]:
    address, count = _two(data)
    if not 1 <= count <= most:
        raise Refusal(RefusalCode.ILLEGAL_VALUE)
    return address, count


def _read_bits(plc: SimulatedPlc, function: int, data: bytes) -> bytes:
    address, count = _span(data, MAX_READ_BITS)
    states = b"".join(plc.read_discretes(*piece) for piece in pieces(plc, function, address, count))
    packed = sum(state << place for place, state in enumerate(states)).to_bytes((count + 7) // 8, "little")
    return bytes((len(packed),)) + packed


def _read_words(plc: SimulatedPlc, function: int, data: bytes) -> bytes:
    address, count = _span(data, MAX_READ_WORDS)
    values = [value for piece in pieces(plc, function, address, count) for value in _words(plc, piece)]
    return pack(f">B{count}H", 2 * count, *values)


def _words(plc: SimulatedPlc, piece: Piece) -> list[int]:
    if piece.symbol == LONG_COUNTER:
        return plc.read_long_counters(piece.first, piece.length)
    return plc.read_words(*piece)


def _write_bit(plc: SimulatedPlc, function: int, data: bytes) -> bytes:
    address, value = _two(data)
    if value not in {0xFF00, 0x0000}:
        raise Refusal(RefusalCode.ILLEGAL_VALUE)
    _set_bits(plc, pieces(plc, function, address, 1), bytes((value > 0,)))
    return data


def _write_word(plc: SimulatedPlc, function: int, data: bytes) -> bytes:
    address, value = _two(data)
    _set_words(plc, pieces(plc, function, address, 1), [value])
    return data


def _write_bits(plc: SimulatedPlc, function: int, data: bytes) -> bytes:
    address, count = _span(data[:4], MAX_WRITE_BITS)
    content = data[5:]
    if data[4:5] != bytes(((count + 7) // 8,)) or len(content) != data[4]:
        raise Refusal(RefusalCode.ILLEGAL_VALUE)
    packed = int.from_bytes(content, "little")
    _set_bits(
        plc, pieces(plc, function, address, count), bytes(packed >> place & 1 for place in range(count))
    )
    return data[:4]


def _write_words(plc: SimulatedPlc, function: int, data: bytes) -> bytes:
    address, count = _span(data[:4], MAX_WRITE_WORDS)
    content = data[5:]
    if data[4:5] != bytes((2 * count,)) or len(content) != 2 * count:
        raise Refusal(RefusalCode.ILLEGAL_VALUE)
    values = [int.from_bytes(content[at : at + 2], "big") for at in range(0, len(content), 2)]
    _set_words(plc, pieces(plc, function, address, count), values)
    return data[:4]


def _set_bits(plc: SimulatedPlc, where: list[Piece], states: bytes) -> None:
    for piece in where:
        plc.read_discretes(*piece)  # refuses before anything is written
    for piece in where:
        plc.write_discretes(piece.symbol, piece.first, states[: piece.length])
        states = states[piece.length :]


def _set_words(plc: SimulatedPlc, where: list[Piece], values: list[int]) -> None:
    for piece in where:
        _words(plc, piece)  # the same
    for piece in where:
        if piece.symbol == LONG_COUNTER:
            plc.write_long_counters(piece.first, values[: piece.length])
        else:
            plc.write_words(piece.symbol, piece.first, values[: piece.length])
        values = values[piece.length :]


_FUNCTIONS: dict[int, Callable[[SimulatedPlc, int, bytes], bytes]] = {
    1: _read_bits,
    2: _read_bits,
    3: _read_words,
    4: _read_words,
    5: _write_bit,
    6: _write_word,
    15: _write_bits,
    16: _write_words,
}


def slave_type(make_framing: Callable[[], SlaveFraming], bits_per_char: float) -> SlaveType:
    """A Modbus slave with a framing of its own for each line."""

    def make(plcs: Mapping[int, SimulatedPlc]) -> ModbusSlave:
        return ModbusSlave(plcs, make_framing())

    return SlaveType(make, "fbs-20mc", bits_per_char)
