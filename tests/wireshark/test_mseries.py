"""M-series frames in Wireshark: the worked examples of the paper, and frames that were broken by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.rows import each
from tests.wireshark.capture import (
    EXPERT,
    INFO,
    MSERIES,
    PROTOCOL,
    RECEIVED,
    SENT,
    Case,
    Packet,
    cases_in,
    seen,
)

if TYPE_CHECKING:
    from tests.wireshark.capture import Tshark


def case(name: str, direction: int, text: str, fields: dict[str, str]) -> Case:
    return Case(name, direction, bytes.fromhex(text), fields)


CASES = [
    case(
        "40 brief status",
        SENT,
        "511000020140A18455AA",
        {"element": "", "crc": "0x84a1", "crc.expected": "0x84a1", "length": "2", "checksum.status": "1"},
    ),
    case(
        "40 answer",
        RECEIVED,
        "5210000601400001000077D555AA",
        {"status": "0x01", "status.running": "1", "role": "answer", "checksum.status": "1"},
    ),
    case("41 stop", SENT, "5110000301410045D455AA", {"run": "0", "checksum.status": "1"}),
    case("41 answer", RECEIVED, "5210000301410045D455AA", {"error": "0x00", "checksum.status": "1"}),
    case(
        "42 set Y100",
        SENT,
        "511000060142035900648E6955AA",
        {"control": "3", "element": "Y100", "checksum.status": "1"},
    ),
    case("42 answer", RECEIVED, "52100003014200452455AA", {"error": "0x00", "checksum.status": "1"}),
    case(
        "43 enable status of X0..X3",
        SENT,
        "51100006014304580000E2F655AA",
        {"count": "4", "element": "X0", "checksum.status": "1"},
    ),
    case(
        "43 answer",
        RECEIVED,
        "5210000701430001010101C54955AA",
        {"value": "X0 = disabled|X1 = disabled|X2 = disabled|X3 = disabled", "checksum.status": "1"},
    ),
    case(
        "44 read Y0..Y14",
        SENT,
        "5110000601440F59000004D255AA",
        {"count": "15", "element": "Y0", "checksum.status": "1"},
    ),
    case(
        "44 answer",
        RECEIVED,
        "52100012014400000000000000000000000000000000BB8955AA",
        {
            "value": "|".join(f"Y{place} = off" for place in range(15)),
            "checksum.status": "1",
        },
    ),
    case(
        "45 write Y0..Y2",
        SENT,
        "51100009014503590000000100210D55AA",
        {"value": "Y0 = off|Y1 = on|Y2 = off", "checksum.status": "1"},
    ),
    case("45 answer", RECEIVED, "52100003014500471455AA", {"error": "0x00", "checksum.status": "1"}),
    case(
        "46 read R0, R1",
        SENT,
        "511000060146025200000E7C55AA",
        {"count": "2", "element": "R0", "checksum.status": "1"},
    ),
    case(
        "46 answer",
        RECEIVED,
        "52100007014600FF55FF4B74B355AA",
        {"value": "R0 = 65365|R1 = 65355", "checksum.status": "1"},
    ),
    case(
        "47 write R0..R2",
        SENT,
        "5110000C014703520000FF55FF4BFF41C41655AA",
        {"value": "R0 = 65365|R1 = 65355|R2 = 65345", "checksum.status": "1"},
    ),
    case("47 answer", RECEIVED, "52100003014700467455AA", {"error": "0x00", "checksum.status": "1"}),
    case(
        "48 read DR15, D1",
        SENT,
        "5110000A0148024452000F44000148B255AA",
        {"element": "DR15|D1", "checksum.status": "1"},
    ),
    case(
        "48 answer",
        RECEIVED,
        "52100009014800999900000000DF1855AA",
        {"value": "DR15 = 2576941056|D1 = 0", "checksum.status": "1"},
    ),
    case(
        "49 write Y0, Y1, WM8, DR2",
        SENT,
        "511000190149045900000159000100574D0008555544520002000000FF137A55AA",
        {
            "element": "Y0|Y1|WM8|DR2",
            "value": "Y0 = on|Y1 = off|WM8 = 21845|DR2 = 255",
            "checksum.status": "1",
        },
    ),
    case("49 answer", RECEIVED, "52100003014900421455AA", {"error": "0x00", "checksum.status": "1"}),
    case(
        "4E loopback",
        SENT,
        "51100004014EFFFF918055AA",
        {"loopback": "ffff", "error": "", "checksum.status": "1"},
    ),
    case(
        "4E answer",
        RECEIVED,
        "52100004014EFFFF918055AA",
        {"loopback": "ffff", "error": "", "checksum.status": "1"},
    ),
    case(
        "53",
        SENT,
        "51 10 0002 01 53 E049 55AA",
        {INFO: "station 1 read detailed status", PROTOCOL: "M-series", "answer_in": "24"},
    ),
    case(
        "a refusal",
        RECEIVED,
        "52 10 0003 01 53 04 48B7 55AA",
        {
            "error": "0x04",
            "answer_to": "23",
            EXPERT: "Refused: illegal format, or a command that cannot be executed",
        },
    ),
    case(
        "a payload that holds 55 AA",
        SENT,
        "51 10 0006 01 4E 55AA 55AA C117 55AA",
        {"loopback": "55aa55aa", "checksum.status": "1", "noise": ""},
    ),
    case(
        "noise, two frames, and one that is cut off",
        RECEIVED,
        "00FF 52100003014200452455AA 52100003014500471455AA 521000030142",
        {"noise": "00ff|521000030142", "command": "0x42|0x45", "checksum.status": "1|1"},
    ),
    case(
        "a wrong CRC",
        RECEIVED,
        "52100003014200452555AA",
        {
            "crc": "0x2545",
            "crc.expected": "0x2445",
            "checksum.status": "0",
            EXPERT: "Bad checksum: expected 2445, got 2545",
        },
    ),
    case(
        "a wrong terminator, and a good frame behind it",
        RECEIVED,
        "52100003014200452455AB 52100003014500471455AA",
        {"noise": "52100003014200452455ab", "command": "0x45"},
    ),
    case(
        "a length beyond the record",
        RECEIVED,
        "5210FFFF014200452455AA",
        {"noise": "5210ffff014200452455aa"},
    ),
    case("no payload", RECEIVED, "52100000000055AA", {"noise": "52100000000055aa", "station": ""}),
    case(
        "R17152, which is read as RC",
        SENT,
        "51 10 0006 01 46 01 52 4300 3F08 55AA",
        {EXPERT: "Bad data: the data end too early"},
    ),
]


@pytest.fixture(scope="module")
def packets(tshark: Tshark) -> list[Packet]:
    return tshark(cases_in(MSERIES, CASES))


@each("place", range(len(CASES)), ids=lambda place: CASES[place].name)
def test_a_record(packets: list[Packet], place: int) -> None:
    wanted = CASES[place].fields
    assert len(packets) == len(CASES)
    assert seen(packets[place], wanted) == wanted
