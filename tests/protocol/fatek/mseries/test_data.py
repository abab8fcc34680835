"""M-series data fields: what is none, error codes, and symbols that nothing ends."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given

from fatektool.errors import FrameError, PlcRefused, UsageError
from fatektool.protocol.commands import (
    Loopback,
    ReadBriefStatus,
    ReadDetailedStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadRegisters,
    Request,
    RunStop,
    WriteMixed,
    WriteRegisters,
)
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.fatek.mseries.bytes import BINARY
from fatektool.protocol.fatek.mseries.codec import MSERIES
from fatektool.protocol.fatek.mseries.data import DATA
from fatektool.protocol.fatek.mseries.errors import MEANINGS
from fatektool.protocol.plc_errors import asked
from fatektool.protocol.status import BriefStatus, DetailedStatus, RawStatus, StatusFlags
from tests.protocol.decoding import query, response
from tests.protocol.fatek.mseries.vectors import EXAMPLES, PAYLOADS
from tests.protocol.strategies import elements
from tests.protocol.vectors import FBE_28MC, FBE_28MC_BYTES
from tests.rows import each

# --- elements -------------------------------------------------------------------------------------

SYMBOLS = {
    "X": "58", "Y": "59", "M": "4D", "S": "53", "T": "54", "C": "43",
    "WX": "57 58", "WY": "57 59", "WM": "57 4D", "WS": "57 53", "WT": "57 54", "WC": "57 43",
    "RT": "52 54", "RC": "52 43", "R": "52", "D": "44", "F": "46",
    "DWX": "44 57 58", "DWY": "44 57 59", "DWM": "44 57 4D",
    "DWS": "44 57 53", "DWT": "44 57 54", "DWC": "44 57 43",
    "DRT": "44 52 54", "DRC": "44 52 43", "DR": "44 52", "DD": "44 44", "DF": "44 46",
}  # fmt: skip
"""The paper's table, section 2.4."""


def test_the_table_is_whole() -> None:
    assert set(SYMBOLS) == set(KINDS)


@each("symbol", SYMBOLS)
def test_symbols(symbol: str) -> None:
    for address in (0, 8, KINDS[symbol].last):
        one = Element(symbol, address)
        raw = bytes.fromhex(SYMBOLS[symbol]) + address.to_bytes(2, "big")
        assert BINARY.element(one) == raw
        assert BINARY.take_element(b"\7" + raw + b"\x52", 1) == (one, 1 + len(raw))
        assert BINARY.element_size(one) == len(raw)


@given(elements(KINDS))
def test_an_element_is_read_as_it_was_sent_or_not_sent(element: Element) -> None:
    try:
        raw = BINARY.element(element)
    except UsageError:
        return
    assert BINARY.take_element(raw, 0) == (element, len(raw))


def test_exactly_the_ambiguous_ones_are_refused() -> None:
    """R, D and DR with an address that goes on like a longer symbol; every other element can be sent."""
    refused: set[str] = set()
    for symbol, kind in KINDS.items():
        for address in range(0, kind.last + 1, kind.step):
            element = Element(symbol, address)
            try:
                BINARY.element(element)
            except UsageError:
                refused.add(str(element))
    timers, counters = range(0x5400, 0x5500), range(0x4300, 0x4400)
    expected = {f"{symbol}{address}" for symbol in ("R", "DR") for address in (*timers, *counters)}
    for letter in b"RDF":
        expected |= {f"D{address}" for address in range(letter << 8, (letter + 1) << 8)}
    expected |= {f"D{0x57 << 8 | letter}" for letter in b"XYMSTC"}
    assert refused == expected


def test_the_refusal_says_why() -> None:
    with pytest.raises(UsageError) as caught:
        MSERIES.encode(1, ReadRegisters(Element("D", 22360), 1))
    assert caught.value.message == ("D22360 cannot be sent in mseries: its bytes 44 57 58 begin like DWX")
    run = ReadRegisters(Element("D", 22350), 20)  # the same register, within a run
    assert DATA.request_data(run) == bytes.fromhex("14 44 57 4E")


def test_the_longest_symbol_is_taken() -> None:
    assert DATA.parse_request(0x46, bytes.fromhex("01 44 57 58 00 10")) == ReadRegisters(
        Element("DWX", 16), 1
    )
    assert DATA.parse_request(0x46, bytes.fromhex("01 44 52 00 10")) == ReadRegisters(Element("DR", 16), 1)
    assert DATA.parse_request(0x46, bytes.fromhex("01 44 00 52")) == ReadRegisters(Element("D", 0x52), 1)


