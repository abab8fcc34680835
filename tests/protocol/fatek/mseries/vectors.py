"""Every worked example of the M-series paper, section 2.5.

``EXAMPLES`` are the whole frames of its tables. Their answers' CRCs are printed shifted by a byte (``D4 55``
for 45 D4 · 55 AA) and stand here where they belong. ``PAYLOADS`` are the examples that are shown without
framing.
"""

from __future__ import annotations

from fatektool.protocol.commands import (
    Control,
    ControlDiscrete,
    Loopback,
    ReadBriefStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WriteRegisters,
)
from fatektool.protocol.status import BriefStatus, StatusFlags
from tests.protocol.decoding import query, response
from tests.protocol.vectors import Example, element


def status(byte: int) -> BriefStatus:
    return BriefStatus(StatusFlags.parse(byte), 0, 0, m_series=True)


WRITTEN = ((element("Y0"), 1), (element("Y1"), 0), (element("WM8"), 0x5555), (element("DR2"), 0xFF))

EXAMPLES = [
    Example(
        "40 brief status",
        ReadBriefStatus(),
        bytes.fromhex("51 10 00 02 01 40 A1 84 55 AA"),
        status(0x01),
        bytes.fromhex("52 10 00 06 01 40 00 01 00 00 77 D5 55 AA"),
    ),
    Example(
        "41 STOP",
        RunStop(run=False),
        bytes.fromhex("51 10 00 03 01 41 00 45 D4 55 AA"),
        None,
        bytes.fromhex("52 10 00 03 01 41 00 45 D4 55 AA"),
    ),
    Example(
        "42 set Y100",
        ControlDiscrete(Control.SET, element("Y100")),
        bytes.fromhex("51 10 00 06 01 42 03 59 00 64 8E 69 55 AA"),
        None,
        bytes.fromhex("52 10 00 03 01 42 00 45 24 55 AA"),
    ),
    Example(
        "43 enable status of X0 to X3",
        ReadDisabled(element("X0"), 4),
        bytes.fromhex("51 10 00 06 01 43 04 58 00 00 E2 F6 55 AA"),
        (True, True, True, True),
        bytes.fromhex("52 10 00 07 01 43 00 01 01 01 01 C5 49 55 AA"),
    ),
    Example(
        "44 read Y0 to Y14",
        ReadDiscretes(element("Y0"), 15),
        bytes.fromhex("51 10 00 06 01 44 0F 59 00 00 04 D2 55 AA"),
        (False,) * 15,
        bytes.fromhex("52 10 00 12 01 44 00" + 15 * " 00" + " BB 89 55 AA"),
    ),
    Example(
        "45 write Y0 to Y2",
        WriteDiscretes(element("Y0"), (False, True, False)),
        bytes.fromhex("51 10 00 09 01 45 03 59 00 00 00 01 00 21 0D 55 AA"),
        None,
        bytes.fromhex("52 10 00 03 01 45 00 47 14 55 AA"),
    ),
    Example(
        "46 read R0 and R1",
        ReadRegisters(element("R0"), 2),
        bytes.fromhex("51 10 00 06 01 46 02 52 00 00 0E 7C 55 AA"),
        (0xFF55, 0xFF4B),
        bytes.fromhex("52 10 00 07 01 46 00 FF 55 FF 4B 74 B3 55 AA"),
    ),
    Example(
        "47 write R0 to R2",
        WriteRegisters(element("R0"), (0xFF55, 0xFF4B, 0xFF41)),
        bytes.fromhex("51 10 00 0C 01 47 03 52 00 00 FF 55 FF 4B FF 41 C4 16 55 AA"),
        None,
        bytes.fromhex("52 10 00 03 01 47 00 46 74 55 AA"),
    ),
    Example(
        "48 read DR15 and D1",
        ReadMixed((element("DR15"), element("D1"))),
        bytes.fromhex("51 10 00 0A 01 48 02 44 52 00 0F 44 00 01 48 B2 55 AA"),
        (0x99990000, 0),
        bytes.fromhex("52 10 00 09 01 48 00 99 99 00 00 00 00 DF 18 55 AA"),
    ),
    Example(
        "49 write Y0, Y1, WM8 and DR2",  # the request of the figure; the table's does not fit its length
        WriteMixed(WRITTEN),
        bytes.fromhex(
            "51 10 00 19 01 49 04 59 00 00 01 59 00 01 00 57 4D 00 08 55 55"
            "44 52 00 02 00 00 00 FF 13 7A 55 AA"
        ),
        None,
        bytes.fromhex("52 10 00 03 01 49 00 42 14 55 AA"),
    ),
    Example(
        "4E loopback of FF FF",
        Loopback(b"\xff\xff"),
        bytes.fromhex("51 10 00 04 01 4E FF FF 91 80 55 AA"),
        b"\xff\xff",
        bytes.fromhex("52 10 00 04 01 4E FF FF 91 80 55 AA"),  # its length is printed 0003
    ),
]

PAYLOADS = [
    Example(
        "40 RUN, memory card, ID",
        ReadBriefStatus(),
        query("01 40"),
        status(0x29),
        response("01 40 00 29 00 00"),
    ),
    Example("41 RUN", RunStop(run=True), query("01 41 01"), None, response("01 41 00")),
    Example(
        "42 disable X16",
        ControlDiscrete(Control.DISABLE, element("X16")),
        query("01 42 01 58 00 10"),
        None,
        response("01 42 00"),
    ),
    Example(
        "43 enable status of Y10 to Y16",
        ReadDisabled(element("Y10"), 7),
        query("01 43 07 59 00 0A"),
        (True, False, True, False, False, False, True),
        response("01 43 00 01 00 01 00 00 00 01"),
    ),
    Example(
        "44 read X50 to X55",
        ReadDiscretes(element("X50"), 6),
        query("01 44 06 58 00 32"),
        (False, True, False, True, True, False),
        response("01 44 00 00 01 00 01 01 00"),
    ),
    Example(
        "48 read R1, Y9 and DWM0",
        ReadMixed((element("R1"), element("Y9"), element("DWM0"))),
        query("01 48 03 52 00 01 59 00 09 44 57 4D 00 00"),
        (0x5C34, 1, 0x003547BA),
        response("01 48 00 5C 34 01 00 35 47 BA"),
    ),
    Example(
        "4E loopback of ABCDEFG",
        Loopback(b"ABCDEFG"),
        query("01 4E 41 42 43 44 45 46 47"),
        b"ABCDEFG",
        response("01 4E 41 42 43 44 45 46 47"),
    ),
]

NAMES = [example.name for example in EXAMPLES]

FRAMES = [raw for example in EXAMPLES for raw in (example.asks, example.answers)]
"""Each a whole and right frame."""
