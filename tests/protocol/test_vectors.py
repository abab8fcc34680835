"""The paper's examples, both ways, and in every way that a line may deliver them."""

from __future__ import annotations

import pytest

from fatektool.errors import FrameError
from fatektool.protocol.commands import Command
from fatektool.protocol.facon import FACON

from .decoding import decoded, frames, one_frame
from .vectors import EXAMPLES, FRAMES, MISPRINTS, NAMES, Example, Misprint

examples = pytest.mark.parametrize("example", EXAMPLES, ids=NAMES)
each_frame = pytest.mark.parametrize(
    "raw", FRAMES, ids=[f"{name} {side}" for name in NAMES for side in ("asks", "answers")]
)


@examples
def test_request_becomes_the_papers_bytes(example: Example) -> None:
    assert FACON.encode(1, example.request) == example.asks


@examples
def test_the_papers_bytes_become_the_request(example: Example) -> None:
    frame = one_frame(example.asks)
    assert (frame.station, frame.command) == (1, example.request.command)
    assert FACON.parse_request(frame) == example.request


@examples
def test_the_papers_answer_becomes_the_value(example: Example) -> None:
    frame = one_frame(example.answers)
    assert (frame.station, frame.command) == (1, example.request.command)
    assert FACON.parse_answer(example.request, frame) == example.answer


@examples
def test_the_value_becomes_the_papers_answer(example: Example) -> None:
    assert FACON.encode_answer(1, example.request, example.answer) == example.answers


@examples
def test_the_answers_length_is_known_beforehand(example: Example) -> None:
    assert FACON.answer_bytes(example.request) == len(example.answers)


@each_frame
def test_whole(raw: bytes) -> None:
    (frame,) = frames([raw])
    assert frame.raw == raw
    assert frame.data == raw[5:-3]


@each_frame
def test_byte_by_byte(raw: bytes) -> None:
    decoder = FACON.decoder()
    for byte in raw[:-1]:
        decoder.feed(bytes([byte]))
        assert decoder.next_frame() is None
    decoder.feed(raw[-1:])
    frame = decoder.next_frame()
    assert frame is not None
    assert frame.raw == raw
    assert decoder.clear() == 0


NOISE = {
    "zeros of a line that wakes up": b"\x00\x00",
    "stray ETX": b"\x03",
    "the tail of another frame": b"30F8\x03",
    "stray STX": b"\x02",
    "STX and garbage": b"\x02\xff\x7f0141",
    "STX, garbage and ETX": b"\x02zz\x03",
    "a frame that broke off": b"\x0201460010A5",
    "many of all": b"\x03\x03\x02\x02\xff\x03\x02",
}


@each_frame
@pytest.mark.parametrize("noise", NOISE.values(), ids=NOISE)
def test_behind_noise(noise: bytes, raw: bytes) -> None:
    found = decoded(noise + raw)
    assert [item.raw for item in found if not isinstance(item, FrameError)] == [raw]
    assert b"".join(item.raw for item in found) == noise + raw  # every byte is accounted for
    assert [frame.raw for frame in frames(bytes([byte]) for byte in noise + raw)] == [raw]


@each_frame
def test_with_bytes_trailing(raw: bytes) -> None:
    decoder = FACON.decoder()
    decoder.feed(raw + b"\x0201")
    frame = decoder.next_frame()
    assert frame is not None
    assert frame.raw == raw
    assert decoder.next_frame() is None
    decoder.feed(raw[3:])  # what began goes on
    frame = decoder.next_frame()
    assert frame is not None
    assert frame.raw == raw


def test_all_frames_in_one_chunk() -> None:
    assert [frame.raw for frame in frames([b"".join(FRAMES)])] == FRAMES


@pytest.mark.parametrize("misprint", MISPRINTS, ids=lambda misprint: misprint.name)
def test_misprints_are_refused_with_both_checksums(misprint: Misprint) -> None:
    (error,) = decoded(misprint.raw)
    assert isinstance(error, FrameError)
    assert error.checksum
    assert error.raw == misprint.raw
    assert error.message == f"checksum: expected {misprint.expected}, got '{misprint.got}'"


def test_every_command_but_the_pages_has_an_example() -> None:
    shown = {example.request.command for example in EXAMPLES}
    assert set(Command) - shown == {Command.READ_PAGE, Command.WRITE_PAGE}
