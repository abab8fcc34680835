"""The decoder: whatever the bytes and their chunks, the same frames, and nothing but ``FrameError``."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from fatektool.errors import FrameError
from fatektool.protocol.codec import Frame
from fatektool.protocol.fatek.facon import codec
from fatektool.protocol.fatek.facon.codec import FACON, frame_bytes, lrc, parse_frame
from tests.protocol.decoding import decoded, framed, frames
from tests.protocol.strategies import requests
from tests.protocol.vectors import FRAMES

if TYPE_CHECKING:
    import re

frame_raws = st.one_of(st.sampled_from(FRAMES), st.builds(FACON.encode, st.integers(0, 254), requests))
noises = st.one_of(st.binary(max_size=40), st.text("\x02\x030123ABCDEF", max_size=40).map(str.encode))
damaged = frame_raws.flatmap(
    lambda raw: st.builds(
        lambda at, byte: raw[:at] + bytes([byte]) + raw[at + 1 :],
        st.integers(0, len(raw) - 1),
        st.integers(0, 255),
    )
)
streams = st.lists(st.one_of(frame_raws, damaged, noises), max_size=6).map(b"".join)


def test_lrc_counts_stx_and_not_etx() -> None:
    assert lrc(b"\x020140") == b"C7"
    assert lrc(b"\x02") == b"02"
    assert lrc(b"\xff\x01") == b"00"
    assert lrc(b"\x00\x0a") == b"0A"


@pytest.mark.parametrize("byte", [0x00, 0x41, 0x7F, 0x80, 0xFF])
def test_lrc_is_the_sum_at_every_length_of_a_frame(byte: int) -> None:
    for length in range(506):
        assert lrc(bytes([byte]) * length) == b"%02X" % (byte * length % 256)


@given(st.binary(max_size=505))
def test_lrc_is_the_sum_of_any_bytes(data: bytes) -> None:
    assert lrc(data) == b"%02X" % (sum(data) % 256)


def test_a_frame_that_is_received_byte_by_byte_is_looked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not at each byte, which would cost the square of its length."""
    looked: list[int] = []

    def match(buffer: bytearray) -> re.Match[bytes] | None:
        looked.append(len(buffer))
        return whole.match(buffer)

    whole = codec._FRAME
    monkeypatch.setattr(codec, "_FRAME", SimpleNamespace(match=match))
    raw = frame_bytes(1, 0x4F, b"0" + b"A5" * 128)
    decoder = FACON.decoder()
    found = []
    for at in range(len(raw)):
        decoder.feed(raw[at : at + 1])
        found.append(decoder.next_frame())
    assert found[:-1] == [None] * (len(raw) - 1)
    assert found[-1] is not None
    assert found[-1].raw == raw
    assert looked == [len(raw)]


@pytest.mark.parametrize(
    ("raw", "dropped"),
    [
        (b"\x0201\x03\x03\x03", b"\x0201\x03"),  # a frame ends at the first ETX
        (b"\x020140\x037\x03", b"\x020140\x03"),
        (b"\x020140C\x03\x03", b"\x020140C\x03"),
        (b"\x020140\x02C7\x03", b"\x020140"),
    ],
)
def test_what_is_dropped_ends_where_a_frame_ends_or_begins(raw: bytes, dropped: bytes) -> None:
    decoder = FACON.decoder()
    decoder.feed(raw)
    with pytest.raises(FrameError) as caught:
        decoder.next_frame()
    assert caught.value.raw == dropped


@given(st.integers(0, 254), st.integers(0, 255), st.binary(max_size=500))
def test_frame_round_trip(station: int, command: int, data: bytes) -> None:
    data = data.replace(b"\x02", b"").replace(b"\x03", b"")
    raw = frame_bytes(station, command, data)
    frame = parse_frame(raw)
    assert (frame.station, frame.command, frame.data, frame.raw) == (station, command, data, raw)
    assert raw == framed(b"%02X%02X%b" % (station, command, data))


@given(streams, frame_raws)
@example(b"\x02" + 506 * b"x", FRAMES[0])
@example(b"\x02" + 507 * b"x", FRAMES[0])
@example(b"\x0201" + FRAMES[1][:-1], FRAMES[0])
def test_a_good_frame_behind_anything_is_found(stream: bytes, raw: bytes) -> None:
    for chunks in ([stream + raw], [stream, raw], [bytes([byte]) for byte in stream + raw]):
        found = decoded(*chunks)
        assert found
        assert not isinstance(found[-1], FrameError)
        assert found[-1].raw == raw


