"""Modbus TCP.

::

    number(2) · 00 00 · length(2) · station(1) · PDU

It has a length, but no checksum: the network has its own. An answer repeats the number of its request.
"""

from __future__ import annotations

from typing import Final

from fatektool.errors import FrameError
from fatektool.protocol.codec import Frame
from fatektool.protocol.modbus.codec import ModbusCodec
from fatektool.protocol.modbus.framing import MAX_PDU, FramePart, Framing, always
from fatektool.protocol.modbus.pdu import EXCEPTION
from fatektool.protocol.modbus.sizes import TELLING, pdu_sizes
from fatektool.protocol.resync import Measured

TCP_HEADER: Final = 7


def _encode(station: int, pdu: bytes, number: int = 0) -> bytes:
    return b"%b\0\0%b%c%b" % (number.to_bytes(2, "big"), (1 + len(pdu)).to_bytes(2, "big"), station, pdu)


class TcpDecoder(Measured):
    """Splits a stream into TCP frames, requests and answers."""

    def _sizes(self, at: int) -> tuple[int, ...] | None:
        buffer = self._buffer
        head = buffer[at : at + TCP_HEADER]
        if any(head[2:4]):
            return ()
        if len(head) < TCP_HEADER:
            return () if head[4:5] > b"\0" else None
        size = int.from_bytes(head[4:6], "big") - 1
        if not 2 <= size <= MAX_PDU:
            return ()
        possible = pdu_sizes(buffer, at + TCP_HEADER, at + TCP_HEADER + min(size, TELLING))
        return (TCP_HEADER + size,) if possible is None or size in possible else ()

    def _frame(self, raw: bytes) -> Frame:
        number = int.from_bytes(raw[:2], "big")
        return Frame(raw[6], raw[7] & ~EXCEPTION, raw[7:], raw, number)

    def _fault(self, raw: bytes) -> FrameError:
        return FrameError("invalid frame", raw=raw)  # cannot happen: a frame of the right length is valid


def _number(raw: bytes) -> str:
    return f"{int.from_bytes(raw, 'big')}; the answer repeats it"


def _length(raw: bytes) -> str:
    return f"{int.from_bytes(raw, 'big')} bytes follow"


TCP: Final = ModbusCodec(
    Framing(
        "modbus-tcp",
        "a number, 00 00, a length, station, function, data",
        _encode,
        TcpDecoder,
        lambda size: size + TCP_HEADER,
        lambda raw: raw[:4] + raw[6:8],
        before=(
            FramePart("number", 2, _number),
            FramePart("protocol", 2, always("Modbus")),
            FramePart("length", 2, _length),
        ),
        tcp_port=502,
        stations=range(256),
        own_units=frozenset({0, 255}),
        numbers=1 << 16,
    )
)
