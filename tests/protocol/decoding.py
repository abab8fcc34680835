"""Feeding a decoder, and what comes out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.errors import FrameError
from fatektool.protocol.fatek.facon.codec import FACON

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.protocol.codec import Codec, Decoder, Frame
    from fatektool.protocol.commands import Request
    from fatektool.protocol.fatek.codec import FatekCodec


def drained(decoder: Decoder) -> list[Frame | FrameError]:
    """All that a decoder gives until it wants more."""
    found: list[Frame | FrameError] = []
    while True:
        try:
            frame = decoder.next_frame()
        except FrameError as error:
            found.append(error)
            continue
        if frame is None:
            return found
        found.append(frame)


def decoded(*chunks: bytes, codec: Codec = FACON) -> list[Frame | FrameError]:
    """Frames and errors in the order in which they come, until no more bytes are expected."""
    decoder = codec.decoder()
    found = []
    for chunk in chunks:
        decoder.feed(chunk)
        found += drained(decoder)
    if decoder.expect_no_more():
        found += drained(decoder)
    return found


def frames(chunks: Iterable[bytes], codec: Codec = FACON) -> list[Frame]:
    """Good frames only."""
    return [item for item in decoded(*chunks, codec=codec) if not isinstance(item, FrameError)]


def one_frame(raw: bytes, codec: Codec = FACON) -> Frame:
    """The only thing in these bytes."""
    (frame,) = decoded(raw, codec=codec)
    assert not isinstance(frame, FrameError)
    return frame


def request_of(frame: Frame, codec: FatekCodec = FACON) -> Request[object]:
    """The request that a frame holds."""
    return codec.data.parse_request(frame.command, frame.data)


def framed(body: bytes) -> bytes:
    """A frame around station, command and data, its checksum as the paper counts it."""
    head = b"\x02" + body
    return head + b"%02X" % (sum(head) % 256) + b"\x03"


def crc(data: bytes) -> bytes:
    """The CRC of M-series frames, step by step as its paper describes it, the low byte first."""
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ 0xA001 if value & 1 else value >> 1
    return bytes([value & 0xFF, value >> 8])


def sealed(header: int, payload: bytes) -> bytes:
    """An M-series frame around station, command and data."""
    checked = len(payload).to_bytes(2, "big") + payload
    return bytes([header, 0x10]) + checked + crc(checked) + b"\x55\xaa"


def query(payload: str) -> bytes:
    """An M-series request around a payload in hex."""
    return sealed(0x51, bytes.fromhex(payload))


def response(payload: str) -> bytes:
    """An M-series answer around a payload in hex."""
    return sealed(0x52, bytes.fromhex(payload))
