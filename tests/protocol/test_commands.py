"""The limits of each command, at their edge and one past it: a request that cannot be is never made."""

from __future__ import annotations

from typing import Any

import pytest

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.commands import (
    COMMAND_WORDS,
    Command,
    Control,
    ControlDiscrete,
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
from fatektool.protocol.fatek.facon.codec import FACON, frame_bytes
from fatektool.protocol.fatek.mseries.codec import MSERIES
from tests.protocol.decoding import one_frame, query, request_of

X0, Y0, R0, DR0, WM0, DWM0 = (Element.parse(text) for text in ("X0", "Y0", "R0", "DR0", "WM0", "DWM0"))
PAGE = bytes(range(128))


def run(first: Element, count: int) -> tuple[Element, ...]:
    return tuple(first.after(place) for place in range(count))


def items(*runs: tuple[Element, ...]) -> tuple[tuple[Element, int], ...]:
    return tuple((element, 1) for elements in runs for element in elements)


def test_codes_and_words() -> None:
    assert [f"{command:02X}" for command in Command] == (
        ["40", "41", "42", "43", "44", "45", "46", "47", "48", "49", "4E", "4F", "50", "53"]
    )
    assert set(COMMAND_WORDS) == set(Command)
    assert Command.READ_PAGE.words == "read program page"


def test_which_requests_change_something() -> None:
    writing: list[type[Request[Any]]] = [
        RunStop,
        ControlDiscrete,
        WriteDiscretes,
        WriteRegisters,
        WriteMixed,
        WritePage,
    ]
    reading: list[type[Request[Any]]] = [
        ReadBriefStatus,
        ReadDisabled,
        ReadDiscretes,
        ReadRegisters,
        ReadMixed,
        Loopback,
        ReadPage,
        ReadDetailedStatus,
    ]
    assert all(request.writes for request in writing)
    assert not any(request.writes for request in reading)
    assert {request.command for request in [*writing, *reading]} == set(Command)


# --- 42 to 45 -------------------------------------------------------------------------------------


@pytest.mark.parametrize("wrong", [R0, WM0, DWM0, DR0], ids=str)
def test_discretes_only(wrong: Element) -> None:
    expected = rf"expected a discrete \(X Y M S T C\), got {wrong}"
    for make in (ReadDisabled, ReadDiscretes):
        with pytest.raises(UsageError, match=expected):
            make(wrong, 1)
    with pytest.raises(UsageError, match=expected):
        WriteDiscretes(wrong, (True,))
    with pytest.raises(UsageError, match=expected):
        ControlDiscrete(Control.SET, wrong)


def too_long(request: Request[Any], expected: str) -> None:
    """How long a run may be is the protocol's to say: it refuses to write the request, or to read it."""
    for codec in (FACON, MSERIES):
        with pytest.raises(UsageError, match=expected):
            codec.encode(1, request)


@pytest.mark.parametrize("count", [0, -1])
def test_a_run_is_of_one_element_at_least(count: int) -> None:
    for make in (ReadDisabled, ReadDiscretes):
        with pytest.raises(UsageError, match=rf"from X0: expected 1 or more elements, got {count}"):
            make(X0, count)
    with pytest.raises(UsageError, match="from Y0: expected 1 or more elements, got 0"):
        WriteDiscretes(Y0, ())
    with pytest.raises(UsageError, match="from R0: expected 1 or more elements, got 0"):
        WriteRegisters(R0, ())


def test_how_many_discretes() -> None:
    for make in (ReadDisabled, ReadDiscretes):
        assert FACON.encode(1, make(X0, 256))
        too_long(make(X0, 257), "from X0: expected 1 to 256 elements, got 257")
    assert FACON.encode(1, WriteDiscretes(Y0, (True,) * 256))
    too_long(WriteDiscretes(Y0, (True,) * 257), "expected 1 to 256 elements, got 257")


def test_a_frame_of_more_than_that_is_no_request() -> None:
    with pytest.raises(FrameError, match="expected 1 to 64 elements, got 65"):
        request_of(one_frame(frame_bytes(1, 0x46, b"41R00000")))
    with pytest.raises(FrameError, match="expected 1 to 64 elements, got 65"):
        request_of(one_frame(query("01 46 41 52 00 00"), MSERIES), MSERIES)


def test_256_is_written_00() -> None:
    assert FACON.encode(1, ReadDiscretes(X0, 256))[3:-3] == b"4400X0000"
    assert FACON.encode(1, ReadDiscretes(X0, 255))[3:-3] == b"44FFX0000"
    assert FACON.encode(1, ReadDisabled(X0, 256))[3:-3] == b"4300X0000"
    raw = FACON.encode(1, WriteDiscretes(Y0, (True, False) * 128))
    assert raw[3:-3] == b"4500Y0000" + b"10" * 128
    most: list[Request[Any]] = [
        ReadDiscretes(X0, 256),
        ReadDisabled(X0, 256),
        WriteDiscretes(Y0, (True,) * 256),
    ]
    for request in most:
        assert request_of(one_frame(FACON.encode(1, request))) == request


def test_a_run_ends_within_its_kind() -> None:
    assert ReadDiscretes(Element("X", 9744), 256).count == 256
    with pytest.raises(UsageError, match="X10000: address out of range: expected 0 to 9999"):
        ReadDiscretes(Element("X", 9745), 256)
    with pytest.raises(UsageError, match="R65536: address out of range"):
        ReadRegisters(Element("R", 65535), 2)
    with pytest.raises(UsageError, match="DR65535: address out of range"):
        WriteRegisters(Element("DR", 65533), (0, 0))


# --- 46 and 47 ------------------------------------------------------------------------------------


@pytest.mark.parametrize("first", [R0, WM0, Element("RT", 0), Element("D", 0)], ids=str)
def test_64_words_of_16_bits(first: Element) -> None:
    assert FACON.encode(1, ReadRegisters(first, 64))[5:7] == b"40"
    assert len(FACON.encode(1, WriteRegisters(first, (0xFFFF,) * 64))) == 8 + 2 + 6 + 256
    too_long(ReadRegisters(first, 65), "expected 1 to 64 elements, got 65")
    too_long(WriteRegisters(first, (0,) * 65), "expected 1 to 64 elements, got 65")


@pytest.mark.parametrize("first", [DR0, DWM0, Element("DRC", 0), Element("DD", 0)], ids=str)
def test_32_words_of_32_bits(first: Element) -> None:
    assert FACON.encode(1, ReadRegisters(first, 32))[5:7] == b"20"
    assert len(FACON.encode(1, WriteRegisters(first, (0xFFFFFFFF,) * 32))) == 8 + 2 + 7 + 256
    too_long(ReadRegisters(first, 33), "expected 1 to 32 elements, got 33")
    too_long(WriteRegisters(first, (0,) * 33), "expected 1 to 32 elements, got 33")


def test_registers_only() -> None:
    with pytest.raises(UsageError, match="expected a register or word, got X0"):
        ReadRegisters(X0, 1)
    with pytest.raises(UsageError, match="expected a register or word, got X0"):
        WriteRegisters(X0, (1,))


@pytest.mark.parametrize(("element", "last"), [(Y0, 1), (R0, 0xFFFF), (DR0, 0xFFFFFFFF)], ids=str)
def test_values(element: Element, last: int) -> None:
    for value in (0, last):
        WriteMixed(((element, value),))
    for value in (-1, last + 1):
        with pytest.raises(UsageError, match=f"{element}: expected a value of 0 to {last}, got {value}"):
            WriteMixed(((element, value),))


def test_a_wrong_value_is_named_by_its_own_element() -> None:
    with pytest.raises(UsageError, match=r"^WY24: expected a value of 0 to 65535, got 65536"):
        WriteRegisters(Element("WY", 8), (0, 65536))
    with pytest.raises(UsageError, match=r"^DR2: expected a value of 0 to 4294967295, got -1"):
        WriteRegisters(DR0, (0, -1))


# --- 48 and 49 ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "elements",
    [
        run(X0, 64),
        run(R0, 64),
        run(WM0, 64),
        run(DR0, 32),
        run(DR0, 20) + run(X0, 12) + run(R0, 12),  # the paper's: 20 of 32 bits leave 24
    ],
)
def test_64_words_to_read(elements: tuple[Element, ...]) -> None:
    request = ReadMixed(elements)
    assert request_of(one_frame(FACON.encode(1, request))) == request
    with pytest.raises(UsageError, match=r"expected 1 to 64 words in total .*, got 65"):
        ReadMixed((*elements, Y0))
    with pytest.raises(UsageError, match=r"expected 1 to 64 words in total .*, got 66"):
        ReadMixed((*elements, DWM0))


