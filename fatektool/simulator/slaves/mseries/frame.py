"""M-series frames of the slave: found in a stream of bytes, checked, and built.

::

    51 10   length   station  command  data ...   CRC      55 AA
            2 bytes  └────── length bytes ─────┘  2 bytes
    52 10   in an answer

The length has its high byte first. The CRC is CRC-16/MODBUS over length and payload; in the paper its bytes
are swapped and the high one is sent first, so the low byte is first on the wire (M-series paper, section 1).
A payload may contain 55 AA, and also 51 10: only the length gives the end of a frame.

So noise that looks like a header could delay the requests after it until as many bytes are received as its
length requires. It does not if its station, command or length are not those of a command in the paper: then
the bytes after it are examined meanwhile. An incomplete request does cause a delay, because the request after
it could be its data; in the end its CRC shows the error, and no request after it is lost.
"""

from __future__ import annotations

REQUEST = b"\x51\x10"
ANSWER = b"\x52\x10"
TERMINATOR = b"\x55\xaa"

OVERHEAD = 8
MIN_PAYLOAD = 2
MAX_PAYLOAD = 512
"""About twice the longest request of the paper (45 with 256 states, 262 bytes): more is a wrong length."""

MAX_FRAME = OVERHEAD + MAX_PAYLOAD

_HEAD = 4
_LAST_STATION = b"\xfe"

_PAYLOADS = {
    0x40: range(2, 3),
    0x41: range(3, 4),
    0x42: range(6, 7),
    0x43: range(6, 7),
    0x44: range(6, 7),
    0x45: range(7, 263),
    0x46: range(6, 9),
    0x47: range(8, 137),
    0x48: range(6, 260),
    0x49: range(7, 196),
    0x4E: range(2, 259),
    0x53: range(2, 3),
}
"""The possible lengths of each command's payload, by its limits (M-series paper, section 2.2)."""


class MSeriesCutter:
    """Splits bytes, in any pieces, into requests, with a buffer of less than one longest frame."""

    def __init__(self) -> None:
        self._begun = b""

    def feed(self, data: bytes) -> list[tuple[int, bytes]]:
        """Frames that ``data`` completes, with correct CRCs, each with its end as an offset in ``data``."""
        frames: list[tuple[int, bytes]] = []
        carried = len(self._begun)
        stream = self._begun + data
        unfinished = None  # the place of the first frame that more bytes may complete
        known = 0  # a frame after a false one is known when the false one is
        at = stream.find(REQUEST)
        while at >= 0:
            following = at + 1
            length = int.from_bytes(stream[at + 2 : at + _HEAD], "big")
            end = at + OVERHEAD + length
            if len(stream) < at + _HEAD:
                unfinished = at if unfinished is None else unfinished
            elif MIN_PAYLOAD <= length <= MAX_PAYLOAD:
                likely = _likely(stream[at + _HEAD : at + _HEAD + 2], length)
                if end > len(stream):
                    unfinished = at if unfinished is None else unfinished
                    if likely:
                        break
                elif _holds(stream[at:end]):
                    frames.append((max(known, end) - carried, stream[at:end]))
                    unfinished = None
                    following = end
                elif likely:
                    known = max(known, end)
            at = stream.find(REQUEST, following)
        if unfinished is None and stream.endswith(REQUEST[:1]):
            unfinished = len(stream) - 1
        self._begun = b"" if unfinished is None else stream[unfinished:]
        return frames

    def reset(self) -> None:
        """Drop an incomplete frame."""
        self._begun = b""


def crc16(data: bytes) -> int:
    """CRC-16/MODBUS of ``data``, before its bytes are swapped."""
    crc = 0xFFFF
    for byte in data:
        crc = crc >> 8 ^ _CRC_OF_BYTE[(crc ^ byte) & 0xFF]
    return crc


def sealed(header: bytes, payload: bytes) -> bytes:
    """The frame of ``payload`` with ``header``, ``REQUEST`` or ``ANSWER``."""
    covered = len(payload).to_bytes(2, "big") + payload
    return header + covered + crc16(covered).to_bytes(2, "little") + TERMINATOR


def payload_of(frame: bytes) -> bytes:
    """The bytes between length and CRC."""
    return frame[_HEAD:-4]


def readdressed(frame: bytes, station: int) -> bytes:
    """``frame`` with another station and the CRC for it."""
    return sealed(frame[:2], bytes((station,)) + payload_of(frame)[1:])


def _holds(frame: bytes) -> bool:
    return frame.endswith(TERMINATOR) and crc16(frame[2:-4]) == int.from_bytes(frame[-4:-2], "little")


def _likely(begun: bytes, length: int) -> bool:
    """Whether a request of this length may begin with these bytes of station and command."""
    if begun[:1] > _LAST_STATION:
        return False
    return len(begun) < 2 or length in _PAYLOADS.get(begun[1], ())


def _shifted(value: int) -> int:
    for _ in range(8):
        value = value >> 1 ^ 0xA001 if value & 1 else value >> 1
    return value


_CRC_OF_BYTE = [_shifted(byte) for byte in range(256)]
