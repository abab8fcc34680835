"""Every worked example of the FACON communication protocol paper, section 4.2, and its misprints.

The bytes are the paper's hex rows, not what any code of this project gives. Where a row is misprinted, the
drawn characters stand in ``EXAMPLES`` and the row itself in ``MISPRINTS``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fatektool.protocol.commands import (
    Control,
    ControlDiscrete,
    Loopback,
    ReadBriefStatus,
    ReadDetailedStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    Request,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.status import BriefStatus, DetailedStatus, StatusFlags, System


@dataclass(frozen=True)
class Example:
    name: str
    request: Request[Any]
    asks: bytes
    answer: Any
    answers: bytes


@dataclass(frozen=True)
class Misprint:
    name: str
    raw: bytes
    expected: str
    got: str


def element(text: str) -> Element:
    return Element.parse(text)


FBE_28MC_BYTES = bytes.fromhex(
    "21 01 02 31 3380 0100 0100 0064 0064 07D2 03E8 0000 1F88 0C00 0100 0100" + 36 * "00"
)
FBE_28MC = DetailedStatus(
    StatusFlags(
        running=True,
        battery_low=False,
        ladder_checksum_error=False,
        rom_pack=False,
        watchdog_timeout=False,
        id_set=True,
        emergency_stop=False,
    ),
    System(
        unit_type=1,
        main_unit_points=2,
        os_version="3.1",
        ladder_words=13184,
        discrete_inputs=256,
        discrete_outputs=256,
        analog_inputs=100,  # the paper labels it 64, and prints 0064H
        analog_outputs=100,
        m_relays=2002,
        s_relays=1000,
        l_relays=0,
        r_registers=8072,
        d_registers=3072,
        timers=256,
        counters=256,
    ),
    FBE_28MC_BYTES,
)

EXAMPLES = [
    Example(
        "40 brief status",
        ReadBriefStatus(),
        bytes.fromhex("02 30 31 34 30 43 37 03"),
        BriefStatus(
            StatusFlags(
                running=True,
                battery_low=False,
                ladder_checksum_error=False,
                rom_pack=True,
                watchdog_timeout=False,
                id_set=True,
                emergency_stop=False,
            ),
            0,
            0,
        ),
        bytes.fromhex("02 30 31 34 30 30 32 39 30 30 30 30 32 32 03"),
    ),
    Example(
        "41 RUN",
        RunStop(run=True),
        bytes.fromhex("02 30 31 34 31 31 46 39 03"),
        None,
        bytes.fromhex("02 30 31 34 31 30 46 38 03"),
    ),
    Example(
        "42 disable X16",
        ControlDiscrete(Control.DISABLE, element("X16")),
        bytes.fromhex("02 30 31 34 32 31 58 30 30 31 36 31 39 03"),
        None,
        bytes.fromhex("02 30 31 34 32 30 46 39 03"),
    ),
    Example(
        "43 enable status of Y10 to Y16",
        ReadDisabled(element("Y10"), 7),
        bytes.fromhex("02 30 31 34 33 30 37 59 30 30 31 30 34 42 03"),
        (True, False, True, False, False, False, True),  # Y10, Y12 and Y16 are disabled
        bytes.fromhex("02 30 31 34 33 30 31 30 31 30 30 30 31 34 44 03"),
    ),
    Example(
        "44 read X50 to X55",
        ReadDiscretes(element("X50"), 6),
        bytes.fromhex("02 30 31 34 34 30 36 58 30 30 35 30 34 45 03"),
        (False, True, False, True, True, False),
        bytes.fromhex("02 30 31 34 34 30 30 31 30 31 31 30 31 45 03"),
    ),
    Example(
        "45 write Y0 to Y3",
        WriteDiscretes(element("Y0"), (True, False, False, True)),
        bytes.fromhex("02 30 31 34 35 30 34 59 30 30 30 30 31 30 30 31 30 42 03"),
        None,
        bytes.fromhex("02 30 31 34 35 30 46 43 03"),
    ),
    Example(
        "46 read R12 to R14",
        ReadRegisters(element("R12"), 3),
        bytes.fromhex("02 30 31 34 36 30 33 52 30 30 30 31 32 37 35 03"),
        (0x10A5, 0x7FC4, 0x0001),
        bytes.fromhex("02 30 31 34 36 30 31 30 41 35 37 46 43 34 30 30 30 31 38 39 03"),
    ),
    Example(
        "47 write WY8 and WY24",
        WriteRegisters(element("WY8"), (0xAAAA, 0x5555)),
        bytes.fromhex("02 30 31 34 37 30 32 57 59 30 30 30 38 41 41 41 41 35 35 35 35 38 30 03"),
        None,
        bytes.fromhex("02 30 31 34 37 30 46 45 03"),
    ),
    Example(
        "48 read R1, Y9 and DWM0",
        ReadMixed((element("R1"), element("Y9"), element("DWM0"))),
        bytes.fromhex("02 30 31 34 38 30 33 52 30 30 30 30 31 59 30 30 30 39 44 57 4D 30 30 30 30 33 46 03"),
        (0x5C34, 1, 0x003547BA),
        bytes.fromhex("02 30 31 34 38 30 35 43 33 34 31 30 30 33 35 34 37 42 41 43 35 03"),
    ),
    Example(
        "49 write Y0, Y1, WM8 and DR2",
        WriteMixed(
            (
                (element("Y0"), 1),
                (element("Y1"), 0),
                (element("WM8"), 0x5555),
                (element("DR2"), 0x000000FF),
            )
        ),
        bytes.fromhex(
            "02 30 31 34 39 30 34 59 30 30 30 30 31 59 30 30 30 31 30 57 4D 30 30 30 38 35 35 35 35"
            "44 52 30 30 30 30 32 30 30 30 30 30 30 46 46 33 43 03"
        ),
        None,
        bytes.fromhex("02 30 31 34 39 30 30 30 03"),
    ),
    Example(
        "4E loopback of ABCDEFG",
        Loopback(b"ABCDEFG"),
        bytes.fromhex("02 30 31 34 45 41 42 43 44 45 46 47 42 38 03"),
        b"ABCDEFG",
        bytes.fromhex("02 30 31 34 45 41 42 43 44 45 46 47 42 38 03"),
    ),
    Example(
        "53 detailed status of an FBE-28MC",  # its LRC is left blank in the paper
        ReadDetailedStatus(),
        bytes.fromhex("02 30 31 35 33 43 42 03"),
        FBE_28MC,
        bytes.fromhex(
            "02 30 31 35 33 30 32 31 30 31 30 32 33 31 33 33 38 30 30 31 30 30"
            "30 31 30 30 30 30 36 34 30 30 36 34 30 37 44 32 30 33 45 38 30 30 30 30 31 46 38 38"
            "30 43 30 30 30 31 30 30 30 31 30 30" + 72 * "30" + "41 32 03"
        ),
    ),
]

NAMES = [example.name for example in EXAMPLES]

FRAMES = [raw for example in EXAMPLES for raw in (example.asks, example.answers)]
"""Each a whole and right frame."""

MISPRINTS = [
    Misprint(
        "44 request, 4D for 4E",
        bytes.fromhex("02 30 31 34 34 30 36 58 30 30 35 30 34 44 03"),
        "4E",
        "4D",
    ),
    Misprint(
        "44 answer, 1D for 1E",
        bytes.fromhex("02 30 31 34 34 30 30 31 30 31 31 30 31 44 03"),
        "1E",
        "1D",
    ),
    Misprint("47 answer, drawn FF for FE", bytes.fromhex("02 30 31 34 37 30 46 46 03"), "FE", "FF"),
    Misprint(
        "48 request, 41 for Y0009",
        bytes.fromhex("02 30 31 34 38 30 33 52 30 30 30 30 31 41 41 41 41 41 44 57 4D 30 30 30 30 33 46 03"),
        "62",
        "3F",
    ),
    Misprint(
        "48 answer, 47 for 48",
        bytes.fromhex("02 30 31 34 37 30 35 43 33 34 31 30 30 33 35 34 37 42 41 43 35 03"),
        "C4",
        "C5",
    ),
    Misprint(
        "49 request, DWM8 for WM8 and DR03002 for DR00002",
        bytes.fromhex(
            "02 30 31 34 39 30 34 59 30 30 30 30 31 59 30 30 30 31 44 57 4D 30 30 30 38 35 35 35 35"
            "44 52 30 33 30 30 32 30 30 30 30 30 30 46 46 33 43 03"
        ),
        "53",
        "3C",
    ),
]