# --- requests that are none -----------------------------------------------------------------------


@each(
    ("command", "data", "why"),
    [
        (0x00, "", "command 00 is not in the M-series paper"),
        (0x4F, "00 00", "command 4F is not in the M-series paper"),
        (0x50, "00 00", "command 50 is not in the M-series paper"),
        (0x40, "00", "1 more bytes than expected"),
        (0x53, "00 00", "2 more bytes than expected"),
        (0x41, "", "expected 01 .run. or 00 .stop."),
        (0x41, "02", "expected 01 .run. or 00 .stop."),
        (0x41, "01 01", "expected 01 .run. or 00 .stop."),
        (0x42, "", "expected 01 disable, 02 enable, 03 set or 04 reset"),
        (0x42, "00 58 00 10", "expected 01 disable"),  # the paper's second table counts from 00
        (0x42, "05 58 00 10", "expected 01 disable"),
        (0x42, "01 52 00 10", "expected a discrete"),
        (0x42, "01 58 00 10 00", "1 more bytes than expected"),
        (0x42, "01 58 00", "X: expected an address of 2 bytes"),
        (0x43, "", "expected a number of elements"),
        (0x43, "07", "expected an element at byte 1"),
        (0x44, "01 78 00 00", "expected an element at byte 1"),
        (0x44, "01 57 00 00", "expected an element at byte 1"),
        (0x44, "01 52 00 00", "expected a discrete"),
        (0x44, "02 58 27 0F", "out of range"),
        (0x45, "02 59 00 00 01", "expected 2 values, got 1"),
        (0x45, "02 59 00 00 01 00 01", "expected 2 values, got 3"),
        (0x45, "01 59 00 00 02", "expected 00 or 01 for each discrete"),
        (0x45, "00 59 00 00" + 255 * "01", "expected 256 values, got 255"),
        (0x46, "00 52 00 00", "expected 1 or more elements, got 0"),
        (0x46, "41 52 00 00", "expected 1 to 64 elements, got 65"),
        (0x46, "21 44 52 00 00", "expected 1 to 32 elements, got 33"),
        (0x46, "01 58 00 00", "expected a register or word"),
        (0x46, "01 57 59 00 09", "multiple of 8"),
        (0x46, "01 44 57 58", "DWX: expected an address of 2 bytes"),
        (0x46, "02 52 FF FF", "out of range"),
        (0x47, "02 52 00 00 10 A5", "expected 2 values, got 1"),
        (0x47, "01 52 00 00 10", "expected values of 16 bits"),
        (0x47, "01 44 52 00 00 10 A5", "expected values of 32 bits"),
        (0x48, "00", "expected 1 to 64 words in total"),
        (0x48, "02 52 00 01", "expected an element at byte 4"),
        (0x48, "01 52 00 01 59 00 09", "3 more bytes than expected"),
        (0x48, "21" + 33 * "44 52 00 00", "got 66"),
        (0x48, "FF" + 255 * "59 00 00", "got 255"),
        (0x49, "00", "expected 1 to 32 words in total"),
        (0x49, "01 52 00 01 0A", "the value of R1 is incomplete"),
        (0x49, "01 59 00 00 02", "expected 00 or 01"),
        (0x49, "01 52 00 01 10 A5 FF", "1 more bytes than expected"),
        (0x49, "21" + 33 * "59 00 00 01", "got 33"),
        (0x4E, 257 * "78", "expected at most 256 characters, got 257"),
    ],
)
def test_no_request(command: int, data: str, why: str) -> None:
    with pytest.raises(FrameError, match=why):
        DATA.parse_request(command, bytes.fromhex(data))


# --- answers that are none ------------------------------------------------------------------------

X0, R0, DR0, DF8 = Element("X", 0), Element("R", 0), Element("DR", 0), Element("DF", 8)