@given(st.lists(st.binary(max_size=200), max_size=20))
def test_any_bytes_after_any_bytes(chunks: list[bytes]) -> None:
    assert all(frame.raw[0] == 2 and frame.raw[-1] == 3 for frame in frames(chunks))


@given(frame_raws, st.data())
def test_one_changed_byte_never_passes_unseen(raw: bytes, data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(raw) - 1))
    byte = data.draw(st.integers(0, 255).filter(lambda value: value != raw[at]))
    assert raw not in [frame.raw for frame in frames([raw[:at] + bytes([byte]) + raw[at + 1 :]])]
    if byte not in {2, 3}:
        assert frames([raw[:at] + bytes([byte]) + raw[at + 1 :]]) == []


def test_508_bytes_pass_and_509_do_not() -> None:
    longest = framed(b"014E" + 500 * b"x")
    assert len(longest) == 508
    longer = framed(b"014E" + 501 * b"x")
    for raw, passes in ((longest, True), (longer, False)):
        for chunks in ([raw], [bytes([byte]) for byte in raw]):
            assert [frame.raw for frame in frames([*chunks, FRAMES[0]])] == [raw] * passes + [FRAMES[0]]


def test_a_frame_without_end_is_dropped_at_508_bytes() -> None:
    decoder = FACON.decoder()
    decoder.feed(b"\x02" + 506 * b"x")
    assert decoder.next_frame() is None
    decoder.feed(b"x")
    with pytest.raises(FrameError, match="no end within 508 bytes") as caught:
        decoder.next_frame()
    assert len(caught.value.raw) == 508
    assert decoder.next_frame() is None


@pytest.mark.parametrize(
    "station_and_command",
    [b"0g40", b"+140", b"01+4", b" 140", b"1_40", b"01 4", b"014 ", b"G140", b"01-1", b"\xb1\xb240"],
)
def test_only_hex_digits_name_station_and_command(station_and_command: bytes) -> None:
    (error,) = decoded(framed(station_and_command))
    assert isinstance(error, FrameError)
    assert "not two hex digits" in error.message
    assert not error.checksum


def test_small_hex_digits_are_read() -> None:
    """As some devices in the field send them."""
    (frame,) = decoded(b"\x020a4eA6d\x03")
    assert isinstance(frame, Frame)
    assert (frame.station, frame.command, frame.data) == (0x0A, 0x4E, b"A")
    (status,) = decoded(b"\x020140c7\x03")
    assert isinstance(status, Frame)
    assert (status.station, status.command, status.data) == (0x01, 0x40, b"")


@pytest.mark.parametrize("got", [b"+7", b" 7", b"7 ", b"C8", b"\xff\xff", b"0\x00"])
def test_only_the_exact_checksum_passes(got: bytes) -> None:
    (error,) = decoded(b"\x020140" + got + b"\x03")
    assert isinstance(error, FrameError)
    assert error.checksum
    assert error.message.startswith("checksum: expected C7, got ")
    assert error.details == {"raw": error.raw.hex(" ").upper()}


@pytest.mark.parametrize("raw", [b"\x02\x03", b"\x02014\x03", b"\x020140C\x03"])
def test_too_short(raw: bytes) -> None:
    (error,) = decoded(raw)
    assert isinstance(error, FrameError)
    assert f"got {len(raw)} bytes" in error.message
    assert error.raw == raw


@pytest.mark.parametrize("raw", [b"", b"0140C7", b"\x020140C7", b"0140C7\x03", b"\x02" * 9, b"x" * 600])
def test_parse_frame_wants_a_whole_frame(raw: bytes) -> None:
    with pytest.raises(FrameError, match="invalid frame: expected STX"):
        parse_frame(raw)


def test_a_stx_inside_begins_anew() -> None:
    broken, whole = decoded(FRAMES[2][:6] + FRAMES[2])
    assert isinstance(broken, FrameError)
    assert broken.message == "an incomplete frame, then another beginning"
    assert broken.raw == FRAMES[2][:6]
    assert not isinstance(whole, FrameError)
    assert whole.raw == FRAMES[2]
