"""The checksum of M-series frames: CRC-16/MODBUS over length and payload (M-series paper, section 1).

::

    start FFFF · polynomial 8005, least significant bit first (A001) · no final inversion
    over "123456789": 4B37

In the paper its bytes are swapped and then sent high byte first, which on the wire is the order of Modbus:
the low byte first. One table look-up for each byte; ``bench/crc.py`` compares it with libraries.
"""

from __future__ import annotations

from typing import Final


def _table() -> tuple[int, ...]:
    entries = []
    for entry in range(256):
        value = entry
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
        entries.append(value)
    return tuple(entries)


_TABLE: Final = _table()


def crc16(data: bytes) -> int:
    """The checksum of some bytes, 0 to FFFF."""
    table = _TABLE
    crc = 0xFFFF
    for byte in data:
        crc = crc >> 8 ^ table[(crc ^ byte) & 0xFF]
    return crc


def crc_bytes(data: bytes) -> bytes:
    """The checksum as sent, the low byte first."""
    return crc16(data).to_bytes(2, "little")
