"""Programs and backups for tests, made without the simulator."""

from __future__ import annotations

import json
from random import Random
from typing import Any

from fatektool.program.archive import Backup, Source
from fatektool.program.image import Program

COUNTS = (
    "ladder_words",
    "discrete_inputs",
    "discrete_outputs",
    "analog_inputs",
    "analog_outputs",
    "m_relays",
    "s_relays",
    "l_relays",
    "r_registers",
    "d_registers",
    "timers",
    "counters",
)
FLAGS = (
    "running",
    "battery_low",
    "ladder_checksum_error",
    "rom_pack",
    "watchdog_timeout",
    "id_set",
    "emergency_stop",
)


def header(words: int, start: bytes = b"FB30") -> bytes:
    return (start + words.to_bytes(2, "big")).ljust(128, b"\xff")


def program(words: int = 400, seed: int = 1, page0: bytes | None = None) -> Program:
    random = Random(seed)  # noqa: S311  # the same program each time
    pages = [random.randbytes(128) for _ in range(-(-words // 64))]
    return Program(words, (header(words) if page0 is None else page0, *pages))


def changed(old: Program, *numbers: int) -> Program:
    """The same program, but for one word in the middle of each of these pages."""
    pages = list(old.pages)
    for number in numbers:
        page = bytearray(pages[number])
        page[64] ^= 0xFF
        pages[number] = bytes(page)
    return Program(old.ladder_words, tuple(pages))


def plc_record(words: int) -> dict[str, Any]:
    return {
        "status": dict.fromkeys(FLAGS, False),
        "system": {
            "unit_type": {"code": 1, "name": "MC"},
            "main_unit_points": {"code": 2, "points": 28},
            "os_version": "3.1",
            **dict.fromkeys(COUNTS, 256),
            "ladder_words": words,
        },
    }


def backup(image: Program | None = None, *, target: str = "/dev/ttyUSB0", passes: int = 2) -> Backup:
    image = image or program()
    return Backup(
        image,
        "2026-11-22T03:15:00Z",
        "fatektool 0.1.0",
        Source(target, 1, "facon", "9600 7E1"),
        plc_record(image.ladder_words),
        passes,
    )


def document(image: Program | None = None) -> dict[str, Any]:
    """A backup file, taken apart."""
    found: dict[str, Any] = json.loads(backup(image).to_bytes())
    return found


def file_of(document: object) -> bytes:
    return json.dumps(document).encode()
