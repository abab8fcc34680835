r"""M-series binary frames (M-series paper, section 1).

::

    51 request, 52 answer · 10 · length(2, high byte first) · payload(length) · CRC(2, low byte first) · 55 AA

    payload of a request  station(1) · command(1) · data
    payload of an answer  station(1) · command(1) · error(1) · data, but for 4E, which has no error byte

The CRC is CRC-16/MODBUS over length and payload.

55 AA may be in a payload, and so may a whole frame: only the length gives the end of a frame. ``resync``
finds the next frame after a wrong length or noise.

The tables of the paper allow 262 bytes of payload at most: 45 with 256 discretes. No paper has the length of
an answer to 53, so up to 453 are accepted (64 items of 7 bytes and 5 before them), and a wrong length never
causes a wait for more.
"""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING, Final, TypeVar

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.codec import Frame
from fatektool.protocol.commands import Command
from fatektool.protocol.fatek.codec import FatekCodec
from fatektool.protocol.fatek.mseries.crc import crc_bytes
from fatektool.protocol.fatek.mseries.data import DATA
from fatektool.protocol.fatek.mseries.errors import meaning_of
from fatektool.protocol.resync import Measured

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request

A = TypeVar("A")

QUERY: Final = 0x51
RESPONSE: Final = 0x52
ID: Final = 0x10
TERMINATOR: Final = b"\x55\xaa"
FRAMING_BYTES: Final = 8  # header, ID, length, CRC, terminator
MIN_PAYLOAD: Final = 2  # station, command
MAX_PAYLOAD: Final = 5 + 64 * 7
MAX_FRAME: Final = FRAMING_BYTES + MAX_PAYLOAD
LAST_STATION: Final = 0xFF
_SHORTEST_BEGINNING: Final = 4  # header, ID, length
_LOOPBACK: Final = Command.LOOPBACK

_BEGINNING: Final = re.compile(
    rb"[\x51\x52](?:\Z|\x10(?:\Z|\x00(?:\Z|[\x02-\xFF])|\x01(?:\Z|[\x00-\x%02X])))" % (MAX_PAYLOAD & 0xFF)
)
"""What may be the beginning of a frame, or all of it that was received so far."""


def frame_bytes(header: int, station: int, command: int, data: bytes) -> bytes:
    """One frame.

    Args:
        header: QUERY or RESPONSE.
        station: 0 to 255; 0 is a broadcast; 255 is in no paper, but is used.
        command: the command's code.
        data: 0 to 451 bytes.

    Raises:
        UsageError: a station or data that does not fit into a frame.
    """
    if not 0 <= station <= LAST_STATION:
        raise UsageError(f"station: expected 0 to {LAST_STATION}, got {station}")
    size = MIN_PAYLOAD + len(data)
    if size > MAX_PAYLOAD:
        raise UsageError(f"frame data: expected at most {MAX_PAYLOAD - MIN_PAYLOAD} bytes, got {len(data)}")
    checked = b"%b%c%c%b" % (size.to_bytes(2, "big"), station, command, data)
    return b"%c%c%b%b%b" % (header, ID, checked, crc_bytes(checked), TERMINATOR)


class MseriesDecoder(Measured):
    """Splits a stream into M-series frames."""

    def _sizes(self, at: int) -> tuple[int, ...] | None:
        begun = _BEGINNING.match(self._buffer, at)
        if begun is None:
            return ()
        if begun.end() - at < _SHORTEST_BEGINNING:
            return (FRAMING_BYTES + MIN_PAYLOAD,)  # at least; the length was not received yet
        return (FRAMING_BYTES + int.from_bytes(self._buffer[at + 2 : at + 4], "big"),)

    def _next_beginning(self) -> int:
        found = _BEGINNING.search(self._buffer, 1)
        return found.start() if found else len(self._buffer)

    def _noise(self) -> str:
        buffer = self._buffer
        if len(buffer) >= 4 and buffer[0] in {QUERY, RESPONSE} and buffer[1] == ID:
            size = int.from_bytes(buffer[2:4], "big")
            return f"length: expected {MIN_PAYLOAD} to {MAX_PAYLOAD}, got {size}"
        return super()._noise()

    def _frame(self, raw: bytes) -> Frame | None:
        return _frame_of(raw)

    def _fault(self, raw: bytes) -> FrameError:
        return _fault_of(raw)


