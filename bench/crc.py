"""The CRC of M-series frames: this project's table beside the paper's loop and the libraries.

A library is measured if it is installed: fastcrc (Rust), crcmod (C), pymodbus (a table in Python). What
counts is the time beside that of the frame on the wire at the highest speed these PLCs have.

Usage: python bench/crc.py
"""

from __future__ import annotations

import importlib
import timeit
from operator import attrgetter, methodcaller
from typing import TYPE_CHECKING, Any

from figures import figure

from fatektool.protocol.commands import Loopback, ReadBriefStatus, ReadRegisters, Request, WriteRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.mseries.codec import MSERIES
from fatektool.protocol.fatek.mseries.crc import crc16

if TYPE_CHECKING:
    from collections.abc import Callable

LIMIT = 0.05
BAUD = 921600
BITS_PER_BYTE = 11  # 8E1
RUNS = 5
LOOPS = 4000
R0 = Element("R", 0)


def frames() -> dict[str, bytes]:
    """What goes over the line, the shortest and the longest among it."""
    read = ReadRegisters(R0, 64)
    asked: dict[str, Request[Any]] = {
        "40 request": ReadBriefStatus(),
        "46 request": read,
        "47 of 64 registers": WriteRegisters(R0, tuple(range(64))),
        "4E of 256 bytes": Loopback(bytes(range(256))),
    }
    found = {name: MSERIES.encode(1, request) for name, request in asked.items()}
    found["46 answer of 64"] = MSERIES.encode_answer(1, read, tuple(range(64)))
    return dict(sorted(found.items(), key=lambda pair: len(pair[1])))


def paper(data: bytes) -> int:
    """Bit by bit, as the paper describes it."""
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ 0xA001 if value & 1 else value >> 1
    return value


def libraries() -> dict[str, Callable[[bytes], int]]:
    """The libraries that are installed."""
    known: list[tuple[str, Callable[[Any], Callable[[bytes], int]]]] = [
        ("fastcrc", attrgetter("crc16.modbus")),
        ("crcmod.predefined", methodcaller("mkPredefinedCrcFun", "modbus")),
        ("pymodbus.framer.rtu", attrgetter("FramerRTU.compute_CRC")),
    ]
    found: dict[str, Callable[[bytes], int]] = {}
    for name, function in known:
        try:
            found[name.partition(".")[0]] = function(importlib.import_module(name))
        except (ImportError, AttributeError):
            print(f"{name}: not installed")
    return found


def took(function: Callable[[bytes], int], data: bytes) -> float:
    """Seconds of one call, the least of several runs."""
    loops = LOOPS if function is not paper else LOOPS // 20
    return min(timeit.repeat(lambda: function(data), number=loops, repeat=RUNS)) / loops


def main() -> None:
    """Print a row a frame."""
    ways = {"paper": paper, "table": crc16} | libraries()
    for name, raw in frames().items():
        checked = raw[2:-4]
        wire_s = len(raw) * BITS_PER_BYTE / BAUD
        times = {way: took(function, checked) for way, function in ways.items()}
        shown = "  ".join(f"{way} {1e6 * seconds:.2f}" for way, seconds in times.items())
        size = f"{len(raw)} bytes, {1e6 * wire_s:.0f} us"
        figure(f"CRC, {name}", times["table"] / wire_s, limit=LIMIT)
        print(f"{name:<19} {size:<18}  {shown} us  ratio {times['table'] / wire_s:.4f}  limit {LIMIT}")


if __name__ == "__main__":
    main()
