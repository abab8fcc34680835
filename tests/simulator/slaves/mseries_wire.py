"""M-series frames for the tests, independent of the simulator's own code."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.simulator.wire import answers

if TYPE_CHECKING:
    from fatektool.simulator.slaves.base import Slave


def crc(data: bytes) -> bytes:
    """As the paper says it: bit by bit, the two bytes swapped, the high one first."""
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = (value >> 1) ^ 0xA001 if value & 1 else value >> 1
    return bytes((value & 0xFF, value >> 8))


def framed(payload: bytes, *, header: int = 0x51) -> bytes:
    """Header, ID, length, payload, CRC, terminator."""
    covered = len(payload).to_bytes(2, "big") + payload
    return bytes((header, 0x10)) + covered + crc(covered) + b"\x55\xaa"


def request(text: str, *, station: int = 1) -> bytes:
    """A request of what is given in hex: command and data. ``'…'`` in it stands for ASCII."""
    return framed(bytes((station,)) + spelled(text))


def reply(text: str, *, station: int = 1) -> bytes:
    """An answer: command, error and data in hex."""
    return framed(bytes((station,)) + spelled(text), header=0x52)


def spelled(text: str) -> bytes:
    parts = text.split("'")
    return b"".join(part.encode("ascii") if at % 2 else bytes.fromhex(part) for at, part in enumerate(parts))


def ask(slave: Slave, text: str) -> str:
    """The answer in hex from the error on; its envelope is checked here."""
    (answer,) = answers(slave, request(text))
    payload = answer[4:-4]
    assert answer == framed(payload, header=0x52)
    assert payload[:2] == b"\x01" + spelled(text)[:1]
    return payload[2:].hex()