@pytest.mark.parametrize(
    "writes",
    [items(run(Y0, 32)), items(run(R0, 32)), items(run(DR0, 16)), items(run(DR0, 10), run(Y0, 12))],
)
def test_32_words_to_write(writes: tuple[tuple[Element, int], ...]) -> None:
    request = WriteMixed(writes)
    assert request_of(one_frame(FACON.encode(1, request))) == request
    with pytest.raises(UsageError, match=r"expected 1 to 32 words in total .*, got 33"):
        WriteMixed((*writes, (R0, 0)))


def test_nothing_mixed() -> None:
    with pytest.raises(UsageError, match="expected 1 to 64 words"):
        ReadMixed(())
    with pytest.raises(UsageError, match="expected 1 to 32 words"):
        WriteMixed(())


# --- 4E -------------------------------------------------------------------------------------------


def test_loopback_lengths() -> None:
    assert FACON.encode(1, Loopback(b"")) == b"\x02014EDC\x03"
    assert len(FACON.encode(1, Loopback(b"x" * 256))) == 264
    with pytest.raises(UsageError, match="expected at most 256 characters, got 257"):
        Loopback(b"x" * 257)


@pytest.mark.parametrize("byte", [b"\x02", b"\x03"])
def test_a_frame_cannot_hold_its_own_ends(byte: bytes) -> None:
    with pytest.raises(UsageError, match=r"expected no STX \(02\) and no ETX"):
        FACON.encode(1, Loopback(b"AB" + byte + b"CD"))


