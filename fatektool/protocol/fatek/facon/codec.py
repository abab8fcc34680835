r"""FACON ASCII frames, both ways the same form (FACON paper, section 2).

::

    STX(02) · station(2 hex) · command(2 hex) · data(0..500) · LRC(2 hex) · ETX(03)

The LRC is the sum of all bytes from STX to the last of the data, modulo 256, in two capital hex digits.

The decoder's strategy: hunt for STX, then for ETX. STX never stands inside a frame, so a second one
before ETX begins a new frame and what stood before it is dropped: a good frame behind a bad one is
never lost. A frame that passes 508 bytes without ETX is dropped.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, TypeVar
from zlib import adler32

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.codec import Frame
from fatektool.protocol.fatek.commands import FatekCommands
from fatektool.protocol.fatek.facon import data as facon_data
from fatektool.protocol.plc_errors import meaning_of

if TYPE_CHECKING:
    from fatektool.protocol.commands import Command, Request

A = TypeVar("A")

STX: Final = b"\x02"
ETX: Final = b"\x03"
FRAMING_BYTES: Final = 8  # STX, station, command, LRC, ETX
MAX_DATA: Final = 500
MAX_FRAME: Final = FRAMING_BYTES + MAX_DATA
LAST_STATION: Final = 0xFF
_MAX_BUFFER: Final = 1 << 16

_PAIRS: Final = [b"%02X" % value for value in range(256)]
_VALUES: Final = {pair: value for value, pair in enumerate(_PAIRS)}
_FRAME: Final = re.compile(rb"\x02([0-9A-F]{2})([0-9A-F]{2})([^\x03]{0,%d})([^\x03]{2})\x03" % MAX_DATA)


def lrc(data: bytes) -> bytes:
    """The checksum of everything from STX to the last data byte, at most a frame, as two hex digits."""
    if data.isascii():  # Adler-32's low half is the sum modulo 65521, which such a frame does not reach
        return _PAIRS[adler32(data, 0) & 0xFF]
    return _PAIRS[sum(data) & 0xFF]


def frame_bytes(station: int, command: int, data: bytes) -> bytes:
    """One frame.

    Args:
        station: 0 to 255; 0 is everyone, and nobody answers; 255 is in no paper, and is used.
        command: the command's code.
        data: 0 to 500 characters without STX and ETX.

    Raises:
        UsageError: a station or data that no frame can carry.
    """
    if not 0 <= station <= LAST_STATION:
        raise UsageError(f"station: expected 0 to {LAST_STATION}, got {station}")
    if len(data) > MAX_DATA:
        raise UsageError(f"frame data: expected at most {MAX_DATA} characters, got {len(data)}")
    if STX in data or ETX in data:
        raise UsageError("frame data: STX (02) and ETX (03) cannot stand inside a FACON frame")
    body = b"\x02%b%b%b" % (_PAIRS[station], _PAIRS[command], data)
    return b"%b%b\x03" % (body, lrc(body))


class FaconDecoder:
    """Cuts FACON frames out of a stream, whatever its chunks."""

    def __init__(self) -> None:
        self._buffer = bytearray()

    def feed(self, data: bytes) -> None:
        """Take bytes from the wire; of more than 64 KiB not asked for, the oldest are forgotten."""
        self._buffer += data
        if len(self._buffer) > _MAX_BUFFER:
            del self._buffer[:-_MAX_BUFFER]

    def clear(self) -> int:
        """Forget what was fed and not yet given; return how many bytes that was."""
        count = len(self._buffer)
        self._buffer.clear()
        return count

    def expect_no_more(self) -> bool:
        """False: behind a frame that has not ended nothing can stand, as STX would have begun another."""
        return False

    def next_frame(self) -> Frame | None:
        """Give the next frame, or None when more bytes are needed.

        Raises:
            FrameError: bad bytes, dropped.
        """
        buffer = self._buffer
        if not buffer:
            return None
        if (found := _FRAME.match(buffer)) and not buffer.rfind(STX, 0, found.end()):
            parts = found.group(0, 1, 2, 3, 4)
            del buffer[: found.end()]
            return _checked(*parts)
        start = buffer.find(STX)
        if start:
            raise FrameError("noise outside a frame", raw=self._take(start if start > 0 else len(buffer)))
        end = buffer.find(ETX, 1)
        again = buffer.find(STX, 1, end if end > 0 else len(buffer))
        if again > 0:
            raise FrameError("a frame broke off and another began", raw=self._take(again))
        if end < 0:
            if len(buffer) >= MAX_FRAME:
                raise FrameError(f"no end within {MAX_FRAME} bytes", raw=self._take(len(buffer)))
            return None
        return parse_frame(self._take(end + 1))

    def _take(self, count: int) -> bytes:
        taken = bytes(self._buffer[:count])
        del self._buffer[:count]
        return taken


def parse_frame(raw: bytes) -> Frame:
    """Read one frame from STX to ETX.

    Raises:
        FrameError: a wrong checksum (then ``checksum`` is True), or no frame.
    """
    if (found := _FRAME.fullmatch(raw)) and not raw.rfind(STX):
        return _checked(*found.group(0, 1, 2, 3, 4))
    if not FRAMING_BYTES <= len(raw) <= MAX_FRAME or raw[:1] != STX or raw[-1:] != ETX:
        raise FrameError(
            f"no frame: expected STX, {FRAMING_BYTES} to {MAX_FRAME} bytes, ETX; got {len(raw)} bytes",
            raw=raw,
        )
    raise FrameError("station or command is not two capital hex digits", raw=raw)


def _checked(raw: bytes, station: bytes, command: bytes, data: bytes, checksum: bytes) -> Frame:
    """What is a frame but for its checksum, as one.

    Raises:
        FrameError: the checksum is wrong.
    """
    expected = lrc(raw[:-3])
    if checksum != expected:
        got = checksum.decode("latin-1")
        raise FrameError(f"checksum: expected {expected.decode()}, got {got!r}", raw=raw, checksum=True)
    return Frame(_VALUES[station], _VALUES[command], data, raw)


class FaconCodec(FatekCommands):
    """FACON ASCII as a ``Codec``."""

    name: Final = "facon"
    commands: Final[frozenset[Command]] = facon_data.COMMANDS
    last_error: Final = 0xF
    loopback_alphabet: Final = bytes(char for char in range(128) if char not in STX + ETX)
    data_bits: Final = 7
    default_tcp_port: Final = 500

    def decoder(self) -> FaconDecoder:
        """A new decoder for one stream."""
        return FaconDecoder()

    def encode(self, station: int, request: Request[A], number: int = 0) -> bytes:
        """The request as one frame for this station."""
        del number  # a frame has no room for it
        return frame_bytes(station, request.command, facon_data.request_data(request))

    def parse_request(self, frame: Frame) -> Request[object]:
        """The request that a frame holds."""
        return facon_data.parse_request(frame.command, frame.data)

    def parse_answer(self, request: Request[A], frame: Frame) -> A:
        """What a frame answers to this request."""
        return facon_data.parse_answer(request, frame.data)

    def encode_answer(self, station: int, request: Request[A], answer: A, number: int = 0) -> bytes:
        """The frame in which a PLC gives this answer."""
        del number
        return frame_bytes(station, request.command, facon_data.answer_data(request, answer))

    def encode_raw(
        self,
        station: int,
        command: int,
        data: bytes,
        number: int = 0,
        *,
        answer: bool = False,
    ) -> bytes:
        """A frame with any command and data; requests and answers have the same form."""
        del number, answer
        return frame_bytes(station, command, data)

    def encode_refusal(self, station: int, command: int, code: int, number: int = 0) -> bytes:
        """The frame in which a PLC refuses this command."""
        del number
        return frame_bytes(station, command, b"%X" % code)

    def checksum(self, data: bytes) -> bytes:
        """The LRC of everything from STX to the last data byte."""
        return _PAIRS[sum(data) & 0xFF]

    def error_text(self, code: int) -> str:
        """An error code in words."""
        return meaning_of(code)

    def request_bytes(self, request: Request[A]) -> int:
        """Length of the frame that asks this, in bytes."""
        return FRAMING_BYTES + len(facon_data.request_data(request))

    def answer_bytes(self, request: Request[A]) -> int:
        """Length of the frame that answers this request, in bytes."""
        return FRAMING_BYTES + facon_data.answer_chars(request)

    def echo_may_pass(self, request: Request[A]) -> bool:
        """True if the request's own echo could be taken for its answer."""
        return facon_data.echo_may_pass(request)


FACON: Final = FaconCodec()
