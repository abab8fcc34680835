"""FACON frames in Wireshark: the worked examples of the paper, and frames that were broken by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.rows import each
from tests.wireshark.capture import (
    EXPERT,
    FACON,
    INFO,
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

PAGE = b"".join(b"%02X" % (byte % 256) for byte in range(128))
PAGE_SUM = b"%02X" % (sum(b"\x02014F0" + PAGE) % 256)
STATUS = b"\x0201530210102313380010001000064006407D203E800001F880C0001000100" + b"00" * 36 + b"A2\x03"

BROKE_OFF = "an incomplete frame, then another beginning"

CASES = [
    Case(
        "40",
        SENT,
        b"\x020140C7\x03",
        {
            INFO: "station 1 read brief status",
            "version": "1",
            "direction": "0",
            "protocol": "1",
            "role": "request",
            "station": "1",
            "command": "0x40",
            "lrc": "0xc7",
            "lrc.expected": "0xc7",
            "checksum.status": "1",
            "answer_in": "2",
            "answer_to": "",
            "noise": "",
            PROTOCOL: "FACON",
        },
    ),
    Case(
        "40 answer",
        RECEIVED,
        b"\x020140029000022\x03",
        {
            INFO: "station 1 answer: read brief status: RUN",
            "direction": "1",
            "role": "answer",
            "error": "0x00",
            "status": "0x29",
            "status.running": "1",
            "status.id_set": "1",
            "model": "0x00",
            "answer_to": "1",
            "time": "0.125000000",
            EXPERT: "",
        },
    ),
    Case("41 run", SENT, b"\x0201411F9\x03", {INFO: "station 1 RUN", "run": "1", "answer_in": "4"}),
    Case("41 run answer", RECEIVED, b"\x0201410F8\x03", {"error": "0x00", "answer_to": "3"}),
    Case(
        "42", SENT, b"\x0201421X001619\x03", {INFO: "station 1 disable X16", "control": "1", "element": "X16"}
    ),
    Case("42 answer", RECEIVED, b"\x0201420F9\x03", {INFO: "station 1 answer: disable X16"}),
    Case("43", SENT, b"\x02014307Y00104B\x03", {"count": "7", "element": "Y10"}),
    Case(
        "43 answer",
        RECEIVED,
        b"\x020143010100014D\x03",
        {
            INFO: "station 1 answer: read enable status of Y10..Y16",
            "value": "Y10 = disabled|Y11 = enabled|Y12 = disabled|Y13 = enabled|"
            "Y14 = enabled|Y15 = enabled|Y16 = disabled",
            EXPERT: "",
        },
    ),
    Case("44", SENT, b"\x02014406X00504E\x03", {INFO: "station 1 read X50..X55", "count": "6"}),
    Case(
        "44 answer",
        RECEIVED,
        b"\x02014400101101E\x03",
        {"value": "X50 = off|X51 = on|X52 = off|X53 = on|X54 = on|X55 = off"},
    ),
    Case(
        "45",
        SENT,
        b"\x02014504Y000010010B\x03",
        {INFO: "station 1 write Y0..Y3", "value": "Y0 = on|Y1 = off|Y2 = off|Y3 = on"},
    ),
    Case("45 answer", RECEIVED, b"\x0201450FC\x03", {INFO: "station 1 answer: write Y0..Y3"}),
    Case("46", SENT, b"\x02014603R0001275\x03", {INFO: "station 1 read R12..R14", "element": "R12"}),
    Case(
        "46 answer",
        RECEIVED,
        b"\x020146010A57FC4000189\x03",
        {
            INFO: "station 1 answer: read R12..R14: 4261, 32708, 1",
            "value": "R12 = 4261|R13 = 32708|R14 = 1",
            "checksum.status": "1",
        },
    ),
    Case(
        "47",
        SENT,
        b"\x02014702WY0008AAAA555580\x03",
        {INFO: "station 1 write WY8..WY24", "value": "WY8 = 43690|WY24 = 21845"},
    ),
    Case("47 answer", RECEIVED, b"\x0201470FE\x03", {INFO: "station 1 answer: write WY8..WY24"}),
    Case(
        "48",
        SENT,
        b"\x02014803R00001Y0009DWM00003F\x03",
        {INFO: "station 1 read R1, Y9, DWM0", "count": "3", "element": "R1|Y9|DWM0"},
    ),
    Case(
        "48 answer",
        RECEIVED,
        b"\x02014805C341003547BAC5\x03",
        {"value": "R1 = 23604|Y9 = on|DWM0 = 3491770"},
    ),
    Case(
        "49",
        SENT,
        b"\x02014904Y00000Y00010WM00085555DR00002000000FF3C\x03",
        {"element": "Y0|Y1|WM8|DR2", "value": "Y0 = off|Y1 = off|WM8 = 21845|DR2 = 255"},
    ),
    Case("49 answer", RECEIVED, b"\x020149000\x03", {"error": "0x00"}),
    Case("4E", SENT, b"\x02014EABCDEFGB8\x03", {"loopback": "41424344454647"}),
    Case("4E answer", RECEIVED, b"\x02014EABCDEFGB8\x03", {"loopback": "41424344454647", "role": "answer"}),
    Case("53", SENT, b"\x020153CB\x03", {INFO: "station 1 read detailed status"}),
    Case(
        "53 answer",
        RECEIVED,
        STATUS,
        {
            INFO: "station 1 answer: read detailed status: RUN, 13184 ladder words",
            "status": "0x21",
            "unit_type": "0x01",
            "unit_points": "0x02",
            "os_version": "3.1",
            "ladder_words": "13184",
            "discrete_inputs": "256",
            "analog_outputs": "100",
            "m_relays": "2002",
            "r_registers": "8072",
            "counters": "256",
        },
    ),
    Case("4F", SENT, b"\x02014F0005A2\x03", {INFO: "station 1 read page 5", "page": "5"}),
    Case(
        "a two-wire line echoes, and then it answers",
        RECEIVED,
        b"\x02014F0005A2\x03\x02014F0" + PAGE + PAGE_SUM + b"\x03",
        {
            INFO: "station 1 echo: read page 5; station 1 answer: read page 5",
            "role": "echo|answer",
            "page_data": bytes(range(128)).hex(),
            "station": "1|1",
            EXPERT: "",
        },
    ),
    Case("4F again", SENT, b"\x02014F0005A2\x03", {"page": "5"}),
    Case(
        "4F without an error character",
        RECEIVED,
        b"\x02014F" + PAGE + b"%02X" % (sum(b"\x02014F" + PAGE) % 256) + b"\x03",
        {"error": "", "page_data": bytes(range(128)).hex(), EXPERT: ""},
    ),
    Case(
        "50",
        SENT,
        b"\x0201500000" + PAGE + b"%02X" % (sum(b"\x0201500000" + PAGE) % 256) + b"\x03",
        {INFO: "station 1 write page 0", "page": "0", "page_data": bytes(range(128)).hex()},
    ),
    Case(
        "a refusal",
        RECEIVED,
        b"\x0201503FB\x03",
        {
            INFO: "station 1 answer: write page 0 REFUSED: write prohibited, a ROM pack is fitted",
            "error": "0x03",
            EXPERT: "Refused: write prohibited, a ROM pack is fitted",
        },
    ),
    Case(
        "an answer that nobody asked for",
        RECEIVED,
        b"\x02014604321" + b"C7\x03",
        {INFO: "station 1 answer: 46", "data": "34333231", "answer_to": "", EXPERT: "No request for it"},
    ),
    Case(
        "noise, two frames, and one that is cut off",
        RECEIVED,
        b"xx\x0201450FC\x03\x0202450FD\x03\x020146",
        {
            INFO: "[2 bytes: noise outside a frame]; station 1 answer: 45; station 2 answer: 45;"
            " [5 bytes: a frame that is cut off: no ETX]",
            "noise": "7878|0230313436",
            "station": "1|2",
            "checksum.status": "1|1",
        },
    ),
    Case(
        "a wrong checksum",
        RECEIVED,
        b"\x0201450FD\x03",
        {
            INFO: "station 1 answer: 45 [bad checksum]",
            "lrc": "0xfd",
            "lrc.expected": "0xfc",
            "checksum.status": "0",
            EXPERT: "Bad checksum: expected FC, got FD",
        },
    ),
    Case(
        "a checksum that is no number",
        RECEIVED,
        b"\x0201450f\xff\x03",
        {"station": "1", "lrc": "", "checksum.status": "0", EXPERT: "Bad checksum: expected FC"},
    ),
    Case(
        "a frame that broke off, and a good one behind it",
        RECEIVED,
        b"\x0201450\x0201450FC\x03",
        {"noise": "023031343530", "checksum.status": "1", EXPERT: f"{BROKE_OFF}|No request for it"},
    ),
    Case("STX and ETX alone", RECEIVED, b"\x02\x03\x03", {"noise": "0203|03", "station": ""}),
    Case(
        "small letters",
        RECEIVED,
        b"\x020a450FC\x03",
        {"station": "", EXPERT: "from STX to ETX, but no frame"},
    ),
    Case(
        "a command of no paper",
        SENT,
        b"\x020199xyz" + b"40\x03",
        {"command": "0x99", "data": "78797a", EXPERT: "Bad data: a command that no paper lists"},
    ),
    Case(
        "an element of no paper",
        SENT,
        b"\x02014601Q00001" + b"70\x03",
        {EXPERT: "Bad data: expected an element"},
    ),
    Case("a broadcast", SENT, b"\x0200410F7\x03", {INFO: "station 0 STOP", "station": "0", "answer_in": ""}),
    Case("nothing", RECEIVED, b"", {INFO: "", "station": "", EXPERT: ""}),
]


@pytest.fixture(scope="module")
def packets(tshark: Tshark) -> list[Packet]:
    return tshark(cases_in(FACON, CASES))


@each("place", range(len(CASES)), ids=lambda place: CASES[place].name)
def test_a_record(packets: list[Packet], place: int) -> None:
    case = CASES[place]
    assert seen(packets[place], case.fields) == case.fields


def test_every_record_is_there(packets: list[Packet]) -> None:
    assert len(packets) == len(CASES)
