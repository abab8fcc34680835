"""M-series frames: cut by their length, whatever stands in them, before them and behind them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.commands import Loopback, ReadRegisters, RunStop
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.mseries.codec import MAX_FRAME, MSERIES, frame_bytes, parse_frame
from fatektool.protocol.fatek.mseries.crc import crc16, crc_bytes
from tests.protocol.decoding import crc, decoded, drained, frames, query, response, sealed
from tests.protocol.fatek.mseries.vectors import EXAMPLES, FRAMES

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request

STATUS, RUNNING = EXAMPLES[0].asks, EXAMPLES[0].answers


def raws(*chunks: bytes) -> list[bytes]:
    """The good frames, as they came."""
    return [frame.raw for frame in frames(chunks, MSERIES)]


# --- CRC ------------------------------------------------------------------------------------------


def test_the_known_check_value() -> None:
    assert crc16(b"123456789") == 0x4B37
    assert crc16(b"") == 0xFFFF


@pytest.mark.parametrize("raw", FRAMES)
def test_the_papers_crcs(raw: bytes) -> None:
    assert crc_bytes(raw[2:-4]) == raw[-4:-2] == crc(raw[2:-4])


@given(st.binary(max_size=460))
def test_the_table_does_what_the_paper_says(data: bytes) -> None:
    assert crc_bytes(data) == crc(data)


# --- lengths --------------------------------------------------------------------------------------


@given(st.sampled_from([0x51, 0x52]), st.integers(0, 254), st.integers(0, 255), st.binary(max_size=451))
def test_frame_round_trip(header: int, station: int, command: int, data: bytes) -> None:
    raw = frame_bytes(header, station, command, data)
    frame = parse_frame(raw)
    assert (frame.station, frame.command, frame.data, frame.raw) == (station, command, data, raw)
    assert raw == sealed(header, bytes([station, command]) + data)


def test_461_bytes_pass_and_462_do_not() -> None:
    longest, longer = sealed(0x52, b"\x01\x53" + 451 * b"x"), sealed(0x52, b"\x01\x53" + 452 * b"x")
    assert len(longest) == MAX_FRAME == 461
    for raw, passes in ((longest, True), (longer, False)):
        for chunks in ([raw], [bytes([byte]) for byte in raw]):
            assert raws(*chunks, STATUS) == [raw] * passes + [STATUS]
    with pytest.raises(UsageError, match="at most 451 bytes, got 452"):
        frame_bytes(0x51, 1, 0x4E, 452 * b"x")


def test_every_frame_of_the_tables_fits() -> None:
    """The longest is 45 with 256 discretes."""
    assert 8 + 2 + 1 + 3 + 256 == 270 < MAX_FRAME


@pytest.mark.parametrize("station", [-1, 256])
def test_stations(station: int) -> None:
    with pytest.raises(UsageError, match="station: expected 0 to 255"):
        MSERIES.encode(station, RunStop(run=True))


@pytest.mark.parametrize("length", ["00 00", "00 01", "01 C6", "02 00", "FF FF"])
@pytest.mark.parametrize("header", ["51 10", "52 10"])
def test_a_length_that_no_frame_has_is_seen_at_once(header: str, length: str) -> None:
    decoder = MSERIES.decoder()
    lie = bytes.fromhex(header + length)
    decoder.feed(lie + STATUS)
    with pytest.raises(FrameError) as caught:
        decoder.next_frame()
    assert caught.value.raw == lie
    assert caught.value.message == f"length: expected 2 to 453, got {int.from_bytes(lie[2:], 'big')}"
    frame = decoder.next_frame()
    assert frame is not None
    assert frame.raw == STATUS


@pytest.mark.parametrize("said", [2, 3, 4, 5, 7, 8, 20, 200, 255, 256, 453])
def test_a_lying_length_costs_its_own_frame_alone(said: int) -> None:
    """Too short or too long: those behind it are found, once as many bytes have come or no more will."""
    lying = RUNNING[:2] + said.to_bytes(2, "big") + RUNNING[4:]
    assert raws(lying, STATUS, RUNNING) == [STATUS, RUNNING]
    assert raws(lying + STATUS + RUNNING) == [STATUS, RUNNING]
    assert raws(*(bytes([byte]) for byte in lying + STATUS + RUNNING)) == [STATUS, RUNNING]
    many = 50 * STATUS
    decoder = MSERIES.decoder()
    decoder.feed(lying + many)
    found = [item for item in drained(decoder) if not isinstance(item, FrameError)]
    assert [frame.raw for frame in found] == 50 * [STATUS]  # without being told that no more will come


def test_a_lying_length_that_ends_at_another_frames_end() -> None:
    """It spans two frames exactly, terminator and all: the second one is not lost."""
    lying = RUNNING[:2] + (len(RUNNING) - 8 + len(STATUS)).to_bytes(2, "big") + RUNNING[4:]
    first, second = decoded(lying + STATUS, codec=MSERIES)
    assert isinstance(first, FrameError)
    assert first.message.startswith("checksum: ")
    assert (first.raw, second.raw) == (lying, STATUS)
    assert not first.checksum  # what was dropped is no whole frame


def test_a_frame_that_waits_for_bytes_that_do_not_come() -> None:
    decoder = MSERIES.decoder()
    decoder.feed(bytes.fromhex("52 10 01 C5") + STATUS)
    assert drained(decoder) == []
    assert decoder.expect_no_more()
    error, frame = drained(decoder)
    assert isinstance(error, FrameError)
    assert (error.message, error.raw) == ("an incomplete frame", bytes.fromhex("52 10 01 C5"))
    assert not isinstance(frame, FrameError)
    assert frame.raw == STATUS
    assert not decoder.expect_no_more()


def test_more_after_all() -> None:
    """Bytes that come although no more were expected are looked at as ever."""
    decoder = MSERIES.decoder()
    decoder.feed(STATUS[:4])
    assert decoder.expect_no_more()
    decoder.feed(STATUS[4:])
    frame = decoder.next_frame()
    assert frame is not None
    assert frame.raw == STATUS


# --- what stands in a payload ---------------------------------------------------------------------

INSIDE = {
    "terminators": 20 * b"\x55\xaa",
    "headers": 20 * b"\x51\x10\x52\x10",
    "a frame": STATUS,
    "frames": RUNNING + STATUS + RUNNING,
    "its own beginning": bytes.fromhex("51 10 00 06 01 4E"),
    "all bytes": bytes(range(256)),
}


@pytest.mark.parametrize("data", INSIDE.values(), ids=INSIDE)
def test_what_looks_like_a_frame_inside_one(data: bytes) -> None:
    raw = MSERIES.encode(1, Loopback(data))
    for at in range(len(raw) + 1):
        assert raws(raw[:at], raw[at:] + STATUS) == [raw, STATUS]
    assert raws(*(bytes([byte]) for byte in raw + STATUS)) == [raw, STATUS]


def test_the_terminator_as_a_value() -> None:
    request = ReadRegisters(Element("R", 0), 3)
    answer = (0x55AA, 0x0055, 0xAA55)
    raw = MSERIES.encode_answer(1, request, answer)
    assert raw == response("01 46 00 55 AA 00 55 AA 55")
    for at in range(len(raw) + 1):
        (frame,) = frames([raw[:at], raw[at:]], MSERIES)
        assert MSERIES.parse_answer(request, frame) == answer


# --- damage ---------------------------------------------------------------------------------------


def test_a_wrong_crc_is_refused_with_both() -> None:
    error, frame = decoded(STATUS[:-4] + b"\x84\xa1\x55\xaa" + STATUS, codec=MSERIES)
    assert isinstance(error, FrameError)
    assert error.checksum
    assert error.message == "checksum: expected A1 84, got 84 A1"
    assert error.raw == STATUS[:-4] + b"\x84\xa1\x55\xaa"
    assert frame.raw == STATUS


@pytest.mark.parametrize("crcs", ["D4 55 AA", "55 D5 55 AA"])
def test_the_papers_shifted_crcs_do_not_pass(crcs: str) -> None:
    assert raws(bytes.fromhex("52 10 00 03 01 41 00" + crcs) + STATUS) == [STATUS]


@pytest.mark.parametrize("at", range(len(RUNNING)))
def test_one_wrong_byte_never_costs_the_next_frame(at: int) -> None:
    for byte in {0x00, 0x10, 0x51, 0x52, 0x55, 0xAA, 0xFF, RUNNING[at] ^ 0x40} - {RUNNING[at]}:
        damaged = RUNNING[:at] + bytes([byte]) + RUNNING[at + 1 :]
        assert raws(damaged + STATUS)[-1] == STATUS
        assert raws(*(bytes([one]) for one in damaged + STATUS))[-1] == STATUS


@pytest.mark.parametrize("at", range(len(RUNNING)))
def test_one_lost_byte_never_costs_the_next_frame(at: int) -> None:
    assert raws(RUNNING[:at] + RUNNING[at + 1 :] + STATUS) == [STATUS]
    assert raws(RUNNING[:at] + b"\x51" + RUNNING[at:] + STATUS)[-1] == STATUS


def test_a_wrong_end() -> None:
    error, frame = decoded(STATUS[:-2] + b"\xaa\x55" + STATUS, codec=MSERIES)
    assert isinstance(error, FrameError)
    assert error.message == "after the length: expected 55 AA, got AA 55"
    assert not error.checksum
    assert frame.raw == STATUS


@pytest.mark.parametrize(
    "raw", [b"", STATUS[:-1], STATUS + b"\0", b"x" * 12, bytes.fromhex("51 10 00 00 FF FF 55 AA")]
)
def test_parse_frame_wants_a_whole_frame(raw: bytes) -> None:
    with pytest.raises(FrameError) as caught:
        parse_frame(raw)
    assert caught.value.raw == raw
    assert not caught.value.checksum


# --- who speaks -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("request_", "said"), [(RunStop(run=False), None), (Loopback(b"ABC"), b"ABC"), (Loopback(b""), b"")]
)
def test_an_echo_is_no_answer_though_its_payload_is_one(request_: Request[Any], said: bytes | None) -> None:
    asks = MSERIES.encode(1, request_)
    answers = MSERIES.encode_answer(1, request_, said)
    assert asks[1:] == answers[1:]
    assert not MSERIES.echo_may_pass(request_)
    (echo,) = frames([asks], MSERIES)
    with pytest.raises(FrameError, match=r"expected an answer \(52\), got a request \(51\)"):
        MSERIES.parse_answer(request_, echo)


def test_stations_and_commands_are_any_byte() -> None:
    for raw in (query("FF 99"), response("00 00 00"), query("55 AA")):
        (frame,) = frames([raw], MSERIES)
        assert (frame.station, frame.command) == (raw[4], raw[5])
