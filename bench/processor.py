"""What does an exchange cost the processor? Instructions and microseconds, beside the least that does it.

::

    encode      a request to its frame
    decode      an answer's frame to values, its checksum proven
    exchange    both, and the line between: over TCP to a simulator in another process

The bare side is a straight line of Python that gives the same values from the same bytes, and proves the
checksum, but knows no station, no error code, no late answer, no noise and no half frame. Instructions are
the process's own, without the kernel's, counted by valgrind (cachegrind), where there is one: the difference
between a long and a short run, so that starting counts for nothing. Microseconds are the best of some runs.

Usage: python bench/processor.py
"""

from __future__ import annotations

import re
import shutil
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

sys.path.insert(0, str(Path(__file__).parent.parent))

from common import pinned, simulator
from figures import figure

from fatektool import connect
from fatektool.exchange.batch import read_all
from fatektool.protocol.commands import ReadPage, ReadRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.fatek.mseries.codec import MSERIES

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.commands import Request

LIMIT: Final = 1.8
SHORT: Final = 200
LONG: Final = 1200
RUNS: Final = 5

PAGE: Final = ReadPage(5)
REGISTERS: Final = ReadRegisters(Element("R", 0), 64)
EXCHANGES: Final[dict[str, tuple[Any, Request[Any]]]] = {
    "facon 4F": (FACON, PAGE),
    "facon 46": (FACON, REGISTERS),
    "mseries 46": (MSERIES, REGISTERS),
}


# --- the bare side: one straight function a direction ------------------------------------------------------


def bare_encode_page() -> bytes:
    """4F, page 5."""
    body = b"\x0201%02X%04X" % (0x4F, 5)
    return b"%b%02X\x03" % (body, sum(body) & 0xFF)


def bare_decode_page(raw: bytes) -> bytes:
    """A page, its checksum proven."""
    if int(raw[-3:-1], 16) != sum(raw[:-3]) & 0xFF or raw[5] != 0x30:
        raise ValueError(raw)
    return bytes.fromhex(raw[6:-3].decode())


def bare_encode_registers() -> bytes:
    """46, 64 words from R0."""
    body = b"\x0201%02X%02XR%05d" % (0x46, 64, 0)
    return b"%b%02X\x03" % (body, sum(body) & 0xFF)


def bare_decode_registers(raw: bytes) -> tuple[int, ...]:
    """Registers, the checksum proven."""
    if int(raw[-3:-1], 16) != sum(raw[:-3]) & 0xFF or raw[5] != 0x30:
        raise ValueError(raw)
    return struct.unpack(">64H", bytes.fromhex(raw[6:-3].decode()))


def _table() -> list[int]:
    found = []
    for value in range(256):
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)  # noqa: PLW2901
        found.append(value)
    return found


TABLE: Final = _table()


def bare_crc(data: bytes) -> int:
    """CRC-16/MODBUS."""
    table, crc = TABLE, 0xFFFF
    for byte in data:
        crc = crc >> 8 ^ table[(crc ^ byte) & 0xFF]
    return crc


def bare_encode_mseries() -> bytes:
    """46, 64 words from R0."""
    checked = struct.pack(">HBBBcH", 6, 1, 0x46, 64, b"R", 0)
    return b"\x51\x10%b%b\x55\xaa" % (checked, bare_crc(checked).to_bytes(2, "little"))


def bare_decode_mseries(raw: bytes) -> tuple[int, ...]:
    """Registers, the checksum proven."""
    if raw[-4:-2] != bare_crc(raw[2:-4]).to_bytes(2, "little") or raw[6]:
        raise ValueError(raw)
    return struct.unpack(">64H", raw[7:-4])


BARE: Final[dict[str, tuple[Callable[[], bytes], Callable[[bytes], Any]]]] = {
    "facon 4F": (bare_encode_page, bare_decode_page),
    "facon 46": (bare_encode_registers, bare_decode_registers),
    "mseries 46": (bare_encode_mseries, bare_decode_mseries),
}


