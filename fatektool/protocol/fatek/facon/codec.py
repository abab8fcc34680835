r"""FACON ASCII frames; requests and answers have the same form (FACON paper, section 2).

::

    STX(02) · station(2 hex) · command(2 hex) · data(0..500) · LRC(2 hex) · ETX(03)

The LRC is the sum of all bytes from STX to the last of the data, modulo 256. Hex digits are written as
capitals; small ones, which some devices send, are read too.

STX is never inside a frame, so a second one before ETX begins a new frame (``resync``). A frame of more than
508 bytes without ETX is dropped.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, TypeVar
from zlib import adler32

from fatektool.errors import FrameError, PlcRefused, UsageError
from fatektool.protocol.codec import Frame
from fatektool.protocol.commands import Command
from fatektool.protocol.fatek.codec import FatekCodec
from fatektool.protocol.fatek.facon.data import DATA
from fatektool.protocol.resync import Delimited

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request

A = TypeVar("A")

STX: Final = b"\x02"
ETX: Final = b"\x03"
FRAMING_BYTES: Final = 8  # STX, station, command, LRC, ETX
MAX_DATA: Final = 500
MAX_FRAME: Final = FRAMING_BYTES + MAX_DATA
LAST_STATION: Final = 0xFF
_LOOPBACK: Final = Command.LOOPBACK

_PAIRS: Final = [b"%02X" % value for value in range(256)]
_ENDS: Final = [pair + ETX for pair in _PAIRS]
_FRAME: Final = re.compile(rb"\x02([0-9A-Fa-f]{2})([0-9A-Fa-f]{2})([^\x03]{0,%d})([^\x03]{2})\x03" % MAX_DATA)


def lrc(data: bytes) -> bytes:
    """The checksum of all bytes from STX to the last data byte, at most a frame, as two hex digits."""
    return end_of(data)[:2]


def end_of(data: bytes) -> bytes:
    """Checksum and ETX for the bytes from STX to the last data byte, at most a frame."""
    if data.isascii():  # Adler-32's low half is the sum modulo 65521, which such a frame does not reach
        return _ENDS[adler32(data, 0) & 0xFF]
    return _ENDS[sum(data) & 0xFF]


def frame_bytes(station: int, command: int, data: bytes) -> bytes:
    """One frame.

    Args:
        station: 0 to 255; 0 is a broadcast; 255 is in no paper, but is used.
        command: the command's code.
        data: 0 to 500 characters without STX and ETX.

    Raises:
        UsageError: a station or data that does not fit into a frame.
    """
    if not 0 <= station <= LAST_STATION:
        raise UsageError(f"station: expected 0 to {LAST_STATION}, got {station}")
    if len(data) > MAX_DATA:
        raise UsageError(f"frame data: expected at most {MAX_DATA} characters, got {len(data)}")
    if 2 in data or 3 in data:
        raise UsageError("frame data: expected no STX (02) and no ETX (03)")
    body = b"\x02%b%b%b" % (_PAIRS[station], _PAIRS[command], data)
    return body + end_of(body)


class FaconDecoder(Delimited):
    """Splits a stream into FACON frames."""

    begin = STX
    end = ETX
    longest = MAX_FRAME

    def next_frame(self) -> Frame | None:
        """The next frame, or None if more bytes are needed.

        Raises:
            FrameError: bad bytes, dropped.
        """
        buffer = self._buffer
        found = _FRAME.match(buffer) if ETX in buffer else None
        if found and not buffer.rfind(STX, 0, found.end()):  # the usual case
            parts = found.group(0, 1, 2, 3, 4)
            del buffer[: found.end()]
            return _checked(*parts)
        return super().next_frame()

    def _parse(self, raw: bytes) -> Frame:
        return parse_frame(raw)


def parse_frame(raw: bytes) -> Frame:
    """Parse one frame from STX to ETX.

    Raises:
        FrameError: a wrong checksum (then ``checksum`` is True), or not a frame.
    """
    if (found := _FRAME.fullmatch(raw)) and not raw.rfind(STX):
        return _checked(*found.group(0, 1, 2, 3, 4))
    if not FRAMING_BYTES <= len(raw) <= MAX_FRAME or raw[:1] != STX or raw[-1:] != ETX:
        raise FrameError(
            f"invalid frame: expected STX to ETX, {FRAMING_BYTES} to {MAX_FRAME} bytes, got {len(raw)} bytes",
            raw=raw,
        )
    raise FrameError("station or command is not two hex digits", raw=raw)


def _checked(raw: bytes, station: bytes, command: bytes, data: bytes, checksum: bytes) -> Frame:
    """A frame whose form is right, after a check of the checksum.

    Raises:
        FrameError: the checksum is wrong.
    """
    expected = lrc(raw[:-3])
    if checksum != expected and checksum.upper() != expected:
        got = checksum.decode("latin-1")
        raise FrameError(f"checksum: expected {expected.decode()}, got {got!r}", raw=raw, checksum=True)
    return Frame(int(station, 16), int(command, 16), data, raw)


class FaconCodec(FatekCodec):
    """FACON ASCII as a ``Codec``; requests and answers have the same form."""

    name = "facon"
    commands = DATA.commands
    loopback_alphabet = bytes(char for char in range(128) if char not in STX + ETX)
    data_bits = 7
    default_tcp_port = 500
    last_error = 0xF
    data = DATA
    framing_bytes = FRAMING_BYTES

    def __init__(self) -> None:
        super().__init__(frame_bytes, frame_bytes)

    def decoder(self) -> FaconDecoder:
        """A new decoder for one stream."""
        return FaconDecoder()

    def good_answer(self, request: Request[A], asked: bytes, raw: bytes) -> A:
        """The contents of a valid answer: it begins like its request, up to the command."""
        command = request.command
        if raw[:6] != asked[:5] + b"0" or raw[-3:] != end_of(raw[:-3]) or command == _LOOPBACK:
            raise FrameError("not the expected answer", raw=raw)
        data = self.data
        answer: A = data.rows[command].parse_answer(data.notation, request, raw[6:-3])
        return answer

    def checksum(self, data: bytes) -> bytes:
        """The LRC of everything from STX to the last data byte."""
        return _PAIRS[sum(data) & 0xFF]

    def error_text(self, code: int) -> str:
        """The meaning of an error code."""
        from fatektool.protocol.plc_errors import meaning_of

        return meaning_of(code)

    def echo_may_pass(self, request: Request[A]) -> bool:
        """True if the data of a request is also a valid answer to it.

        The echo of 4E and of STOP is also a valid answer. So is that of one DD with 46, and of some with 48,
        which have only hex digits; that of RUN reads as error 1.
        """
        try:
            self.data.parse_answer(request, self.data.request_data(request))
        except FrameError:
            return False
        except PlcRefused:
            return True
        return True


FACON: Final = FaconCodec()
