"""Whatever the protocol: any request and answer both ways, any bytes in any chunks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import FrameError, PlcRefused, UsageError
from fatektool.protocol.codec import Frame, require_commands
from fatektool.protocol.commands import Command, Loopback, ReadPage, WritePage
from fatektool.protocol.modbus.codec import ModbusCodec
from fatektool.protocol.registry import CODECS
from tests.protocol.decoding import decoded, drained, frames, one_frame, request_of
from tests.protocol.spoken import FACON_SPOKEN, MSERIES_SPOKEN, SPOKEN, Spoken, each_protocol
from tests.protocol.strategies import answers, cuts, exchanges_of, requests_of, stations

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request


def frame_raws(spoken: Spoken) -> st.SearchStrategy[bytes]:
    encoded = st.builds(spoken.codec.encode, stations, requests_of(spoken.codec))
    return st.one_of(st.sampled_from(spoken.frames), encoded)


def streams(spoken: Spoken) -> st.SearchStrategy[bytes]:
    """Frames whole and damaged, and noise, in a row."""
    damaged = frame_raws(spoken).flatmap(
        lambda raw: st.builds(
            lambda at, byte: raw[:at] + bytes([byte]) + raw[at + 1 :],
            st.integers(0, len(raw) - 1),
            st.integers(0, 255),
        )
    )
    symbols = st.lists(st.sampled_from(spoken.symbols), max_size=40).map(bytes)
    parts = st.one_of(frame_raws(spoken), damaged, st.binary(max_size=40), symbols)
    return st.lists(parts, max_size=6).map(b"".join)


# --- frames ---------------------------------------------------------------------------------------


@each_protocol
@given(st.data())
def test_any_chunks_give_the_same_frames(spoken: Spoken, data: st.DataObject) -> None:
    stream = data.draw(streams(spoken))
    whole = frames([stream], spoken.codec)
    assert frames((bytes([byte]) for byte in stream), spoken.codec) == whole
    assert frames(data.draw(cuts(stream)), spoken.codec) == whole


@each_protocol
@given(st.data())
def test_every_byte_is_accounted_for(spoken: Spoken, data: st.DataObject) -> None:
    stream = data.draw(streams(spoken))
    decoder = spoken.codec.decoder()
    decoder.feed(stream)
    given_back = b"".join(item.raw for item in drained(decoder))
    assert stream.startswith(given_back)
    left = len(stream) - len(given_back)
    if decoder.expect_no_more():
        assert b"".join(item.raw for item in drained(decoder)) == stream[-left:]
        left = 0
    assert decoder.clear() == left


@each_protocol
@given(st.data())
def test_a_good_frame_behind_anything_is_found(spoken: Spoken, data: st.DataObject) -> None:
    stream, raw = data.draw(streams(spoken)), data.draw(frame_raws(spoken))
    for chunks in ([stream + raw], [stream, raw], [bytes([byte]) for byte in stream + raw]):
        assert raw in [frame.raw for frame in frames(chunks, spoken.codec)]


@each_protocol
@given(st.data())
def test_any_bytes_raise_frame_error_or_nothing(spoken: Spoken, data: st.DataObject) -> None:
    chunks = data.draw(st.lists(st.binary(max_size=600), max_size=4))
    for item in decoded(*chunks, codec=spoken.codec):
        assert item.raw


@each_protocol
@given(st.data())
def test_one_changed_byte_never_passes_unseen(spoken: Spoken, data: st.DataObject) -> None:
    raw = data.draw(frame_raws(spoken))
    at = data.draw(st.integers(0, len(raw) - 1))
    byte = data.draw(st.integers(0, 255).filter(lambda value: value != raw[at]))
    changed = raw[:at] + bytes([byte]) + raw[at + 1 :]
    found = frames([changed], spoken.codec)
    if spoken.codec.name == "mseries" and at == 0 and byte in {0x51, 0x52}:
        assert [frame.raw for frame in found] == [changed]  # the CRC does not cover who speaks
    else:
        assert changed not in [frame.raw for frame in found]
        assert raw not in [frame.raw for frame in found]


@each_protocol
def test_the_buffer_is_bounded(spoken: Spoken) -> None:
    for symbol in spoken.symbols:
        decoder = spoken.codec.decoder()
        for _ in range(100):
            decoder.feed(bytes([symbol]) * 10_000)
        assert decoder.clear() <= 1 << 16
        decoder.feed(bytes([symbol]) * 1_000_000 + spoken.frames[0])
        assert decoder.clear() <= 1 << 16


@each_protocol
def test_of_too_much_the_newest_is_kept(spoken: Spoken) -> None:
    found = frames([b"x" * 1_000_000 + spoken.frames[0]], spoken.codec)
    assert [frame.raw for frame in found] == [spoken.frames[0]]


@each_protocol
def test_clear(spoken: Spoken) -> None:
    first, second = spoken.frames[:2]
    decoder = spoken.codec.decoder()
    assert decoder.clear() == 0
    decoder.feed(first + second[:5])
    assert decoder.next_frame() is not None
    assert decoder.clear() == 5
    assert decoder.next_frame() is None
    decoder.feed(second)
    frame = decoder.next_frame()
    assert frame is not None
    assert frame.raw == second


@each_protocol
def test_what_began_goes_on_when_more_was_not_expected(spoken: Spoken) -> None:
    """A frame that is late costs itself, not the one behind it."""
    first, second = spoken.frames[:2]
    decoder = spoken.codec.decoder()
    decoder.feed(first[:6])
    assert drained(decoder) == []
    while decoder.expect_no_more():
        assert all(isinstance(item, FrameError) for item in drained(decoder))
    decoder.feed(first[6:] + second)
    found = [item for item in drained(decoder) if not isinstance(item, FrameError)]
    assert [frame.raw for frame in found][-1] == second


# --- data -----------------------------------------------------------------------------------------


@each_protocol
@given(st.data())
def test_any_request(spoken: Spoken, data: st.DataObject) -> None:
    station, request = data.draw(stations), data.draw(requests_of(spoken.codec))
    frame = one_frame(spoken.codec.encode(station, request), spoken.codec)
    assert (frame.station, frame.command) == (station, request.command)
    assert request_of(frame, spoken.codec) == request
    assert frame.raw == spoken.framed(0x51, station, request.command, frame.data)


@each_protocol
@given(st.data())
def test_any_answer(spoken: Spoken, data: st.DataObject) -> None:
    station, (request, answer) = data.draw(stations), data.draw(exchanges_of(spoken.codec))
    raw = spoken.codec.encode_answer(station, request, answer)
    frame = one_frame(raw, spoken.codec)
    assert (frame.station, frame.command) == (station, request.command)
    assert spoken.codec.parse_answer(request, frame) == answer
    assert spoken.codec.answer_bytes(request) == len(raw)
    assert raw == spoken.framed(0x52, station, request.command, frame.data)


@each_protocol
@given(st.data())
def test_any_bytes_as_an_answer(spoken: Spoken, data: st.DataObject) -> None:
    request, content = data.draw(requests_of(spoken.codec)), data.draw(st.binary(max_size=300))
    if spoken.codec.name == "facon":
        content = content.translate(None, b"\x02\x03")  # where they stand the frame begins or ends
    raw = spoken.framed(0x52, 1, request.command, content)
    try:
        answer = spoken.codec.parse_answer(request, Frame(1, request.command, content, raw))
    except FrameError:
        return
    except PlcRefused:
        assert len(content) == 1
        return
    said = spoken.codec.encode_answer(1, request, answer)
    if len(said) == len(raw) and request.command != Command.BRIEF_STATUS:  # whose bit 7 is reserved
        assert said == raw  # nothing but the one way to write it passes


@each_protocol
@given(st.data())
def test_any_bytes_as_a_request(spoken: Spoken, data: st.DataObject) -> None:
    command, content = data.draw(st.integers(0, 255)), data.draw(st.binary(max_size=60))
    if spoken.codec.name == "facon":  # whose frames never hold STX or ETX
        content = content.translate(None, b"\x02\x03")
    raw = spoken.framed(0x51, 1, command, content)
    try:
        request = request_of(Frame(1, command, content, raw), spoken.codec)
    except FrameError:
        return
    assert spoken.codec.encode(1, request) == raw


@each_protocol
@given(st.data())
def test_a_changed_request_is_another_or_none(spoken: Spoken, data: st.DataObject) -> None:
    request = data.draw(requests_of(spoken.codec))
    before, behind = spoken.shell
    written = bytearray(spoken.codec.encode(1, request)[before:-behind])
    at = data.draw(st.integers(0, len(written)))
    pieces = st.sampled_from([b"", b"0", b"f", b"W", b" ", b"\0", b"\1"])
    written[at : at + data.draw(st.integers(0, 1))] = data.draw(pieces)
    raw = spoken.framed(0x51, 1, request.command, bytes(written))
    try:
        other = request_of(Frame(1, request.command, bytes(written), raw), spoken.codec)
    except FrameError:
        return
    assert spoken.codec.encode(1, other) == raw


@each_protocol
@given(st.data())
def test_an_echo_that_may_not_pass_is_no_answer(spoken: Spoken, data: st.DataObject) -> None:
    codec = spoken.codec
    request = data.draw(requests_of(codec))
    try:
        codec.parse_answer(request, one_frame(codec.encode(1, request), codec))
    except FrameError:
        assert not codec.echo_may_pass(request)
        return
    except PlcRefused:
        pass
    assert codec.echo_may_pass(request)


# --- what a protocol tells of itself --------------------------------------------------------------


def test_every_codec_is_tested_here() -> None:
    """Those with the papers' commands; Modbus has tests of its own in ``tests/protocol/modbus``."""
    others = {name: codec for name, codec in CODECS.items() if not isinstance(codec, ModbusCodec)}
    assert {spoken.name: spoken.codec for spoken in SPOKEN} == others


