"""FACON frames of the slave: found in a stream of bytes, checked, and built.

::

    STX  station  command  data ...     LRC     ETX
    02   2 hex    2        0..500 char  2 hex   03

LRC is the sum of all bytes from STX to the last of the data, modulo 256 (FACON paper, section 2).
Hex digits are written in upper case. Station and LRC are read in lower case too, as some clients send them.
"""

from __future__ import annotations

STX = 0x02
ETX = 0x03
MIN_FRAME = 8
MAX_FRAME = MIN_FRAME + 500

HEX2 = [f"{value:02X}".encode("ascii") for value in range(256)]
BYTE_OF = {text: value for value, text in enumerate(HEX2)}
"""Two upper-case hex digits to their value: stricter than int(), which accepts ``+1`` and ``1_``."""
_BYTE_OF_EITHER = {text.lower(): value for text, value in BYTE_OF.items()} | BYTE_OF

_STX = b"\x02"
_ETX = b"\x03"


class FaconCutter:
    """Finds STX..ETX in bytes, in any pieces, with a buffer of at most one frame.

    STX always begins a new frame, so noise before it has no effect. Bytes longer than a frame are dropped up
    to the next STX.
    """

    def __init__(self) -> None:
        self._begun = b""

    def feed(self, data: bytes) -> list[tuple[int, bytes]]:
        """Frames that ``data`` completes, each with its end as an offset in ``data``."""
        frames: list[tuple[int, bytes]] = []
        carried = len(self._begun)
        stream = self._begun + data if carried else data
        position = 0
        while (end := stream.find(_ETX, position) + 1) > 0:
            start = stream.rfind(_STX, position, end)
            if start >= 0 and MIN_FRAME <= end - start <= MAX_FRAME:
                frames.append((end - carried, stream[start:end]))
            position = end
        start = stream.rfind(_STX, position)
        self._begun = stream[start:] if start >= 0 and len(stream) - start < MAX_FRAME else b""
        return frames

    def reset(self) -> None:
        """Drop an incomplete frame."""
        self._begun = b""


def station_of(frame: bytes) -> int | None:
    """The station of a frame; None if its station or LRC is wrong."""
    if _BYTE_OF_EITHER.get(frame[-3:-1]) != sum(frame[:-3]) & 0xFF:
        return None
    return _BYTE_OF_EITHER.get(frame[1:3])


def sealed(body: bytes) -> bytes:
    """The frame of ``body``, which goes from STX to the last of the data."""
    return body + HEX2[sum(body) & 0xFF] + _ETX


def readdressed(frame: bytes, station: int) -> bytes:
    """``frame`` with another station and the LRC for it."""
    return sealed(_STX + HEX2[station] + frame[3:-3])