def parse_frame(raw: bytes) -> Frame:
    """Parse one frame from header to terminator.

    Raises:
        FrameError: a wrong checksum (then ``checksum`` is True), or not a frame.
    """
    begins = _BEGINNING.match(raw)
    if begins is None or not FRAMING_BYTES + MIN_PAYLOAD <= len(raw) <= MAX_FRAME:
        raise FrameError(
            f"invalid frame: expected 51 10 or 52 10 and {FRAMING_BYTES + MIN_PAYLOAD} to {MAX_FRAME} bytes, "
            f"got {len(raw)}",
            raw=raw,
        )
    size = int.from_bytes(raw[2:4], "big")
    if len(raw) != FRAMING_BYTES + size:
        raise FrameError(f"length {size}: expected {FRAMING_BYTES + size} bytes, got {len(raw)}", raw=raw)
    frame = _frame_of(raw)
    if frame is None:
        raise _fault_of(raw)
    return frame


def _frame_of(raw: bytes) -> Frame | None:
    """The frame in bytes of the right length, or None."""
    if raw[-2:] != TERMINATOR or raw[-4:-2] != crc_bytes(raw[2:-4]):
        return None
    return Frame(raw[4], raw[5], raw[6:-4], raw)


def _fault_of(raw: bytes) -> FrameError:
    """The reason why they are not a frame."""
    if raw[-2:] != TERMINATOR:
        got = raw[-2:].hex(" ").upper()
        return FrameError(f"after the length: expected 55 AA, got {got}", raw=raw)
    expected = crc_bytes(raw[2:-4]).hex(" ").upper()
    got = raw[-4:-2].hex(" ").upper()
    return FrameError(f"checksum: expected {expected}, got {got}", raw=raw, checksum=True)


class MseriesCodec(FatekCodec):
    """M-series binary as a ``Codec``."""

    name = "mseries"
    commands = DATA.commands
    loopback_alphabet = bytes(range(256))
    data_bits = 8
    default_tcp_port = None
    last_error = 0xFF
    data = DATA
    framing_bytes = FRAMING_BYTES + MIN_PAYLOAD

    def __init__(self) -> None:
        super().__init__(partial(frame_bytes, QUERY), partial(frame_bytes, RESPONSE))

    def decoder(self) -> MseriesDecoder:
        """A new decoder for one stream."""
        return MseriesDecoder()

    def parse_answer(self, request: Request[A], frame: Frame) -> A:
        """The answer to this request in a frame."""
        if frame.raw[0] != RESPONSE:
            raise FrameError("expected an answer (52), got a request (51)", raw=frame.raw)
        return self.data.parse_answer(request, frame.data)

    def good_answer(self, request: Request[A], asked: bytes, raw: bytes) -> A:
        """The contents of a valid answer: its station and command are those of the request."""
        command = request.command
        head = b"\x52\x10%b%b\0" % ((len(raw) - FRAMING_BYTES).to_bytes(2, "big"), asked[4:6])
        if raw[:7] != head or raw[-4:] != crc_bytes(raw[2:-4]) + TERMINATOR or command == _LOOPBACK:
            raise FrameError("not the expected answer", raw=raw)
        data = self.data
        answer: A = data.rows[command].parse_answer(data.notation, request, raw[7:-4])
        return answer

    def checksum(self, data: bytes) -> bytes:
        """The CRC of length and payload."""
        return crc_bytes(data)

    def error_text(self, code: int) -> str:
        """The meaning of an error code."""
        return meaning_of(code)

    def echo_may_pass(self, request: Request[A]) -> bool:  # noqa: ARG002  # the interface's
        """False: a request begins with 51, an answer with 52."""
        return False


MSERIES: Final = MseriesCodec()
