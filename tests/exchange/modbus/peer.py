"""The other side of a Modbus line, by hand: what it answers to which request, and when."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

from fatektool.exchange.link import Link
from fatektool.protocol.modbus.rtu import RTU
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.codec import Codec

Pieces = list[tuple[float, bytes]]
LINE = LineSettings(9600, "8E1")


def sealed(text: str) -> bytes:
    """An RTU frame of this file's own: the CRC bit by bit."""
    body = bytes.fromhex(text)
    value = 0xFFFF
    for byte in body:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ 0xA001 if value & 1 else value >> 1
    return body + bytes([value & 0xFF, value >> 8])


class Peer:
    """Answers as a function of the request says; remembers what it heard, and when."""

    def __init__(self, answer: Callable[[bytes, int], Pieces]) -> None:
        self._answer = answer
        self.heard: list[bytes] = []
        self.times: list[float] = []

    def receive(self, data: bytes, now: float) -> Pieces:
        self.heard.append(data)
        self.times.append(now)
        return [(now + after, piece) for after, piece in self._answer(data, len(self.heard))]


def linked(
    peer: Peer,
    codec: Codec = RTU,
    *,
    station: int = 1,
    retries: int = 3,
    timeout_s: float = 0.5,
    serial: bool = False,
) -> Link:
    """A link to the peer; its fences begin with the shortest."""
    numbers = itertools.count()
    transport = MemoryTransport(peer)
    if serial:
        transport.serial_settings = str(LINE)
    return Link(
        transport,
        codec,
        station,
        LINE,
        timeout_s=timeout_s,
        retries=retries,
        nonces=lambda: bytes([0, next(numbers) % 4]),
    )


def registers(count: int, value: int) -> bytes:
    """The answer to a read of so many holding registers, all of one value."""
    return sealed(f"01 03 {2 * count:02X}" + f"{value:04X}" * count)
