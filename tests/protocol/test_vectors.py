"""The papers' examples, both ways, and in every way that a line may deliver them."""

from __future__ import annotations

import pytest

from fatektool.errors import FrameError
from fatektool.protocol.commands import Command
from tests.protocol.decoding import decoded, frames, one_frame, request_of
from tests.protocol.fatek.mseries.vectors import EXAMPLES as MSERIES_EXAMPLES
from tests.protocol.spoken import SPOKEN, Spoken, each_example, each_frame, each_protocol
from tests.protocol.vectors import EXAMPLES, MISPRINTS, Example, Misprint


@each_example
def test_request_becomes_the_papers_bytes(spoken: Spoken, example: Example) -> None:
    assert spoken.codec.encode(1, example.request) == example.asks


@each_example
def test_the_papers_bytes_become_the_request(spoken: Spoken, example: Example) -> None:
    frame = one_frame(example.asks, spoken.codec)
    assert (frame.station, frame.command) == (1, example.request.command)
    assert request_of(frame, spoken.codec) == example.request


@each_example
def test_the_papers_answer_becomes_the_value(spoken: Spoken, example: Example) -> None:
    frame = one_frame(example.answers, spoken.codec)
    assert (frame.station, frame.command) == (1, example.request.command)
    assert spoken.codec.parse_answer(example.request, frame) == example.answer


@each_example
def test_the_value_becomes_the_papers_answer(spoken: Spoken, example: Example) -> None:
    assert spoken.codec.encode_answer(1, example.request, example.answer) == example.answers


@each_example
def test_the_answers_length_is_known_beforehand(spoken: Spoken, example: Example) -> None:
    assert spoken.codec.answer_bytes(example.request) == len(example.answers)


@each_frame
def test_whole(spoken: Spoken, raw: bytes) -> None:
    (frame,) = frames([raw], spoken.codec)
    before, behind = spoken.shell
    assert frame.raw == raw
    assert frame.data == raw[before:-behind]


@each_frame
def test_byte_by_byte(spoken: Spoken, raw: bytes) -> None:
    decoder = spoken.codec.decoder()
    for byte in raw[:-1]:
        decoder.feed(bytes([byte]))
        assert decoder.next_frame() is None
    decoder.feed(raw[-1:])
    frame = decoder.next_frame()
    assert frame is not None
    assert frame.raw == raw
    assert decoder.clear() == 0


@each_frame
def test_behind_noise(spoken: Spoken, raw: bytes) -> None:
    for noise in spoken.noise.values():
        found = decoded(noise + raw, codec=spoken.codec)
        assert [item.raw for item in found if not isinstance(item, FrameError)] == [raw], noise
        assert b"".join(item.raw for item in found) == noise + raw  # every byte is accounted for
        alone = frames((bytes([byte]) for byte in noise + raw), spoken.codec)
        assert [frame.raw for frame in alone] == [raw], noise


@each_frame
def test_with_bytes_trailing(spoken: Spoken, raw: bytes) -> None:
    decoder = spoken.codec.decoder()
    decoder.feed(raw + raw[:3])
    frame = decoder.next_frame()
    assert frame is not None
    assert frame.raw == raw
    assert decoder.next_frame() is None
    decoder.feed(raw[3:])  # what began goes on
    frame = decoder.next_frame()
    assert frame is not None
    assert frame.raw == raw


@each_protocol
def test_split_at_any_byte(spoken: Spoken) -> None:
    """Any two frames of the paper in a row, cut once anywhere."""
    for first, second in zip(spoken.frames, spoken.frames[1:], strict=False):
        both = first + second
        for at in range(len(both) + 1):
            assert [frame.raw for frame in frames([both[:at], both[at:]], spoken.codec)] == [first, second]


@each_protocol
def test_all_frames_in_one_chunk(spoken: Spoken) -> None:
    assert [frame.raw for frame in frames([b"".join(spoken.frames)], spoken.codec)] == spoken.frames


@pytest.mark.parametrize("misprint", MISPRINTS, ids=lambda misprint: misprint.name)
def test_misprints_are_refused_with_both_checksums(misprint: Misprint) -> None:
    (error,) = decoded(misprint.raw)
    assert isinstance(error, FrameError)
    assert error.checksum
    assert error.raw == misprint.raw
    assert error.message == f"checksum: expected {misprint.expected}, got '{misprint.got}'"


def test_every_command_but_some_has_an_example() -> None:
    pages = {Command.READ_PAGE, Command.WRITE_PAGE}
    shown = {example.request.command for example in EXAMPLES}
    assert set(Command) - shown == pages
    shown = {example.request.command for example in MSERIES_EXAMPLES}
    assert set(Command) - shown == pages | {Command.DETAILED_STATUS}
    assert [len(spoken.codec.commands) for spoken in SPOKEN] == [14, 12]