def bare_loop(name: str, target: str, count: int) -> float:
    """So many exchanges in a row over TCP; seconds."""
    encode, decode = BARE[name]
    codec, request = EXCHANGES[name]
    size = codec.answer_bytes(request)
    host, _, port = target.removeprefix("tcp://").rpartition(":")
    with socket.create_connection((host, int(port))) as connected:
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        began = time.perf_counter()
        for _ in range(count):
            connected.sendall(encode())
            answer = connected.recv(size)
            while len(answer) < size:
                answer += connected.recv(size - len(answer))
            decode(answer)
        return time.perf_counter() - began


# --- the tool's side ---------------------------------------------------------------------------------------


def tool_encode(name: str) -> Callable[[], object]:
    """What encodes a request."""
    codec, request = EXCHANGES[name]
    return lambda: codec.encode(1, request)


def tool_decode(name: str, raw: bytes) -> Callable[[], object]:
    """What decodes an answer, whole in one chunk."""
    codec, request = EXCHANGES[name]
    decoder = codec.decoder()

    def decode() -> object:
        decoder.feed(raw)
        return codec.parse_answer(request, decoder.next_frame())

    return decode


def tool_loop(name: str, target: str, count: int) -> float:
    """So many exchanges in a row, with all that keeps answers apart; seconds."""
    codec, request = EXCHANGES[name]
    with connect(target, protocol=codec.name) as plc:
        plc.brief_status()
        began = time.perf_counter()
        read_all(plc.link, [request] * count)
        return time.perf_counter() - began


# --- what is measured, in a process of its own --------------------------------------------------------------


def run(side: str, part: str, name: str, target: str, count: int) -> float:
    """One part so many times; seconds."""
    if part == "exchange":
        return (bare_loop if side == "bare" else tool_loop)(name, target, count)
    codec, request = EXCHANGES[name]
    answer = codec.encode_answer(1, request, bytes(128) if request is PAGE else tuple(range(64)))
    encode, decode = BARE[name]
    if part == "encode":
        act = encode if side == "bare" else tool_encode(name)
    else:
        act = (lambda: decode(answer)) if side == "bare" else tool_decode(name, answer)
    began = time.perf_counter()
    for _ in range(count):
        act()
    return time.perf_counter() - began


def child(*words: str) -> list[str]:
    """The command of a process that runs one part."""
    return [sys.executable, __file__, *words]


def microseconds(words: list[str]) -> float:
    """Of one turn, in the best of some runs."""
    return min(
        float(subprocess.run(pinned(1, child(*words, str(LONG))), stdout=subprocess.PIPE, check=True).stdout)
        for _ in range(RUNS)
    ) / LONG * 1e6  # fmt: skip


def instructions(words: list[str]) -> float | None:
    """Of one turn, without what starting costs; None without valgrind."""
    if shutil.which("valgrind") is None:
        return None
    counts = []
    for turns in (SHORT, LONG):
        count = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
        done = subprocess.run(
            [*count, *child(*words, str(turns))], capture_output=True, text=True, check=True
        )
        found = re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)
        if found is None:
            return None
        counts.append(int(found[1].replace(",", "")))
    return (counts[1] - counts[0]) / (LONG - SHORT)


def row(name: str, part: str, target: str) -> str:
    """Both sides of one part."""
    text = f"{name:<11} {part:<9}"
    for unit, measure, form in (("us", microseconds, "8.2f"), ("instructions", instructions, "8.0f")):
        bare, tool = (measure([side, part, name, target]) for side in ("bare", "tool"))
        if bare is not None and tool is not None:
            limit = LIMIT if (name, part, unit) == ("facon 4F", "exchange", "instructions") else None
            figure(f"{name} {part}, {unit}", tool / bare, limit=limit)
            text += f"  {unit}: bare {bare:{form}} tool {tool:{form}} ratio {tool / bare:.2f}"
    return text


def main() -> None:
    """Print a row a kind of exchange and part."""
    if len(sys.argv) > 1:
        side, part, name, target, count = sys.argv[1:]
        print(run(side, part, name, target, int(count)))
        return
    print(f"limit of the instructions of an exchange: {LIMIT}")
    for name, (codec, _) in EXCHANGES.items():
        with simulator("--tcp", "127.0.0.1:0", "--protocol", codec.name, "--ladder-words", "65535") as target:
            for part in ("encode", "decode", "exchange"):
                print(row(name, part, target), flush=True)


if __name__ == "__main__":
    main()
