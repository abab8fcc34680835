"""FACON frames, whatever the bytes."""

from __future__ import annotations

from fatektool.protocol.fatek.facon.codec import FACON
from fuzz.frames import look_at
from tests.protocol.decoding import framed


def one_input(data: bytes) -> None:
    """Hold the decoder, the requests, the answers and the explanations to their promises."""
    look_at(FACON, data, lambda station, command, rest: framed(b"%02X%02X%b" % (station, command, rest)))
