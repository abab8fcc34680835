"""Data fields: any request and answer both ways, and what is none."""

from __future__ import annotations

from typing import Any

import pytest

from fatektool.errors import FrameError, PlcRefused
from fatektool.protocol.commands import (
    Command,
    Loopback,
    ReadBriefStatus,
    ReadDetailedStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadPage,
    ReadRegisters,
    Request,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WritePage,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.fatek.facon.data import DATA
from fatektool.protocol.plc_errors import MEANINGS, PROGRAM_REFUSED, asked, refusal
from fatektool.protocol.status import BriefStatus, DetailedStatus
from tests.protocol.strategies import BY_COMMAND
from tests.protocol.vectors import EXAMPLES, FBE_28MC_BYTES
from tests.rows import each

PAGE = bytes(range(128))
PAGE_HEX = PAGE.hex().upper().encode()


# --- both ways ------------------------------------------------------------------------------------


def test_every_command_is_drawn() -> None:
    assert set(BY_COMMAND) == set(Command)


# --- requests that are none -----------------------------------------------------------------------


@each(
    ("command", "data", "why"),
    [
        (0x00, b"", "command 00 is not in the paper"),
        (0x4D, b"", "command 4D is not in the paper"),
        (0x51, b"0000", "command 51 is not in the paper"),
        (0x40, b"0", "1 more characters than expected"),
        (0x53, b"00", "2 more characters than expected"),
        (0x41, b"", "expected 1 .run. or 0 .stop."),
        (0x41, b"2", "expected 1 .run. or 0 .stop."),
        (0x41, b"11", "expected 1 .run. or 0 .stop."),
        (0x42, b"", "expected 1 disable, 2 enable, 3 set or 4 reset"),
        (0x42, b"5X0016", "expected 1 disable"),
        (0x42, b"1R00016", "expected a discrete"),
        (0x42, b"1X0016 ", "1 more characters than expected"),
        (0x42, b"1X016", "X: expected 4 decimal digits"),
        (0x43, b"0", "expected hex digits in pairs"),
        (0x43, b"", "expected hex digits in pairs"),
        (0x43, b"07", "expected an element at character 2"),
        (0x44, b"+1X0000", "expected hex digits"),
        (0x44, b" 1X0000", "expected hex digits"),
        (0x44, b"01x0000", "expected an element at character 2"),
        (0x44, b"01X+001", "expected 4 decimal digits"),
        (0x44, b"01X1_00", "expected 4 decimal digits"),
        (0x44, b"01X 001", "expected 4 decimal digits"),
        (0x44, b"01X00A0", "expected 4 decimal digits"),
        (0x44, "01X00²0".encode("latin-1"), "expected 4 decimal digits"),
        (0x44, b"01Q0000", "expected an element"),
        (0x44, b"01R00000", "expected a discrete"),
        (0x44, b"02X9999", "out of range"),
        (0x45, b"02Y00001", "expected 2 values, got 1"),
        (0x45, b"02Y0000101", "expected 2 values, got 3"),
        (0x45, b"02Y000012", "expected 0 or 1 for each discrete"),
        (0x45, b"00Y0000" + 255 * b"1", "expected 256 values, got 255"),
        (0x46, b"00R00000", "expected 1 or more elements, got 0"),
        (0x46, b"41R00000", "expected 1 to 64 elements, got 65"),
        (0x46, b"21DR00000", "expected 1 to 32 elements, got 33"),
        (0x46, b"01X0000", "expected a register or word"),
        (0x46, b"01WY0009", "multiple of 8"),
        (0x46, b"01R65536", "out of range"),
        (0x47, b"02R0000010A5", "expected 2 values, got 1"),
        (0x47, b"01R00000+0A5", "expected hex digits"),
        (0x47, b"01R00000 0A5", "expected hex digits"),
        (0x47, b"01R000001_0A", "expected hex digits"),
        (0x47, b"01R0000010A", "in pairs"),
        (0x47, b"01DR0000010A5", "expected values of 32 bits"),
        (0x48, b"00", "expected 1 to 64 words in total"),
        (0x48, b"02R00001", "expected an element at character 8"),
        (0x48, b"01R00001Y0009", "5 more characters than expected"),
        (0x48, b"21" + 33 * b"DR00000", "got 66"),
        (0x48, b"FF" + 255 * b"Y0000", "got 255"),
        (0x49, b"00", "expected 1 to 32 words in total"),
        (0x49, b"01R0000110A", "the value of R1 is incomplete"),
        (0x49, b"01Y00002", "expected 0 or 1"),
        (0x49, b"01R0000110A5F", "1 more characters than expected"),
        (0x49, b"21" + 33 * b"Y00001", "got 33"),
        (0x4E, 257 * b"x", "expected at most 256 characters, got 257"),
        (0x4F, b"", "expected a page number of 4 hex digits"),
        (0x4F, b"000", "in pairs"),
        (0x4F, b"00", "expected a page number of 4 hex digits"),
        (0x4F, b"00000", "1 more characters than expected"),
        (0x50, b"0000", "expected 128 bytes, got 0"),
        (0x50, b"0000" + PAGE_HEX[:-2], "expected 128 bytes, got 127"),
        (0x50, b"0000" + PAGE_HEX + b"00", "expected 128 bytes, got 129"),
    ],
)
def test_no_request(command: int, data: bytes, why: str) -> None:
    with pytest.raises(FrameError, match=why):
        DATA.parse_request(command, data)


# --- answers that are none ------------------------------------------------------------------------

X0, R0, DR0 = Element("X", 0), Element("R", 0), Element("DR", 0)
WRONG_ANSWERS: list[tuple[Request[Any], bytes, str]] = [
    (ReadBriefStatus(), b"", "expected 7 characters of data, got 0"),
    (ReadBriefStatus(), b"0", "expected 7 characters of data, got 1"),
    (ReadBriefStatus(), b"02900000", "expected 7 characters of data, got 8"),
    (ReadBriefStatus(), b"1290000", "expected the error character 0"),
    (ReadBriefStatus(), b"0+29000", "expected hex digits"),
    (RunStop(run=True), b"", "answer to RUN: expected 1 characters of data, got 0"),
    (RunStop(run=False), b"00", "answer to STOP: expected 1 characters"),
    (RunStop(run=True), b"x", "expected the error character 0"),
    (ReadDiscretes(X0, 6), b"001011", "expected 7 characters of data, got 6"),
    (ReadDiscretes(X0, 6), b"00101101", "expected 7 characters of data, got 8"),
    (ReadDiscretes(X0, 6), b"0010112", "expected 0 or 1"),
    (ReadDiscretes(X0, 6), b"001011 ", "expected 0 or 1"),
    (ReadDisabled(X0, 256), b"0", "expected 257 characters of data, got 1"),
    (ReadRegisters(R0, 1), b"010A", "answer to read registers R0: expected 5 characters of data, got 4"),
    (ReadRegisters(R0, 1), b"0+0A5", "expected hex digits"),
    (ReadRegisters(R0, 1), b"01_0A", "expected hex digits"),
    (ReadRegisters(R0, 1), b"0 0A5", "expected hex digits"),
    (ReadRegisters(DR0, 1), b"010A5", "expected 9 characters of data, got 5"),
    (ReadMixed((R0, X0)), b"010A52", "expected 0 or 1"),
    (ReadMixed((R0, X0)), b"010A5", "expected 6 characters of data, got 5"),
    (ReadPage(5), PAGE_HEX[:-1], "expected 257 characters of data, got 255"),
    (ReadPage(5), b"0" + PAGE_HEX[:-2], "answer to read program page 5: expected 257 characters"),
    (ReadPage(5), b"00" + PAGE_HEX, "expected 257 characters of data, got 258"),
    (ReadPage(5), b"4" + PAGE_HEX, "expected the error character 0"),
    (ReadDetailedStatus(), 127 * b"0", "expected 129 characters of data, got 127"),
    (ReadDetailedStatus(), 130 * b"0", "expected 129 characters of data, got 130"),
    (ReadDetailedStatus(), b"F" + 128 * b"0", "expected the error character 0"),
    (WriteRegisters(R0, (1,)), b"01", "expected 1 characters of data, got 2"),
    (WritePage(0, PAGE), b"", "expected 1 characters of data, got 0"),
]


@each(("request_", "data", "why"), WRONG_ANSWERS)
def test_no_answer(request_: Request[Any], data: bytes, why: str) -> None:
    with pytest.raises(FrameError, match=why):
        DATA.parse_answer(request_, data)


def test_a_page_with_and_without_the_error_character() -> None:
    assert DATA.parse_answer(ReadPage(0), b"0" + PAGE_HEX) == PAGE
    assert DATA.parse_answer(ReadPage(0), PAGE_HEX) == PAGE
    zeros = bytes(128)
    assert DATA.parse_answer(ReadPage(0), 257 * b"0") == zeros
    assert DATA.parse_answer(ReadPage(0), 256 * b"0") == zeros
    assert DATA.answer_data(ReadPage(0), PAGE) == b"0" + PAGE_HEX


def test_detailed_status_with_and_without_the_error_character() -> None:
    written = FBE_28MC_BYTES.hex().upper().encode()
    status = DetailedStatus.parse(FBE_28MC_BYTES)
    assert DATA.parse_answer(ReadDetailedStatus(), b"0" + written) == status
    assert DATA.parse_answer(ReadDetailedStatus(), written) == status
    assert DATA.answer_data(ReadDetailedStatus(), status) == b"0" + written


# --- error codes ----------------------------------------------------------------------------------


def requests_that_can_be_refused() -> list[Request[Any]]:
    return [
        *(example.request for example in EXAMPLES),
        RunStop(run=False),
        Loopback(b""),
        ReadPage(5),
        WritePage(5, PAGE),
    ]


@each("request_", requests_that_can_be_refused(), ids=asked)
@each("code", range(1, 16))
def test_error_codes(request_: Request[Any], code: int) -> None:
    with pytest.raises(PlcRefused) as caught:
        DATA.parse_answer(request_, b"%X" % code)
    refused = caught.value
    assert (refused.code, refused.command) == (code, request_.command)
    assert refused.details == {"code": f"{code:X}", "command": f"{request_.command:02X}"}
    meaning = MEANINGS.get(code, "a code that no paper lists")
    assert refused.message.endswith(f"({request_.command:02X}): error {code:X}, {meaning}")
    assert refused.message.startswith(f"the PLC refused to {asked(request_)} ")


def test_the_papers_codes() -> None:
    assert set(MEANINGS) == {2, 3, 4, 5, 6, 7, 9, 0xA}
    for code, word in {
        2: "illegal value",
        3: "ROM pack",
        4: "format or command",
        5: "checksum",
        6: "ID",
        7: "syntax",
        9: "not supported",
        0xA: "illegal address",
    }.items():
        assert word in MEANINGS[code]


@pytest.mark.parametrize("code", [3, 5, 6, 7, 9, 0xA])
def test_a_code_with_a_cure_says_it(code: int) -> None:
    assert refusal(code, Command.RUN_STOP, "RUN").hint


@pytest.mark.parametrize("code", [2, 4, 0xA])
@pytest.mark.parametrize("command", [Command.READ_PAGE, Command.WRITE_PAGE])
def test_a_plc_without_program_commands(code: int, command: Command) -> None:
    assert refusal(code, command, "read program page 0").hint == PROGRAM_REFUSED


def test_an_unknown_code_is_shown_as_a_code() -> None:
    refused = refusal(0xB, Command.RUN_STOP, "RUN")
    assert refused.message == "the PLC refused to RUN (41): error B, a code that no paper lists"
    assert refused.hint is None


@pytest.mark.parametrize("data", [b"g", b"G", b"+", b" ", b"\x00", b"\xff", b"04", b"4 "])
def test_an_error_character_is_one_hex_digit(data: bytes) -> None:
    for request in requests_that_can_be_refused():
        if request.command != Command.LOOPBACK:
            with pytest.raises(FrameError):
                DATA.parse_answer(request, data)


SMALL: list[tuple[Request[Any], bytes, object]] = [
    (ReadBriefStatus(), b"02900a0", BriefStatus.parse(bytes.fromhex("2900A0"))),
    (ReadRegisters(R0, 1), b"010a5", (0x10A5,)),
    (ReadRegisters(DR0, 1), b"0ffFFfffe", (0xFFFFFFFE,)),
    (ReadMixed((R0, X0)), b"0ab0f1", (0xAB0F, 1)),
    (ReadPage(5), b"0" + PAGE_HEX.lower(), PAGE),
    (ReadPage(5), PAGE_HEX.lower(), PAGE),
]


@each(("request_", "data", "answer"), SMALL)
def test_small_hex_digits_of_an_answer_are_read(request_: Request[Any], data: bytes, answer: object) -> None:
    assert DATA.parse_answer(request_, data) == answer


def test_a_small_error_character_is_read() -> None:
    with pytest.raises(PlcRefused, match="error A, illegal address"):
        DATA.parse_answer(ReadRegisters(R0, 1), b"a")


def test_small_hex_digits_of_a_request_are_read() -> None:
    assert DATA.parse_request(0x47, b"01R0000010a5") == WriteRegisters(R0, (0x10A5,))
    assert DATA.parse_request(0x44, b"0aX0000") == ReadDiscretes(X0, 10)
    assert DATA.parse_request(0x4F, b"00c0") == ReadPage(0xC0)


def test_loopback_has_no_error_character() -> None:
    assert DATA.parse_answer(Loopback(b"4"), b"4") == b"4"
    assert DATA.parse_answer(Loopback(b"0"), b"0") == b"0"
    assert DATA.parse_answer(Loopback(b""), b"") == b""
    assert DATA.parse_answer(Loopback(b"AB"), b"AC") == b"AC"  # the link tells nonces apart
    with pytest.raises(PlcRefused):
        DATA.parse_answer(Loopback(b"AB"), b"4")


# --- echoes ---------------------------------------------------------------------------------------


@each(
    ("request_", "passes"),
    [
        (ReadBriefStatus(), False),
        (RunStop(run=False), True),  # 0 is the good answer
        (RunStop(run=True), True),  # 1 is an error code, though in no paper
    ]
    + [
        (example.request, example.request.command in {Command.RUN_STOP, Command.LOOPBACK})
        for example in EXAMPLES
    ]
    + [
        (Loopback(b""), True),
        (Loopback(b"4"), True),
        (Loopback(b"x" * 256), True),
        (ReadDetailedStatus(), False),
        (ReadPage(0), False),
        (WritePage(0, bytes(128)), False),
        (ReadDiscretes(Element("C", 0), 6), False),  # 7 characters asked and answered
        (ReadRegisters(Element("D", 0), 2), False),
        (ReadRegisters(Element("DR", 0), 1), False),  # 9 and 9, but R is not a hex digit
        (ReadRegisters(Element("DD", 12), 1), True),  # 9 and 9: 0 1DD00012
        (ReadRegisters(Element("DD", 12), 2), False),
        (ReadMixed((Element("DD", 12),)), True),
        (ReadMixed((Element("DD", 65534),)), True),
        (ReadMixed((Element("DR", 12),)), False),
        (ReadMixed((Element("D", 1), *3 * (Element("DD", 12),))), True),  # 29 and 29
        (ReadMixed((Element("DD", 1), Element("DD", 3))), False),
        (WriteDiscretes(Element("Y", 0), (False,)), False),
        (WriteMixed(((Element("D", 0), 0),)), False),
        (WriteRegisters(Element("DD", 0), (0,)), False),
    ],
)
def test_echoes_that_would_pass(request_: Request[Any], passes: bool) -> None:
    assert FACON.echo_may_pass(request_) is passes


# --- words ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        (RunStop(run=True), "RUN"),
        (RunStop(run=False), "STOP"),
        (ReadPage(0), "read program page 0"),
        (WritePage(5, PAGE), "write program page 5"),
        (ReadRegisters(Element("R", 12), 3), "read registers R12"),
        (EXAMPLES[2].request, "control one discrete X16"),
        (ReadMixed((R0,)), "read mixed elements"),
        (ReadDetailedStatus(), "read detailed status"),
    ],
)
def test_asked(request_: Request[Any], words: str) -> None:
    assert asked(request_) == words
