"""Modbus frames, from the slave's end: found in a stream of bytes, checked, and built.

::

    RTU    station  function  data ...  CRC                 2 bytes, low byte first
    ASCII  ':'  station  function  data ...  LRC  CR LF     two hex digits a byte
    TCP    transaction  0 0  length  station  function  data ...

What stands around an answer is its request's: over TCP its transaction too.

An RTU request ends with a silence, which pipes and sockets do not carry. So its length is taken from its
function: 8 bytes for 01 to 06, 9 and as many as the seventh byte says for 15 and 16. A function that is not
known ends where the CRC over all of it comes out as 0, within 32 bytes. A request that has begun holds back
what comes behind it only as long as all of its beginning could be one; so noise costs nothing, and a request
that was cut off is given up when what came behind it shows that its CRC is wrong.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

MAX_STATION = 247
MAX_RTU = 256
MAX_ASCII = 513
MAX_LENGTH = 254
_FIXED = frozenset(range(1, 7))
_SEVERAL = {15: (1968, 8, 1), 16: (123, 1, 2)}
"""Most of them, how many go into a unit, bytes of a unit."""

_LONGEST_UNKNOWN = 32
_HEX = b"0123456789ABCDEF"
_TCP_HEAD = 7


class Cut(NamedTuple):
    """A request: its end as an offset in the bytes just fed, its bytes, and station, function and data."""

    end: int
    raw: bytes
    body: bytes


class Framing(Protocol):
    """One way to put a body, which is station, function and data, on a wire."""

    @property
    def delimiters(self) -> tuple[bytes, ...]:
        """What begins and ends a frame."""

    @property
    def own_units(self) -> frozenset[int]:
        """The stations that mean the PLC at the address itself."""

    def feed(self, data: bytes) -> list[Cut]:
        """Requests that ``data`` completes, their checksums right."""

    def sealed(self, body: bytes, request: bytes) -> bytes:
        """The frame of an answer to a request."""

    def readdressed(self, frame: bytes, station: int) -> bytes:
        """A frame with another station, its checksum right."""

    def reset(self) -> None:
        """Forget a request that has only begun."""


def crc(data: bytes) -> int:
    """CRC-16 of Modbus; 0 over a frame with its CRC."""
    value = 0xFFFF
    for byte in data:
        value = value >> 8 ^ _CRC_OF_BYTE[(value ^ byte) & 0xFF]
    return value


def lrc(data: bytes) -> int:
    """The two's complement of the sum of all bytes."""
    return -sum(data) & 0xFF


class RtuFraming:
    """RTU."""

    delimiters = (b"\x01\x03", b"\x01\x83", b"\x00")
    own_units: frozenset[int] = frozenset()

    def __init__(self) -> None:
        self._begun = b""

    def feed(self, data: bytes) -> list[Cut]:
        """Requests that ``data`` completes."""
        carried = len(self._begun)
        stream = self._begun + data
        found: list[Cut] = []
        at = start = 0
        while at < len(stream):
            size = _rtu_size(stream[at : at + MAX_RTU])
            if size > 0:
                raw = stream[at : at + size]
                found.append(Cut(at + size - carried, raw, raw[:-2]))
                at = start = at + size
            elif size == 0:  # it could be one yet
                break
            else:
                at += 1
        self._begun = stream[max(start, len(stream) - MAX_RTU) :]
        return found

    def sealed(self, body: bytes, request: bytes) -> bytes:
        """Body and CRC."""
        del request
        return body + crc(body).to_bytes(2, "little")

    def readdressed(self, frame: bytes, station: int) -> bytes:
        """Another station, and the CRC for it."""
        return self.sealed(bytes((station,)) + frame[1:-2], b"")

    def reset(self) -> None:
        """Forget what has begun."""
        self._begun = b""


