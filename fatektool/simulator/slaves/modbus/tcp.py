"""Modbus TCP of the slave.

::

    transaction  0 0  length  station  function  data ...
"""

from __future__ import annotations

from fatektool.simulator.slaves.modbus.framing import CutRequest
from fatektool.simulator.slaves.modbus.slave import slave_type

MAX_LENGTH = 254
_TCP_HEAD = 7


class TcpFraming:
    """TCP. Bytes that are not a header are skipped, up to a header."""

    delimiters = (b"\x00\x01\x00\x00\x00", b"\x00")
    own_units = frozenset({0, 255})

    def __init__(self) -> None:
        self._begun = b""

    def feed(self, data: bytes) -> list[CutRequest]:
        """Requests that ``data`` completes."""
        carried = len(self._begun)
        stream = self._begun + data
        found: list[CutRequest] = []
        at = 0
        while len(stream) - at >= _TCP_HEAD:
            length = int.from_bytes(stream[at + 4 : at + 6], "big")
            if stream[at + 2 : at + 4] != b"\0\0" or not 2 <= length <= MAX_LENGTH:
                at += 1
                continue
            end = at + 6 + length
            if end > len(stream):
                break
            found.append(CutRequest(end - carried, stream[at:end], stream[at + 6 : end]))
            at = end
        self._begun = stream[at:]
        return found

    def sealed(self, body: bytes, request: bytes) -> bytes:
        """The request's transaction, length, station, and the rest of the body."""
        return request[:2] + b"\0\0" + len(body).to_bytes(2, "big") + request[6:7] + body[1:]

    def readdressed(self, frame: bytes, station: int) -> bytes:
        """Another station."""
        return frame[:6] + bytes((station,)) + frame[7:]

    def reset(self) -> None:
        """Drop an incomplete request."""
        self._begun = b""


TCP = slave_type(TcpFraming, 11)
