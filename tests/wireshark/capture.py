"""Captures written by hand, byte for byte as docs/trace.md has them, and what tshark sees in them."""

from __future__ import annotations

import os
import struct
import subprocess
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from tests.root import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterable

SCRIPT = ROOT / "examples" / "wireshark" / "fatek.lua"
USER0, RAW_IP = 147, 101
STEP_NS = 125_000_000
INFO, PROTOCOL, EXPERT = "_ws.col.Info", "_ws.col.Protocol", "_ws.expert.message"
FACON, MSERIES, RTU, ASCII, TCP = 1, 2, 3, 4, 5
SENT, RECEIVED = 0, 1

FIELDS = (
    *(INFO, PROTOCOL, EXPERT, "frame.protocols", "modbus.func_code", "data.data"),
    *("fatek.version", "fatek.direction", "fatek.protocol", "fatek.role", "fatek.station", "fatek.command"),
    *("fatek.error", "fatek.length", "fatek.run", "fatek.control", "fatek.count", "fatek.element"),
    *("fatek.value", "fatek.page", "fatek.page_data", "fatek.loopback", "fatek.data", "fatek.noise"),
    *("fatek.status", "fatek.status.running", "fatek.status.id_set", "fatek.model", "fatek.unit_type"),
    *("fatek.unit_points", "fatek.os_version", "fatek.ladder_words", "fatek.discrete_inputs"),
    *("fatek.analog_outputs", "fatek.m_relays", "fatek.r_registers", "fatek.counters"),
    *("fatek.lrc", "fatek.lrc.expected", "fatek.crc", "fatek.crc.expected", "fatek.checksum.status"),
    *("fatek.answer_in", "fatek.answer_to", "fatek.time"),
)


@dataclass(frozen=True)
class Case:
    """A record, and what is to be seen of it: the fields named, each with all its values."""

    name: str
    direction: int
    data: bytes
    fields: dict[str, str] = field(default_factory=dict)

    def __str__(self) -> str:
        return self.name


Packet = dict[str, str]
"""Field to value; of a field that stands there several times, the values with | between."""


def capture(records: Iterable[bytes], link_type: int = USER0) -> bytes:
    """A capture file; the records are an eighth of a second apart."""
    file = bytes.fromhex("4D3CB2A1 0200 0400 00000000 00000000 FFFF0000") + struct.pack("<I", link_type)
    for place, record in enumerate(records):
        seconds, nanoseconds = divmod(place * STEP_NS, 10**9)
        size = len(record)
        file += struct.pack("<IIII", 1_795_317_300 + seconds, nanoseconds, size, size) + record
    return file


def traced(protocol: int, direction: int, data: bytes) -> bytes:
    """A record with its pseudo-header."""
    return bytes([1, direction, protocol, 0]) + data


def cases_in(protocol: int, cases: Iterable[Case]) -> bytes:
    return capture(traced(protocol, case.direction, case.data) for case in cases)


class Tshark:
    """Runs tshark with the script, away from what the user has installed."""

    def __init__(self, program: str, folder: Path) -> None:
        self._program = program
        self._folder = folder

    def __call__(self, file: bytes | Path, *options: str) -> list[Packet]:
        """All packets of a capture, in two passes, so that a request knows its answer."""
        path = file if isinstance(file, Path) else self._folder / "hand.pcap"
        if isinstance(file, bytes):
            path.write_bytes(file)
        shown = [word for name in FIELDS for word in ("-e", name)]
        form = ["-T", "fields", "-E", "separator=/t", "-E", "aggregator=|", "-E", "occurrence=a"]
        done = subprocess.run(
            [self._program, "-X", f"lua_script:{SCRIPT}", "-n", "-2", "-r", path, *options, *form, *shown],
            capture_output=True,
            check=False,
            env=os.environ | {"HOME": str(self._folder), "WIRESHARK_CONFIG_DIR": str(self._folder)},
        )
        complaints = done.stderr.decode()
        assert done.returncode == 0, complaints
        assert "Lua" not in complaints, complaints
        lines = done.stdout.decode().splitlines()
        return [dict(zip(FIELDS, line.split("\t"), strict=True)) for line in lines]


def seen(packet: Packet, wanted: dict[str, str]) -> dict[str, str]:
    """Of a packet, what is wanted; the names are without ``fatek.``."""
    return {name: packet.get(name) or packet.get(f"fatek.{name}", "") for name in wanted}