@each(
    ("request_", "data", "why"),
    [
        (ReadBriefStatus(), "", "expected 4 bytes of data, got 0"),
        (ReadBriefStatus(), "00", "expected 4 bytes of data, got 1"),
        (ReadBriefStatus(), "29 00 00", "expected 4 bytes of data, got 3"),
        (ReadBriefStatus(), "01 29 00 00", "expected the error byte 00 before the data, got 01"),
        (RunStop(run=True), "", "answer to RUN: expected 1 bytes of data, got 0"),
        (RunStop(run=False), "00 00", "answer to STOP: expected 1 bytes"),
        (ReadDiscretes(X0, 6), "00 01 00 01 01 00", "expected 7 bytes of data, got 6"),
        (ReadDiscretes(X0, 6), "00 00 01 00 01 01 02", "expected 00 or 01"),
        (ReadDisabled(X0, 256), "00", "expected 257 bytes of data, got 1"),
        (ReadRegisters(R0, 1), "00 10", "answer to read registers R0: expected 3 bytes of data, got 2"),
        (ReadRegisters(DR0, 1), "00 10 A5", "expected 5 bytes of data, got 3"),
        (ReadRegisters(DF8, 1), "01 00 00 00 00", "expected the error byte 00"),
        (ReadMixed((R0, X0)), "00 10 A5 02", "expected 00 or 01"),
        (ReadMixed((R0, X0)), "00 10 A5", "expected 4 bytes of data, got 3"),
        (WriteRegisters(R0, (1,)), "00 01", "expected 1 bytes of data, got 2"),
        (ReadDetailedStatus(), "", "expected 65 bytes of data, got 0"),
        (ReadDetailedStatus(), "04 00", "expected the error byte 00 before the data, got 04"),
    ],
)
def test_no_answer(request_: Request[Any], data: str, why: str) -> None:
    with pytest.raises(FrameError, match=why):
        DATA.parse_answer(request_, bytes.fromhex(data))


@each("request_", [example.request for example in EXAMPLES + PAYLOADS] + [Loopback(b"")], ids=asked)
@each("code", [*range(1, 16), 0x55, 0xFF])
def test_error_codes(request_: Request[Any], code: int) -> None:
    with pytest.raises(PlcRefused) as caught:
        DATA.parse_answer(request_, bytes([code]))
    assert (caught.value.code, caught.value.command) == (code, request_.command)
    meaning = MEANINGS.get(code, "a code that the M-series paper does not list")
    assert caught.value.message.endswith(f"({request_.command:02X}): error {code:X}, {meaning}")


def test_loopback_has_no_error_byte() -> None:
    assert DATA.parse_answer(Loopback(b"\4"), b"\4") == b"\4"
    assert DATA.parse_answer(Loopback(b"\0"), b"\0") == b"\0"
    assert DATA.parse_answer(Loopback(b""), b"") == b""
    assert DATA.parse_answer(Loopback(b"AB"), b"AC") == b"AC"  # the link tells nonces apart
    with pytest.raises(PlcRefused):
        DATA.parse_answer(Loopback(b"AB"), b"\4")


# --- limits ---------------------------------------------------------------------------------------


def test_256_is_written_as_zero() -> None:
    assert DATA.request_data(ReadDiscretes(X0, 256)) == bytes.fromhex("00 58 00 00")
    assert DATA.request_data(ReadDiscretes(X0, 255)) == bytes.fromhex("FF 58 00 00")
    assert DATA.parse_answer(ReadDiscretes(X0, 256), bytes(257)) == (False,) * 256
    assert MSERIES.answer_bytes(ReadDisabled(X0, 256)) == 8 + 2 + 1 + 256


def test_file_registers() -> None:
    request = WriteMixed(((Element("F", 3), 7), (DF8, 70000)))
    assert MSERIES.encode(1, request) == query("01 49 02 46 00 03 00 07 44 46 00 08 00 01 11 70")


# --- status ---------------------------------------------------------------------------------------


def test_brief_status_reserves_what_facon_names_a_model_by() -> None:
    found = DATA.parse_answer(ReadBriefStatus(), bytes.fromhex("00 29 FF 54"))
    assert found == BriefStatus(StatusFlags.parse(0x29), 0xFF, 0x54, m_series=True)
    assert found.model is None
    assert found.flags.running
    assert found.flags.rom_pack  # the memory card's bit
    assert found.flags.id_set


def test_a_detailed_status_of_64_bytes_is_assumed_to_be_facons() -> None:
    found = DATA.parse_answer(ReadDetailedStatus(), b"\0" + FBE_28MC_BYTES)
    assert isinstance(found, DetailedStatus)
    assert found.assumed
    assert found == DetailedStatus(FBE_28MC.flags, FBE_28MC.system, FBE_28MC_BYTES, assumed=True)
    assert DATA.answer_data(ReadDetailedStatus(), found) == b"\0" + FBE_28MC_BYTES


@pytest.mark.parametrize("size", [0, 1, 3, 63, 65, 128, 450])
def test_any_other_detailed_status_is_kept_raw(size: int) -> None:
    status = RawStatus(bytes(range(256))[:200].ljust(size, b"\7")[:size])
    raw = MSERIES.encode_answer(1, ReadDetailedStatus(), status)
    assert raw == response("01 53 00" + status.raw.hex())
    assert DATA.parse_answer(ReadDetailedStatus(), raw[6:-4]) == status