def test_every_other_character_loops_back() -> None:
    data = bytes(byte for byte in range(256) if byte not in {2, 3})
    frame = one_frame(FACON.encode(1, Loopback(data)))
    assert frame.data == data
    assert FACON.parse_answer(Loopback(data), frame) == data


# --- 4F and 50 ------------------------------------------------------------------------------------


def test_page_numbers() -> None:
    assert FACON.encode(1, ReadPage(0))[3:-3] == b"4F0000"
    assert FACON.encode(1, ReadPage(206))[3:-3] == b"4F00CE"
    assert FACON.encode(1, ReadPage(65535))[3:-3] == b"4FFFFF"
    for page in (-1, 65536):
        with pytest.raises(UsageError, match=f"program page: expected 0 to 65535, got {page}"):
            ReadPage(page)
        with pytest.raises(UsageError, match=f"program page: expected 0 to 65535, got {page}"):
            WritePage(page, PAGE)


def test_page_bytes() -> None:
    assert FACON.encode(1, WritePage(128, PAGE))[3:-3] == b"500080" + PAGE.hex().upper().encode()
    for size in (0, 127, 129):
        with pytest.raises(UsageError, match=f"program page 5: expected 128 bytes, got {size}"):
            WritePage(5, bytes(size))


# --- the frame ------------------------------------------------------------------------------------


def test_stations() -> None:
    assert FACON.encode(0, RunStop(run=False))[1:3] == b"00"
    assert FACON.encode(10, RunStop(run=False))[1:3] == b"0A"
    assert FACON.encode(254, RunStop(run=False))[1:3] == b"FE"
    assert FACON.encode(255, RunStop(run=False))[1:3] == b"FF"  # in no paper, and used
    for station in (-1, 256):
        with pytest.raises(UsageError, match=f"station: expected 0 to 255, got {station}"):
            FACON.encode(station, RunStop(run=False))


def test_500_characters_of_data() -> None:
    raw = frame_bytes(1, 0x4E, b"x" * 500)
    assert len(raw) == 508
    assert one_frame(raw).data == b"x" * 500
    with pytest.raises(UsageError, match="expected at most 500 characters, got 501"):
        frame_bytes(1, 0x4E, b"x" * 501)


def test_the_largest_of_each_fits_a_frame() -> None:
    largest: list[Request[Any]] = [
        WriteDiscretes(Y0, (True,) * 256),
        WriteRegisters(R0, (0,) * 64),
        ReadMixed(run(R0, 64)),
        WriteMixed(items(run(R0, 32))),
        WritePage(0, PAGE),
        Loopback(b"x" * 256),
    ]
    assert [len(FACON.encode(1, request)) for request in largest] == [271, 272, 394, 330, 268, 264]
    assert FACON.answer_bytes(ReadMixed(run(R0, 64))) == 265