def _rtu_size(begun: bytes) -> int:
    """How long the request is that begins here; 0 if more bytes must tell; below 0 if it is none."""
    if begun[0] > MAX_STATION:
        return -1
    if len(begun) < 2:
        return 0
    function = begun[1]
    if function in _FIXED:
        size = 8
    elif function in _SEVERAL:
        if len(begun) < 7:
            return 0
        most, units, width = _SEVERAL[function]
        count = int.from_bytes(begun[4:6], "big")
        if not (1 <= count <= most and begun[6] == -(-count // units) * width):
            # A count that contradicts its bytes is answered with an exception if the CRC is right.
            return _whole(begun, 9 + begun[6], wait=False)
        size = 9 + begun[6]
    else:
        most_known = min(len(begun), _LONGEST_UNKNOWN)
        return next((end for end in range(4, most_known + 1) if crc(begun[:end]) == 0), -1)
    return _whole(begun, size, wait=True)


def _whole(begun: bytes, size: int, *, wait: bool) -> int:
    if len(begun) < size:
        return 0 if wait else -1
    return size if crc(begun[:size]) == 0 else -1


class AsciiFraming:
    """ASCII."""

    delimiters = (b":", b"\r\n")
    own_units: frozenset[int] = frozenset()

    def __init__(self) -> None:
        self._begun = b""

    def feed(self, data: bytes) -> list[Cut]:
        """Requests that ``data`` completes."""
        carried = len(self._begun)
        stream = self._begun + data
        found: list[Cut] = []
        position = 0
        while (end := stream.find(b"\r\n", position) + 2) > 1:
            start = stream.rfind(b":", position, end)
            digits = stream[start + 1 : end - 2]
            if start >= 0 and 6 <= len(digits) <= MAX_ASCII and _all_hex(digits):
                content = bytes.fromhex(digits.decode("ascii"))
                if lrc(content[:-1]) == content[-1] and content[0] <= MAX_STATION:
                    found.append(Cut(end - carried, stream[start:end], content[:-1]))
            position = end
        start = stream.rfind(b":", position)
        self._begun = stream[start:] if start >= 0 and len(stream) - start < MAX_ASCII else b""
        return found

    def sealed(self, body: bytes, request: bytes) -> bytes:
        """Colon, digits, LRC, end."""
        del request
        return b":" + (body + bytes((lrc(body),))).hex().upper().encode("ascii") + b"\r\n"

    def readdressed(self, frame: bytes, station: int) -> bytes:
        """Another station, and the LRC for it."""
        content = bytes.fromhex(frame[1:-4].decode("ascii"))
        return self.sealed(bytes((station,)) + content[1:], b"")

    def reset(self) -> None:
        """Forget what has begun."""
        self._begun = b""


def _all_hex(digits: bytes) -> bool:
    return len(digits) % 2 == 0 and not digits.translate(None, _HEX)


class TcpFraming:
    """TCP. What is no header is skipped byte by byte, up to one."""

    delimiters = (b"\x00\x01\x00\x00\x00", b"\x00")
    own_units = frozenset({0, 255})

    def __init__(self) -> None:
        self._begun = b""

    def feed(self, data: bytes) -> list[Cut]:
        """Requests that ``data`` completes."""
        carried = len(self._begun)
        stream = self._begun + data
        found: list[Cut] = []
        at = 0
        while len(stream) - at >= _TCP_HEAD:
            length = int.from_bytes(stream[at + 4 : at + 6], "big")
            if stream[at + 2 : at + 4] != b"\0\0" or not 2 <= length <= MAX_LENGTH:
                at += 1
                continue
            end = at + 6 + length
            if end > len(stream):
                break
            found.append(Cut(end - carried, stream[at:end], stream[at + 6 : end]))
            at = end
        self._begun = stream[at:]
        return found

    def sealed(self, body: bytes, request: bytes) -> bytes:
        """The request's transaction, length, the station as it was asked, and what else is in the body."""
        return request[:2] + b"\0\0" + len(body).to_bytes(2, "big") + request[6:7] + body[1:]

    def readdressed(self, frame: bytes, station: int) -> bytes:
        """Another station."""
        return frame[:6] + bytes((station,)) + frame[7:]

    def reset(self) -> None:
        """Forget what has begun."""
        self._begun = b""


def _shifted(value: int) -> int:
    for _ in range(8):
        value = value >> 1 ^ 0xA001 if value & 1 else value >> 1
    return value


_CRC_OF_BYTE = [_shifted(byte) for byte in range(256)]
