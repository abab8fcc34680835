"""Modbus ASCII of the slave.

::

    ':'  station  function  data ...  LRC  CR LF        two hex digits each byte
"""

from __future__ import annotations

from fatektool.simulator.slaves.modbus.framing import MAX_STATION, CutRequest
from fatektool.simulator.slaves.modbus.slave import slave_type

MAX_ASCII = 513
_HEX = b"0123456789ABCDEF"


def lrc(data: bytes) -> int:
    """The two's complement of the sum of all bytes."""
    return -sum(data) & 0xFF


class AsciiFraming:
    """ASCII."""

    delimiters = (b":", b"\r\n")
    own_units: frozenset[int] = frozenset()

    def __init__(self) -> None:
        self._begun = b""

    def feed(self, data: bytes) -> list[CutRequest]:
        """Requests that ``data`` completes."""
        carried = len(self._begun)
        stream = self._begun + data
        found: list[CutRequest] = []
        position = 0
        while (end := stream.find(b"\r\n", position) + 2) > 1:
            start = stream.rfind(b":", position, end)
            digits = stream[start + 1 : end - 2]
            if start >= 0 and 6 <= len(digits) <= MAX_ASCII and _all_hex(digits):
                content = bytes.fromhex(digits.decode("ascii"))
                if lrc(content[:-1]) == content[-1] and content[0] <= MAX_STATION:
                    found.append(CutRequest(end - carried, stream[start:end], content[:-1]))
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
        """Drop an incomplete request."""
        self._begun = b""


def _all_hex(digits: bytes) -> bool:
    return len(digits) % 2 == 0 and not digits.translate(None, _HEX)


ASCII = slave_type(AsciiFraming, 10)
