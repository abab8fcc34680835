"""Feeding a decoder, and what comes out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.errors import FrameError
from fatektool.protocol.facon import FACON

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.protocol.codec import Decoder, Frame


def drained(decoder: Decoder) -> list[Frame | FrameError]:
    """All that a decoder gives until it wants more."""
    found: list[Frame | FrameError] = []
    while True:
        try:
            frame = decoder.next_frame()
        except FrameError as error:
            found.append(error)
            continue
        if frame is None:
            return found
        found.append(frame)


def decoded(*chunks: bytes) -> list[Frame | FrameError]:
    """Frames and errors in the order in which they come."""
    decoder = FACON.decoder()
    found = []
    for chunk in chunks:
        decoder.feed(chunk)
        found += drained(decoder)
    return found


def frames(chunks: Iterable[bytes]) -> list[Frame]:
    """Good frames only."""
    return [item for item in decoded(*chunks) if not isinstance(item, FrameError)]


def one_frame(raw: bytes) -> Frame:
    """The only thing in these bytes."""
    (frame,) = decoded(raw)
    assert not isinstance(frame, FrameError)
    return frame


def framed(body: bytes) -> bytes:
    """A frame around station, command and data, its checksum as the paper counts it."""
    head = b"\x02" + body
    return head + b"%02X" % (sum(head) % 256) + b"\x03"
