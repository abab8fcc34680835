"""Frames of the three framings: whole, byte by byte, with noise before them and bytes behind them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.errors import FrameError, UsageError
from fatektool.protocol.modbus.ascii import ASCII
from fatektool.protocol.modbus.rtu import RTU
from fatektool.protocol.modbus.tcp import TCP
from tests.night import examples
from tests.protocol.decoding import decoded, drained, frames, one_frame
from tests.protocol.modbus.vectors import (
    EXCEPTION,
    EXCHANGES,
    NUMBER,
    STATION,
    Exchange,
    ascii_frame,
    rtu,
    tcp,
)
from tests.protocol.strategies import cuts

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.modbus.codec import ModbusCodec


@dataclass(frozen=True)
class Spoken:
    """A framing, and what disturbs it."""

    codec: ModbusCodec
    framed: Callable[[str], bytes]
    noise: dict[str, bytes]
    symbols: bytes

    @property
    def raws(self) -> list[bytes]:
        return [self.framed(text) for each in EXCHANGES for text in (each.asks, each.answers)]


SPOKEN = [
    Spoken(
        RTU,
        rtu,
        {
            "zeros": b"\0\0\0",
            "a station": b"\x11",
            "a station and a function": b"\x11\x03",
            "the tail of another frame": b"\x43\x40\x49\xad",
            "a byte count that lies": b"\x11\x03\xfa\x00",
            "a write that broke off": b"\x11\x10\x00\x01\x00\x7b\xf6\x00",
            "a wrong CRC": b"\x11\x05\x00\xac\xff\x00\x4e\x8c",
            "a function that is none": b"\x11\x2b\x0e\x01",
        },
        b"\x11\x01\x03\x06\x10\x83\x00\x02\xff",
    ),
    Spoken(
        ASCII,
        ascii_frame,
        {
            "zeros": b"\0\0\0",
            "a colon": b":",
            "an end": b"\r\n",
            "a frame that broke off": b":110306AE",
            "lower case": b":1103006b00037e\r\n",
            "half a byte": b":1103006B00037\r\n",
            "a wrong LRC": b":1103006B00037F\r\n",
            "not hex": b":11+3006B00037E\r\n",
        },
        b":\r\n0123456789ABCDEF",
    ),
    Spoken(
        TCP,
        tcp,
        {
            "zeros": b"\0\0\0",
            "half a header": b"\x15\x01\0\0",
            "another protocol": b"\x15\x01\0\x01\0\x06\x11\x03\0\x6b\0\x03",
            "a length of nothing": b"\x15\x01\0\0\0\0",
            "a length that lies": b"\x15\x01\0\0\0\xfe\x11\x03",
            "a length that its function has not": b"\x15\x01\0\0\0\x07\x11\x03\0\x6b\0\x03\0",
        },
        b"\0\x01\x03\x06\x11\x15\x05\xff",
    ),
]
each_framing = pytest.mark.parametrize("spoken", SPOKEN, ids=lambda spoken: spoken.codec.name)
each_exchange = pytest.mark.parametrize("exchange", EXCHANGES, ids=lambda each: f"{each.function:02X}")
EACH_NOISE = [
    pytest.param(spoken, noise, id=f"{spoken.codec.name} {name}")
    for spoken in SPOKEN
    for name, noise in spoken.noise.items()
]


# --- the worked examples --------------------------------------------------------------------------


@each_framing
@each_exchange
def test_a_request_is_written_and_read(spoken: Spoken, exchange: Exchange) -> None:
    codec = spoken.codec.mapped(exchange.map)
    raw = spoken.framed(exchange.asks)
    assert codec.encode(STATION, exchange.request, NUMBER) == raw
    assert codec.request_bytes(exchange.request) == len(raw)
    assert codec.code(exchange.request) == exchange.function
    frame = one_frame(raw, codec)
    assert (frame.station, frame.command) == (STATION, exchange.function)
    assert frame.number == (NUMBER if codec.numbers > 1 else 0)


@each_framing
@each_exchange
def test_an_answer_is_read_and_written(spoken: Spoken, exchange: Exchange) -> None:
    codec = spoken.codec.mapped(exchange.map)
    raw = spoken.framed(exchange.answers)
    frame = one_frame(raw, codec)
    assert (frame.station, frame.command) == (STATION, exchange.function)
    assert codec.parse_answer(exchange.request, frame) == exchange.answer
    assert codec.answer_bytes(exchange.request) == len(raw)
    said = codec.encode_answer(STATION, exchange.request, exchange.answer, NUMBER)
    assert one_frame(said, codec).data[:2] == frame.data[:2]
    if exchange.function > 2:  # the example leaves bits on behind the last one that was asked for
        assert said == raw


@each_framing
def test_byte_by_byte_with_bytes_behind(spoken: Spoken) -> None:
    stream = b"".join(spoken.raws)
    assert [frame.raw for frame in frames((bytes([byte]) for byte in stream), spoken.codec)] == spoken.raws
    assert [frame.raw for frame in frames([stream], spoken.codec)] == spoken.raws
    for raw in spoken.raws:
        decoder = spoken.codec.decoder()
        decoder.feed(raw + spoken.raws[0][:3])
        frame = decoder.next_frame()
        assert frame is not None
        assert frame.raw == raw
        assert decoder.next_frame() is None
        assert decoder.clear() == 3


@pytest.mark.parametrize(("spoken", "noise"), EACH_NOISE)
def test_noise_before_a_frame(spoken: Spoken, noise: bytes) -> None:
    for raw in spoken.raws:
        found = frames([noise + raw], spoken.codec)
        assert [frame.raw for frame in found] == [raw]
        assert frames((bytes([byte]) for byte in noise + raw), spoken.codec) == found
        assert [frame.raw for frame in frames([noise + raw + raw], spoken.codec)] == [raw, raw]


@each_framing
def test_an_exception(spoken: Spoken) -> None:
    frame = one_frame(spoken.framed(EXCEPTION), spoken.codec)
    assert (frame.station, frame.command, frame.data) == (10, 1, b"\x81\x02")


def test_the_checksums() -> None:
    with pytest.raises(FrameError, match="wrong CRC"):
        _first(RTU, bytes.fromhex("11 05 00 AC FF 00 4E 8C"))
    with pytest.raises(FrameError, match="expected 7E, got 7F") as caught:
        _first(ASCII, b":1103006B00037F\r\n")
    assert caught.value.checksum


def _first(codec: ModbusCodec, raw: bytes) -> None:
    decoder = codec.decoder()
    decoder.feed(raw)
    decoder.next_frame()


# --- any bytes ------------------------------------------------------------------------------------


def streams(spoken: Spoken) -> st.SearchStrategy[bytes]:
    """Frames whole and damaged, and noise, in a row."""
    raws = st.sampled_from(spoken.raws)
    damaged = raws.flatmap(
        lambda raw: st.builds(
            lambda at, byte: raw[:at] + bytes([byte]) + raw[at + 1 :],
            st.integers(0, len(raw) - 1),
            st.integers(0, 255),
        )
    )
    symbols = st.lists(st.sampled_from(spoken.symbols), max_size=40).map(bytes)
    return st.lists(st.one_of(raws, damaged, st.binary(max_size=40), symbols), max_size=6).map(b"".join)


@each_framing
@given(st.data())
@settings(max_examples=examples(40), deadline=None)
def test_any_chunks_give_the_same_frames(spoken: Spoken, data: st.DataObject) -> None:
    stream = data.draw(streams(spoken))
    whole = frames([stream], spoken.codec)
    assert frames((bytes([byte]) for byte in stream), spoken.codec) == whole
    assert frames(data.draw(cuts(stream)), spoken.codec) == whole


@each_framing
@given(st.data())
@settings(max_examples=examples(40), deadline=None)
def test_every_byte_is_accounted_for(spoken: Spoken, data: st.DataObject) -> None:
    stream = data.draw(streams(spoken))
    decoder = spoken.codec.decoder()
    decoder.feed(stream)
    given_back = b"".join(item.raw for item in drained(decoder))
    if decoder.expect_no_more():
        while decoder.expect_no_more():
            given_back += b"".join(item.raw for item in drained(decoder))
        assert given_back == stream
    assert stream.startswith(given_back)
    assert decoder.clear() == len(stream) - len(given_back)


@each_framing
@given(st.data())
@settings(max_examples=examples(40), deadline=None)
def test_a_good_frame_behind_anything_that_ended_is_found(spoken: Spoken, data: st.DataObject) -> None:
    """Behind what is let go of when its time is over."""
    stream, raw = data.draw(streams(spoken)), data.draw(st.sampled_from(spoken.raws))
    decoder = spoken.codec.decoder()
    decoder.feed(stream)
    found = drained(decoder)
    while decoder.expect_no_more():
        found += drained(decoder)
    decoder.feed(raw)
    behind = drained(decoder)
    assert raw in [item.raw for item in behind if not isinstance(item, FrameError)]


@each_framing
@given(st.lists(st.binary(max_size=400), max_size=3))
@settings(max_examples=examples(40), deadline=None)
def test_any_bytes_raise_frame_error_or_nothing(spoken: Spoken, chunks: list[bytes]) -> None:
    for item in decoded(*chunks, codec=spoken.codec):
        assert item.raw


@pytest.mark.parametrize("spoken", SPOKEN[:2], ids=lambda spoken: spoken.codec.name)
@given(st.data())
@settings(max_examples=examples(40), deadline=None)
def test_one_changed_byte_never_passes_unseen(spoken: Spoken, data: st.DataObject) -> None:
    raw = data.draw(st.sampled_from(spoken.raws))
    at = data.draw(st.integers(0, len(raw) - 1))
    byte = data.draw(st.integers(0, 255).filter(lambda value: value != raw[at]))
    changed = raw[:at] + bytes([byte]) + raw[at + 1 :]
    assert not {changed, raw} & {frame.raw for frame in frames([changed], spoken.codec)}


@each_framing
def test_the_buffer_is_bounded_and_keeps_the_newest(spoken: Spoken) -> None:
    for symbol in spoken.symbols:
        decoder = spoken.codec.decoder()
        decoder.feed(bytes([symbol]) * 1_000_000 + spoken.raws[0])
        assert decoder.clear() <= 1 << 16
    found = frames([b"x" * 1_000_000 + spoken.raws[0]], spoken.codec)
    assert [frame.raw for frame in found] == [spoken.raws[0]]


@each_framing
def test_stations(spoken: Spoken) -> None:
    """A serial line has 1 to 247; over TCP a unit is any byte."""
    request = EXCHANGES[2].request
    last = 255 if spoken.codec.name == "modbus-tcp" else 247
    assert spoken.codec.encode(0, request)
    assert spoken.codec.encode(last, request)
    for station in (-1, last + 1):
        with pytest.raises(UsageError, match=f"station: expected 0 to {last}, got {station}"):
            spoken.codec.encode(station, request)


@pytest.mark.parametrize("unit", [0, 248, 255])
def test_frames_of_every_unit_are_found_over_tcp(unit: int) -> None:
    answer = bytes.fromhex(f"0007 0000 0005 {unit:02X} 03 02 1234")
    assert [(frame.station, frame.number) for frame in frames([answer], TCP)] == [(unit, 7)]
