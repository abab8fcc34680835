"""What all decoders have in common: one buffer, found again behind bytes that are no frame."""

from __future__ import annotations

import pytest

from fatektool.errors import FrameError
from fatektool.protocol.registry import codec_named
from fatektool.protocol.resync import Resync
from fatektool.protocols import PROTOCOLS
from tests.protocol.decoding import decoded, frames

RTU_ANSWER = bytes.fromhex("11 03 08 F8F8 F9F9 FAFA FBFB 2C 1D")
DAMAGED = bytes.fromhex("11 03 08 F8F9 F9F9 FAFA FBFB 2C 1D")
NOISE = bytes.fromhex("FF FE FD")


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_there_is_one_buffer(protocol: str) -> None:
    assert isinstance(codec_named(protocol).decoder(), Resync)


def test_noise_behind_a_damaged_frame_is_no_part_of_it() -> None:
    """A damaged answer is known by its length, and asked again at once."""
    found = decoded(DAMAGED + NOISE, codec=codec_named("modbus-rtu"))
    errors = [error for error in found if isinstance(error, FrameError)]
    assert [(error.raw, error.checksum) for error in errors] == [(DAMAGED, True), (NOISE, False)]


def test_a_good_frame_behind_both_is_found() -> None:
    found = frames([DAMAGED + NOISE + RTU_ANSWER], codec_named("modbus-rtu"))
    assert [frame.raw for frame in found] == [RTU_ANSWER]
