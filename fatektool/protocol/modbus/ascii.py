"""Modbus ASCII.

::

    : · station and PDU in hex digits · LRC(2 hex digits) · CR LF

Like STX in FACON, ``:`` is never inside a frame, so a second one begins a new frame.
"""

from __future__ import annotations

from binascii import unhexlify
from typing import Final

from fatektool.counts import counted
from fatektool.errors import FrameError
from fatektool.protocol.codec import Frame
from fatektool.protocol.modbus.codec import ModbusCodec
from fatektool.protocol.modbus.framing import MAX_PDU, FramePart, Framing, always
from fatektool.protocol.modbus.pdu import EXCEPTION, lrc_byte
from fatektool.protocol.resync import Delimited

MAX_ASCII: Final = 7 + 2 * MAX_PDU
MIN_ASCII: Final = 11
_HEX_DIGITS: Final = b"0123456789ABCDEF"


def _encode(station: int, pdu: bytes, number: int = 0) -> bytes:
    del number
    body = bytes([station]) + pdu
    return b":" + (body + bytes([lrc_byte(body)])).hex().upper().encode() + b"\r\n"


def _checksum(data: bytes) -> bytes:
    return b"%02X" % lrc_byte(data)


class AsciiDecoder(Delimited):
    """Splits a stream into ASCII frames."""

    begin = b":"
    end = b"\r\n"
    longest = MAX_ASCII

    def _parse(self, raw: bytes) -> Frame:
        return parse_ascii(raw)


def parse_ascii(raw: bytes) -> Frame:
    """Parse one ASCII frame from ``:`` to CR LF.

    Raises:
        FrameError: a wrong checksum (then ``checksum`` is True), or not a frame.
    """
    digits = raw[1:-2]
    if not MIN_ASCII <= len(raw) <= MAX_ASCII or len(digits) % 2 or digits.translate(None, _HEX_DIGITS):
        raise FrameError(
            f"invalid frame: expected {MIN_ASCII} to {MAX_ASCII} bytes of capital hex digits in pairs, "
            f"got {counted(len(raw), 'byte')}",
            raw=raw,
        )
    content = unhexlify(digits)
    expected = lrc_byte(content[:-1])
    if content[-1] != expected:
        raise FrameError(f"checksum: expected {expected:02X}, got {content[-1]:02X}", raw=raw, checksum=True)
    return Frame(content[0], content[1] & ~EXCEPTION, content[1:-1], raw)


ASCII: Final = ModbusCodec(
    Framing(
        "modbus-ascii",
        "a colon, hex digits, an LRC, CR LF",
        _encode,
        AsciiDecoder,
        lambda size: 2 * size + 7,
        lambda raw: raw[:5],
        before=(FramePart("start", 1, always("begins a frame")),),
        after=(FramePart("LRC", 2, always("right")), FramePart("end", 2, always("CR LF"))),
        checksum=_checksum,
        octet=2,
        data_bits=7,
    )
)
