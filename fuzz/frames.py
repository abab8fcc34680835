"""A protocol's decoder, requests, answers and explanations, whatever the bytes.

::

    00 BYTES     station, command and data of a frame whose checksum is right
    BYTES        the stream as it is

Promises: any chunks give the same frames; every byte is accounted for; nothing but ``FrameError`` and
``PlcRefused`` is raised; what is read is written back to the byte, but for the case of FACON's hex digits; an
explanation covers all bytes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.errors import FrameError, PlcRefused
from fatektool.protocol.commands import (
    Command,
    ControlDiscrete,
    Loopback,
    ReadBriefStatus,
    ReadDetailedStatus,
    ReadDisabled,
    ReadDiscretes,
    ReadMixed,
    ReadPage,
    ReadRegisters,
    RunStop,
    WritePage,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.explain import FrameRole
from fatektool.protocol.fatek.mseries.codec import RESPONSE
from fatektool.protocol.registry import new_explainer
from tests.protocol.decoding import decoded

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.codec import Frame
    from fatektool.protocol.commands import Request
    from fatektool.protocol.fatek.facon.codec import FaconCodec
    from fatektool.protocol.fatek.mseries.codec import MseriesCodec

LAST_STATION = 254
X0, R0, DR0 = Element("X", 0), Element("R", 0), Element("DR", 0)
ASKED: list[Request[Any]] = [
    ReadBriefStatus(),
    ReadDetailedStatus(),
    RunStop(run=False),
    *(ControlDiscrete(control, X0) for control in (1, 4)),  # type: ignore[arg-type]  # as enum members compare
    *(kind(X0, count) for kind in (ReadDisabled, ReadDiscretes) for count in (1, 3, 256)),
    *(ReadRegisters(R0, count) for count in (1, 2, 64)),
    *(ReadRegisters(DR0, count) for count in (1, 32)),
    ReadMixed((X0, R0, DR0)),
    WriteRegisters(R0, (1, 2)),
    Loopback(b""),
    Loopback(b"0123"),
    ReadPage(0),
    WritePage(0, bytes(128)),
]


def look_at(
    codec: FaconCodec | MseriesCodec, data: bytes, frame_of: Callable[[int, int, bytes], bytes]
) -> None:
    """Hold a protocol to its promises.

    Args:
        codec: the protocol.
        data: see above.
        frame_of: station, command and data to a frame, as the paper has it.
    """
    stream = frame_of(data[1], data[2], data[3:]) if data[:1] == b"\0" and len(data) >= 3 else data
    whole = decoded(stream, codec=codec)
    good = [item for item in whole if not isinstance(item, FrameError)]
    for size in (1, 7):
        chunks = [stream[at : at + size] for at in range(0, len(stream), size)]
        found = decoded(*chunks, codec=codec)
        assert [item for item in found if not isinstance(item, FrameError)] == good
    given_back = b"".join(item.raw for item in whole)
    assert stream.startswith(given_back)
    for frame in good:
        _say(codec, frame)
    for role in (FrameRole.EITHER, FrameRole.REQUEST, FrameRole.ANSWER):
        explained = list(new_explainer(codec.name).explain(stream, role))
        assert b"".join(part.raw for part in explained) == stream
        assert all(b"".join(field.raw for field in part.fields) == part.raw for part in explained)


def _say(codec: FaconCodec | MseriesCodec, frame: Frame) -> None:
    if frame.station > LAST_STATION:
        return
    try:
        request = codec.data.parse_request(frame.command, frame.data)
    except FrameError:
        pass
    else:
        if frame.raw[0] != RESPONSE:  # an answer may have the data of a request
            _hold(codec, codec.encode(frame.station, request), frame.raw)
    for asked in ASKED:
        if asked.command != frame.command or asked.command not in codec.commands:
            continue
        try:
            answer = codec.parse_answer(asked, frame)
        except (FrameError, PlcRefused):
            continue
        said = codec.encode_answer(frame.station, asked, answer)
        if len(said) == len(frame.raw) and asked.command != Command.BRIEF_STATUS:  # bit 7 of it is reserved
            _hold(codec, said, frame.raw)


def _hold(codec: FaconCodec | MseriesCodec, said: bytes, raw: bytes) -> None:
    """What was read is written back; small hex digits of FACON as capitals, with another checksum."""
    assert said == raw or (codec.name == "facon" and said[:-3] == raw[:-3].upper())