def test_commands() -> None:
    assert FACON_SPOKEN.codec.commands == set(Command)
    assert set(Command) - MSERIES_SPOKEN.codec.commands == {Command.READ_PAGE, Command.WRITE_PAGE}


@pytest.mark.parametrize("request_", [ReadPage(0), WritePage(3, bytes(128))])
def test_a_request_that_the_protocol_has_not(request_: Request[Any]) -> None:
    with pytest.raises(UsageError) as caught:
        MSERIES_SPOKEN.codec.encode(1, request_)
    words = f"{request_.command.words} ({request_.command:02X})"
    assert caught.value.message == f"mseries has no program commands: its paper does not list {words}"
    assert FACON_SPOKEN.codec.encode(1, request_)


def test_what_is_needed_is_checked_at_once() -> None:
    codec = MSERIES_SPOKEN.codec
    require_commands(codec)
    require_commands(codec, Command.READ_MIXED, Command.LOOPBACK)
    with pytest.raises(UsageError, match=r"read program page \(4F\) and write program page \(50\)"):
        require_commands(codec, Command.READ_PAGE, Command.BRIEF_STATUS, Command.WRITE_PAGE)


@each_protocol
def test_a_loopback_carries_the_whole_alphabet(spoken: Spoken) -> None:
    codec = spoken.codec
    request = Loopback(codec.loopback_alphabet)
    frame = one_frame(codec.encode(1, request), codec)
    assert request_of(frame, codec) == request
    assert sorted(set(codec.loopback_alphabet)) == list(codec.loopback_alphabet)
    assert max(codec.loopback_alphabet) < 1 << codec.data_bits


@each_protocol
def test_frames_fit_the_data_bits(spoken: Spoken) -> None:
    wide = any(byte > 0x7F for raw in spoken.frames for byte in raw)
    assert spoken.codec.data_bits == (8 if wide else 7)


def test_usual_ports() -> None:
    assert [spoken.codec.default_tcp_port for spoken in SPOKEN] == [500, None]


@each_protocol
@given(st.data())
def test_answers_of_one_request_are_of_one_length(spoken: Spoken, data: st.DataObject) -> None:
    request = data.draw(requests_of(spoken.codec))
    sizes = {
        len(spoken.codec.encode_answer(1, request, data.draw(answers(request, spoken.codec))))
        for _ in range(2)
    }
    assert sizes == {spoken.codec.answer_bytes(request)}
