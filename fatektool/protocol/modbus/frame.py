r"""Modbus frames on serial lines and TCP: encoders and decoders.

::

    RTU    station(1) · PDU · CRC(2)
    ASCII  : · station and PDU in hex digits · LRC(2 hex digits) · CR LF
    TCP    number(2) · 00 00 · length(2) · station(1) · PDU

An RTU frame has no beginning and no end of its own but silence, which no adapter hands on. So its length is
read from its function and byte count, for the request and for the answer of this function, and the CRC says
which it is. TCP has a length, and no checksum: that is the network's. In both, something is a frame if all
that can be known of its beginning holds; if not, as little as possible is dropped, up to what could be the
beginning of the next. So a good frame behind a bad one is found. One that began and has not ended when its
time is over is let go of in the same way (``expect_no_more``).

ASCII: as in FACON, ``:`` never stands inside a frame, so a second one begins a new frame.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from binascii import unhexlify
from typing import Final

from fatektool.errors import FrameError
from fatektool.protocol.codec import Frame
from fatektool.protocol.modbus import pdu as modbus_pdu
from fatektool.protocol.modbus.pdu import EXCEPTION, FUNCTION_WORDS, READS

LAST_STATION: Final = 247
MAX_PDU: Final = 253
MAX_RTU: Final = 3 + MAX_PDU
MAX_ASCII: Final = 7 + 2 * MAX_PDU
MIN_ASCII: Final = 11
TCP_HEADER: Final = 7
_MAX_BUFFER: Final = 1 << 16
_HEX_DIGITS: Final = b"0123456789ABCDEF"
_LAST_EXCEPTION: Final = 0x0B
_MOST_READ: Final = 250
_MOST_WRITTEN: Final = 246
_TELLING: Final = 6
"""Of a PDU, so many bytes tell its length."""


def rtu_bytes(station: int, pdu: bytes, number: int = 0) -> bytes:
    """One RTU frame."""
    del number
    body = bytes([station]) + pdu
    return body + modbus_pdu.crc_bytes(body)


def ascii_bytes(station: int, pdu: bytes, number: int = 0) -> bytes:
    """One ASCII frame."""
    del number
    body = bytes([station]) + pdu
    return b":" + (body + bytes([modbus_pdu.lrc_byte(body)])).hex().upper().encode() + b"\r\n"


def tcp_bytes(station: int, pdu: bytes, number: int = 0) -> bytes:
    """One TCP frame."""
    return b"%b\0\0%b%c%b" % (number.to_bytes(2, "big"), (1 + len(pdu)).to_bytes(2, "big"), station, pdu)


class _Buffer(ABC):
    """Bytes from the wire, not yet given as frames."""

    def __init__(self) -> None:
        self._buffer = bytearray()
        self._all_came = False

    def feed(self, data: bytes) -> None:
        """Take bytes from the wire; of more than 64 KiB not asked for, the oldest are forgotten."""
        self._all_came = False
        self._buffer += data
        if len(self._buffer) > _MAX_BUFFER:
            del self._buffer[:-_MAX_BUFFER]

    def clear(self) -> int:
        """Forget what was fed and not yet given; return how many bytes that was."""
        left = len(self._buffer)
        self._buffer.clear()
        return left

    @abstractmethod
    def next_frame(self) -> Frame | None:
        """Give the next whole frame, or None if more bytes are needed."""

    def _take(self, count: int) -> bytes:
        taken = bytes(self._buffer[:count])
        del self._buffer[:count]
        return taken


class _ByLength(_Buffer):
    """A decoder of frames that tell their length at their beginning."""

    def expect_no_more(self) -> bool:
        """Let go of a frame that began and does not end, and look at what stands behind its beginning."""
        self._all_came = bool(self._buffer)
        return self._all_came

    def next_frame(self) -> Frame | None:
        """Give the next whole frame, or None if more bytes are needed.

        Raises:
            FrameError: bytes that are no frame; they are dropped.
        """
        buffer = self._buffer
        if not buffer:
            return None
        sizes = self._sizes(buffer, 0)
        if sizes is not None:
            for size in sizes:
                if size <= len(buffer):
                    frame = self._whole(bytes(buffer[:size]))
                    if frame is not None:
                        del buffer[:size]
                        return frame
        if not self._all_came and (sizes is None or any(size > len(buffer) for size in sizes)):
            return None
        raise self._error(sizes)

    def _error(self, sizes: tuple[int, ...] | None) -> FrameError:
        """Drop what is no frame up to what could be the beginning of one."""
        drop = 1
        while drop < len(self._buffer) and self._sizes(self._buffer, drop) == ():
            drop += 1
        if not sizes:
            return FrameError("noise outside a frame", raw=self._take(drop))
        whole = [size for size in sizes if size <= len(self._buffer)]
        if not whole:
            return FrameError("a frame broke off", raw=self._take(drop))
        damaged = drop >= whole[-1]  # nothing within it could begin another: it was one frame
        return FrameError("checksum: the CRC does not hold", raw=self._take(drop), checksum=damaged)

    @abstractmethod
    def _sizes(self, buffer: bytearray, at: int) -> tuple[int, ...] | None:
        """How long a frame that begins here may be, the shortest first; None if too little of it is there."""

    @abstractmethod
    def _whole(self, raw: bytes) -> Frame | None:
        """The frame that these bytes are, or None."""


class RtuDecoder(_ByLength):
    """Cuts RTU frames, requests and answers, out of a stream."""

    def _sizes(self, buffer: bytearray, at: int) -> tuple[int, ...] | None:
        if buffer[at] > LAST_STATION:
            return ()
        sizes = _pdu_sizes(buffer, at + 1, at + 1 + _TELLING)
        return None if sizes is None else tuple(size + 3 for size in sizes)

    def _whole(self, raw: bytes) -> Frame | None:
        if modbus_pdu.crc_bytes(raw[:-2]) != raw[-2:]:
            return None
        return Frame(raw[0], raw[1] & ~EXCEPTION, raw[1:-2], raw)


class TcpDecoder(_ByLength):
    """Cuts TCP frames, requests and answers, out of a stream."""

    def _sizes(self, buffer: bytearray, at: int) -> tuple[int, ...] | None:
        head = buffer[at : at + TCP_HEADER]
        if any(head[2:4]):
            return ()
        if len(head) < TCP_HEADER:
            return () if head[4:5] > b"\0" else None
        size = int.from_bytes(head[4:6], "big") - 1
        if not 2 <= size <= MAX_PDU:
            return ()
        possible = _pdu_sizes(buffer, at + TCP_HEADER, at + TCP_HEADER + min(size, _TELLING))
        return (TCP_HEADER + size,) if possible is None or size in possible else ()

    def _whole(self, raw: bytes) -> Frame:
        number = int.from_bytes(raw[:2], "big")
        return Frame(raw[6], raw[7] & ~EXCEPTION, raw[7:], raw, number)


def _pdu_sizes(  # noqa: PLR0911  # a way out a form
    buffer: bytearray, at: int, end: int
) -> tuple[int, ...] | None:
    """How long the PDU that begins here may be; None if it cannot be said yet.

    Args:
        buffer: the bytes.
        at: where its function stands.
        end: behind what needs to be there to say more.
    """
    head = buffer[at:end]
    if not head:
        return None
    function = head[0]
    if function & EXCEPTION:
        known = function & ~EXCEPTION in FUNCTION_WORDS
        if len(head) > 1:
            known = known and 1 <= head[1] <= _LAST_EXCEPTION
        return (2,) if known else ()
    if function not in FUNCTION_WORDS:
        return ()
    if function in {modbus_pdu.WRITE_COIL, modbus_pdu.WRITE_REGISTER}:
        return (5,)
    if len(head) < 2:
        return None
    if function in READS:
        even = function in {modbus_pdu.READ_COILS, modbus_pdu.READ_DISCRETE_INPUTS} or head[1] % 2 == 0
        answer = (2 + head[1],) if 1 <= head[1] <= _MOST_READ and even else ()
        return tuple(sorted({5, *answer}))
    if len(head) < 6:
        return None
    return (5, 6 + head[5]) if 1 <= head[5] <= _MOST_WRITTEN else (5,)


class AsciiDecoder(_Buffer):
    """Cuts ASCII frames out of a stream."""

    def expect_no_more(self) -> bool:
        """False: behind a frame that has not ended nothing can stand, as ``:`` would have begun another."""
        return False

    def next_frame(self) -> Frame | None:
        """Give the next frame, or None when more bytes are needed.

        Raises:
            FrameError: bad bytes, dropped.
        """
        buffer = self._buffer
        if not buffer:
            return None
        start = buffer.find(b":")
        if start:
            raise FrameError("noise outside a frame", raw=self._take(start if start > 0 else len(buffer)))
        end = buffer.find(b"\r\n", 1)
        again = buffer.find(b":", 1, end if end > 0 else len(buffer))
        if again > 0:
            raise FrameError("a frame broke off and another began", raw=self._take(again))
        if end < 0:
            if len(buffer) > MAX_ASCII:
                raise FrameError(f"no end within {MAX_ASCII} bytes", raw=self._take(len(buffer)))
            return None
        return parse_ascii(self._take(end + 2))


def parse_ascii(raw: bytes) -> Frame:
    """Read one ASCII frame from ``:`` to CR LF.

    Raises:
        FrameError: a wrong checksum (then ``checksum`` is True), or no frame.
    """
    digits = raw[1:-2]
    if not MIN_ASCII <= len(raw) <= MAX_ASCII or len(digits) % 2 or digits.translate(None, _HEX_DIGITS):
        raise FrameError(
            f"no frame: expected {MIN_ASCII} to {MAX_ASCII} bytes of capital hex digits in pairs, "
            f"got {len(raw)} bytes",
            raw=raw,
        )
    content = unhexlify(digits)
    expected = modbus_pdu.lrc_byte(content[:-1])
    if content[-1] != expected:
        raise FrameError(f"checksum: expected {expected:02X}, got {content[-1]:02X}", raw=raw, checksum=True)
    return Frame(content[0], content[1] & ~EXCEPTION, content[1:-1], raw)
