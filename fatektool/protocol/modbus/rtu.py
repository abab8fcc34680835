"""Modbus RTU.

::

    station(1) · PDU · CRC(2, low byte first)

Only silence marks the beginning and end of an RTU frame, and adapters do not pass on silence. So its length
is found from its function and byte count, for the request and for the answer of this function, and the CRC
shows which it is.
"""

from __future__ import annotations

from typing import Final

from fatektool.errors import FrameError
from fatektool.protocol.codec import Frame
from fatektool.protocol.modbus.codec import ModbusCodec
from fatektool.protocol.modbus.framing import LAST_STATION, FramePart, Framing, always
from fatektool.protocol.modbus.pdu import EXCEPTION, crc_bytes
from fatektool.protocol.modbus.sizes import TELLING, pdu_sizes
from fatektool.protocol.resync import Measured


def _encode(station: int, pdu: bytes, number: int = 0) -> bytes:
    del number
    body = bytes([station]) + pdu
    return body + crc_bytes(body)


class RtuDecoder(Measured):
    """Splits a stream into RTU frames, requests and answers."""

    def _sizes(self, at: int) -> tuple[int, ...] | None:
        buffer = self._buffer
        if buffer[at] > LAST_STATION:
            return ()
        sizes = pdu_sizes(buffer, at + 1, at + 1 + TELLING)
        return None if sizes is None else tuple(size + 3 for size in sizes)

    def _frame(self, raw: bytes) -> Frame | None:
        if crc_bytes(raw[:-2]) != raw[-2:]:
            return None
        return Frame(raw[0], raw[1] & ~EXCEPTION, raw[1:-2], raw)

    def _fault(self, raw: bytes) -> FrameError:
        return FrameError("checksum: wrong CRC", raw=raw, checksum=True)


RTU: Final = ModbusCodec(
    Framing(
        "modbus-rtu",
        "station, function, data, a CRC",
        _encode,
        RtuDecoder,
        lambda size: size + 3,
        lambda raw: raw[:2],
        after=(FramePart("CRC", 2, always("right")),),
        checksum=crc_bytes,
        data_bits=8,
        quiet_chars=3.5,
    )
)
