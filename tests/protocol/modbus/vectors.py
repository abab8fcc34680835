"""Exchanges as bytes, from outside: the worked examples that Modbus texts have handed down since the 1970s.

Station 17 in RTU; what they ask for is named as this map has it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fatektool.protocol.commands import (
    ReadDiscretes,
    ReadRegisters,
    Request,
    WriteDiscretes,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus.map import STANDARD, ModbusMap, parse_map


@dataclass(frozen=True)
class Exchange:
    """A request and its answer, as RTU frames in hex, and what they mean.

    Attributes:
        function: its code.
        request: what is asked.
        answer: what is answered.
        asks: the frame.
        answers: the frame.
        map: in which it means that.
    """

    function: int
    request: Request[Any]
    answer: Any
    asks: str
    answers: str
    map: ModbusMap = STANDARD


INPUTS = parse_map("M0-M1999=100001,R0-R1999=300001")
STATION = 17
NUMBER = 0x1501


def bits(text: str) -> tuple[bool, ...]:
    return tuple(char == "1" for char in text.replace(" ", ""))


EXCHANGES = [
    Exchange(
        0x01,
        ReadDiscretes(Element("Y", 19), 37),
        bits("10110011 11010110 01001101 01110000 11011"),
        "11 01 00 13 00 25 0E 84",
        "11 01 05 CD 6B B2 0E 1B 45 E6",
    ),
    Exchange(
        0x02,
        ReadDiscretes(Element("M", 196), 22),
        bits("00110101 11011011 101011"),
        "11 02 00 C4 00 16 BA A9",
        "11 02 03 AC DB 35 20 18",
        ModbusMap("custom", INPUTS.stretches[-2:]),
    ),
    Exchange(
        0x03,
        ReadRegisters(Element("R", 107), 3),
        (0xAE41, 0x5652, 0x4340),
        "11 03 00 6B 00 03 76 87",
        "11 03 06 AE 41 56 52 43 40 49 AD",
    ),
    Exchange(
        0x04,
        ReadRegisters(Element("R", 8), 1),
        (0x000A,),
        "11 04 00 08 00 01 B2 98",
        "11 04 02 00 0A F8 F4",
        ModbusMap("custom", INPUTS.stretches[-1:]),
    ),
    Exchange(
        0x05,
        WriteDiscretes(Element("Y", 172), (True,)),
        None,
        "11 05 00 AC FF 00 4E 8B",
        "11 05 00 AC FF 00 4E 8B",
    ),
    Exchange(
        0x06,
        WriteRegisters(Element("R", 1), (3,)),
        None,
        "11 06 00 01 00 03 9A 9B",
        "11 06 00 01 00 03 9A 9B",
    ),
    Exchange(
        0x0F,
        WriteDiscretes(Element("Y", 19), bits("1011001110")),
        None,
        "11 0F 00 13 00 0A 02 CD 01 BF 0B",
        "11 0F 00 13 00 0A 26 99",
    ),
    Exchange(
        0x10,
        WriteRegisters(Element("R", 1), (10, 258)),
        None,
        "11 10 00 01 00 02 04 00 0A 01 02 C6 F0",
        "11 10 00 01 00 02 12 98",
    ),
]
EXCEPTION = "0A 81 02 B0 53"


def rtu(text: str) -> bytes:
    """A frame as it stands above."""
    return bytes.fromhex(text)


def ascii_frame(text: str) -> bytes:
    """The same in ASCII: the LRC is what makes the sum of all bytes 0."""
    body = rtu(text)[:-2]
    return b":" + (body + bytes([-sum(body) % 256])).hex().upper().encode() + b"\r\n"


def tcp(text: str) -> bytes:
    """The same over TCP, with the number that is used in all of these tests."""
    body = rtu(text)[:-2]
    return NUMBER.to_bytes(2, "big") + b"\0\0" + len(body).to_bytes(2, "big") + body
