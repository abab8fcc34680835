"""The way of a stream takes what a decoder would take, and nothing else."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import FatektoolError, FrameError
from fatektool.protocol.commands import (
    Loopback,
    ReadDiscretes,
    ReadPage,
    ReadRegisters,
    WriteDiscretes,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.registry import CODECS
from tests.protocol.decoding import drained
from tests.protocol.spoken import SPOKEN
from tests.protocol.strategies import answers, exchanges_of

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Request

MODBUS = [CODECS[name] for name in CODECS if name.startswith("modbus")]
CODECS_HERE = [*(spoken.codec for spoken in SPOKEN), *MODBUS]
each_codec = pytest.mark.parametrize("codec", CODECS_HERE, ids=lambda codec: codec.name)

RUNS: list[Request[Any]] = [
    ReadRegisters(Element("R", 0), 1),
    ReadRegisters(Element("R", 100), 64),
    ReadRegisters(Element("D", 0), 3),
    ReadDiscretes(Element("M", 0), 1),
    ReadDiscretes(Element("Y", 8), 20),
    WriteRegisters(Element("R", 5), (1, 2, 3)),
    WriteRegisters(Element("R", 5), (0xFFFF,)),
    WriteDiscretes(Element("M", 5), (True, False, True)),
]


def exchanges(codec: Codec) -> st.SearchStrategy[tuple[Request[Any], Any]]:
    """Any request, and a good answer to it."""
    if codec in MODBUS:
        return st.sampled_from(RUNS).flatmap(lambda request: st.tuples(st.just(request), answers(request)))
    return exchanges_of(codec).filter(lambda exchange: not isinstance(exchange[0], Loopback))


def by_decoder(codec: Codec, request: Request[Any], asked: bytes, raw: bytes) -> list[Any]:
    """The answer, in a list, if all of the bytes are the good one; else nothing."""
    found = []
    for each in (asked, raw):
        decoder = codec.decoder()
        decoder.feed(each)
        found.append(drained(decoder))
    (ours,), theirs = found
    if len(theirs) != 1 or isinstance(theirs[0], FrameError) or isinstance(ours, FrameError):
        return []
    frame = theirs[0]
    if frame.raw != raw:
        return []
    if (frame.station, frame.command, frame.number) != (ours.station, ours.command, ours.number):
        return []
    try:
        return [codec.parse_answer(request, frame)]
    except FatektoolError:
        return []


def in_a_stream(codec: Codec, request: Request[Any], asked: bytes, raw: bytes) -> list[Any]:
    try:
        return [codec.good_answer(request, asked, raw)]
    except FrameError:
        return []


@each_codec
@given(st.data())
def test_a_good_answer_is_taken(codec: Codec, data: st.DataObject) -> None:
    request, answer = data.draw(exchanges(codec))
    station, number = data.draw(st.integers(1, 247)), data.draw(st.integers(0, codec.numbers - 1))
    asked = codec.encode(station, request, number)
    raw = codec.encode_answer(station, request, answer, number)
    assert in_a_stream(codec, request, asked, raw) == [answer] == by_decoder(codec, request, asked, raw)


@each_codec
@given(st.data())
def test_what_is_damaged_is_taken_only_if_a_decoder_takes_it(codec: Codec, data: st.DataObject) -> None:
    request, answer = data.draw(exchanges(codec))
    asked = codec.encode(1, request, 0)
    raw = bytearray(codec.encode_answer(1, request, answer, 0))
    places = st.integers(0, len(raw) - 1)
    for at, byte in data.draw(st.lists(st.tuples(places, st.integers(0, 255)), min_size=1, max_size=3)):
        raw[at] = byte
    damaged = bytes(raw)
    assert in_a_stream(codec, request, asked, damaged) == by_decoder(codec, request, asked, damaged)


@each_codec
@given(st.data())
def test_a_frame_of_another_station_command_or_number_is_not_taken(codec: Codec, data: st.DataObject) -> None:
    request, answer = data.draw(exchanges(codec))
    asked = codec.encode(1, request, 0)
    other = codec.encode_answer(2, request, answer, 0)
    assert in_a_stream(codec, request, asked, other) == []
    if codec.numbers > 1:
        assert in_a_stream(codec, request, asked, codec.encode_answer(1, request, answer, 1)) == []
    another, its_answer = data.draw(exchanges(codec))
    raw = codec.encode_answer(1, another, its_answer, 0)
    if codec.code(another) != codec.code(request) and len(raw) == codec.answer_bytes(request):
        assert in_a_stream(codec, request, asked, raw) == []


@each_codec
@given(st.data())
def test_any_content_with_a_right_checksum_is_taken_only_if_a_decoder_takes_it(
    codec: Codec, data: st.DataObject
) -> None:
    request, answer = data.draw(exchanges(codec))
    asked = codec.encode(1, request, 0)
    size = codec.answer_bytes(request)
    shell = len(codec.encode_raw(1, codec.code(request), b"", answer=True))
    if codec is FACON:
        contents = st.lists(st.sampled_from(b"0123456789ABCDEFabcdefGZ \xff\x00"), max_size=300).map(bytes)
    else:
        contents = st.binary(max_size=size)
    room = (size - shell) // (2 if codec.name == "modbus-ascii" else 1)
    content = data.draw(contents)[:room]
    raw = codec.encode_raw(1, codec.code(request), content.ljust(room, b"0"), answer=True)
    assert len(raw) == size
    assert in_a_stream(codec, request, asked, raw) == by_decoder(codec, request, asked, raw)
    assert answer is None or in_a_stream(codec, request, asked, raw) != [None]


@each_codec
def test_a_refusal_is_not_taken(codec: Codec) -> None:
    for request in RUNS[5:]:  # of a write, the answer has the length of a refusal in FACON and M-series
        asked = codec.encode(1, request, 0)
        raw = codec.encode_refusal(1, codec.code(request), 2)
        assert in_a_stream(codec, request, asked, raw) == []


def test_a_loopback_has_no_error_character_and_is_left_to_the_decoder() -> None:
    asked = FACON.encode(1, Loopback(b"0123"))
    assert in_a_stream(FACON, Loopback(b"0123"), asked, asked) == []


def test_each_part_of_a_facon_answer_is_checked() -> None:
    page = ReadPage(5)
    asked = FACON.encode(1, page)
    good = b"\x02014F0" + b"A7" * 127 + b"AF"
    good += b"%02X\x03" % (sum(good) % 256)
    assert in_a_stream(FACON, page, asked, good) == [b"\xa7" * 127 + b"\xaf"]
    for name, place, byte in (
        ("start", 0, 0x03),
        ("station", 2, ord("2")),
        ("command", 4, ord("E")),
        ("error character", 5, ord("1")),
        ("no hex digit", 6, ord("G")),
    ):
        body = bytearray(good[:-3])
        body[place] = byte
        raw = bytes(body) + b"%02X\x03" % (sum(body) % 256)
        assert in_a_stream(FACON, page, asked, raw) == [], name
    assert in_a_stream(FACON, page, asked, good[:-1] + b"\x02") == []
    assert in_a_stream(FACON, page, asked, good[:-2] + bytes([good[-2] ^ 1]) + b"\x03") == []
    small = good[:-3] + good[-3:].lower()
    assert small != good
    assert in_a_stream(FACON, page, asked, small) == []  # left to the decoder, which reads it
