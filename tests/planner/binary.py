"""A codec of other sizes than FACON's: those of a binary protocol. No frame of it means anything."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.protocol.commands import (
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    Request,
    WriteDiscretes,
    WriteMixed,
    WriteRegisters,
)
from fatektool.protocol.facon import FaconCodec

if TYPE_CHECKING:
    from fatektool.protocol.elements import Element

FRAMING = 8
STATION_AND_COMMAND = 2
ADDRESS = 2


def _element(element: Element) -> int:
    return len(element.symbol) + ADDRESS


def _value(element: Element) -> int:
    return {1: 1, 16: 2, 32: 4}[element.kind.bits]


class BinarySizes(FaconCodec):
    """Requests and answers as long as in a binary protocol with symbols of one to three letters."""

    def encode(self, station: int, request: Request[Any]) -> bytes:
        """As many bytes as the request has."""
        match request:
            case ReadDiscretes(first, _) | ReadRegisters(first, _):
                data = 1 + _element(first)
            case WriteDiscretes(first, values) | WriteRegisters(first, values):
                data = 1 + _element(first) + _value(first) * len(values)
            case ReadMixed(elements):
                data = 1 + sum(map(_element, elements))
            case WriteMixed(items):
                data = 1 + sum(_element(element) + _value(element) for element, _ in items)
            case _:
                raise TypeError(f"{type(request).__name__} is nothing that a planner asks for")
        return bytes([station]) * (FRAMING + STATION_AND_COMMAND + data)

    def answer_bytes(self, request: Request[Any]) -> int:
        """Length of the answer, error byte included."""
        match request:
            case ReadDiscretes(first, count) | ReadRegisters(first, count):
                data = count * _value(first)
            case ReadMixed(elements):
                data = sum(map(_value, elements))
            case _:
                data = 0
        return FRAMING + STATION_AND_COMMAND + 1 + data


BINARY = BinarySizes()
