"""What ``simulator.py`` asks a simulator in each protocol, made by hand, and how long the answers are."""

from __future__ import annotations

from typing import NamedTuple


class Question(NamedTuple):
    """What a client asks, and how long the answer is."""

    name: str
    protocol: str
    requests: list[bytes]
    answer_bytes: int


def facon(body: str, station: int = 1) -> bytes:
    """A FACON request."""
    data = b"\x02%02X%b" % (station, body.encode())
    return data + b"%02X\x03" % (sum(data) & 0xFF)


def crc16(data: bytes) -> int:
    """CRC-16/MODBUS, bit by bit."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
    return crc


def mseries(payload: bytes) -> bytes:
    """An M-series request."""
    covered = len(payload).to_bytes(2, "big") + payload
    return b"\x51\x10" + covered + crc16(covered).to_bytes(2, "little") + b"\x55\xaa"


def modbus_rtu(body: bytes) -> bytes:
    """A Modbus RTU request."""
    return body + crc16(body).to_bytes(2, "little")


PAGES = Question("FACON 4F, a page", "facon", [facon(f"4F{page:04X}") for page in range(129)], 265)
QUESTIONS = [
    PAGES,
    Question("FACON 40, brief status", "facon", [facon("40")], 15),
    Question("FACON 46, 64 registers", "facon", [facon("4640R00000")], 265),
    Question(
        "FACON 48, 32 of many kinds",
        "facon",
        [facon("4820" + "".join(f"R{n:05}" for n in range(0, 640, 20)))],
        137,
    ),
    Question("M-series 40", "mseries", [mseries(b"\x01\x40")], 14),
    Question("M-series 46, 64 registers", "mseries", [mseries(b"\x01\x46\x40R\x00\x00")], 139),
    Question("Modbus TCP 03, 64 words", "modbus-tcp", [bytes.fromhex("000100000006010300000040")], 137),
    Question("Modbus RTU 03, 64 words", "modbus-rtu", [modbus_rtu(bytes.fromhex("010300000040"))], 133),
    Question("Modbus ASCII 03, 64", "modbus-ascii", [b":010300000040BC\r\n"], 267),
]
EVERY_STATION = Question(
    "FACON 46, one of 254", "facon", [facon("4640R00000", station) for station in range(1, 255)], 265
)
