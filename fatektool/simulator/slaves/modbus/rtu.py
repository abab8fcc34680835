"""Modbus RTU of the slave.

::

    station  function  data ...  CRC         2 bytes, low byte first

A request ends with a silence, which pipes and sockets do not transmit. So its length is found from its
function: 8 bytes for 01 to 06, and 9 plus the value of the seventh byte for 15 and 16. A request with an
unknown function ends where the CRC of all its bytes is 0, within 32 bytes. An incomplete request delays the
bytes after it only as long as its beginning may be a request; so noise has no effect, and an incomplete
request is dropped when the bytes after it show that its CRC is wrong.
"""

from __future__ import annotations

from fatektool.simulator.slaves.modbus.framing import MAX_STATION, CutRequest
from fatektool.simulator.slaves.modbus.slave import slave_type

MAX_RTU = 256
_FIXED = frozenset(range(1, 7))
_SEVERAL = {15: (1968, 8, 1), 16: (123, 1, 2)}
"""The most of them, how many are in a unit, bytes of a unit."""

_LONGEST_UNKNOWN = 32


def crc(data: bytes) -> int:
    """CRC-16 of Modbus; 0 over a frame with its CRC."""
    value = 0xFFFF
    for byte in data:
        value = value >> 8 ^ _CRC_OF_BYTE[(value ^ byte) & 0xFF]
    return value


class RtuFraming:
    """RTU."""

    delimiters = (b"\x01\x03", b"\x01\x83", b"\x00")
    own_units: frozenset[int] = frozenset()

    def __init__(self) -> None:
        self._begun = b""

    def feed(self, data: bytes) -> list[CutRequest]:
        """Requests that ``data`` completes."""
        carried = len(self._begun)
        stream = self._begun + data
        found: list[CutRequest] = []
        at = start = 0
        while at < len(stream):
            size = _rtu_size(stream[at : at + MAX_RTU])
            if size > 0:
                raw = stream[at : at + size]
                found.append(CutRequest(at + size - carried, raw, raw[:-2]))
                at = start = at + size
            elif size == 0:  # it may still be one
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
        """Drop an incomplete request."""
        self._begun = b""


def _rtu_size(begun: bytes) -> int:
    """The length of the request that begins here; 0 if not known yet; below 0 if it is not a request."""
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


def _shifted(value: int) -> int:
    for _ in range(8):
        value = value >> 1 ^ 0xA001 if value & 1 else value >> 1
    return value


_CRC_OF_BYTE = [_shifted(byte) for byte in range(256)]

RTU = slave_type(RtuFraming, 11)
