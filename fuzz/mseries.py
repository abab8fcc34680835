"""M-series frames, whatever the bytes."""

from __future__ import annotations

from fatektool.protocol.fatek.mseries.codec import MSERIES
from fuzz.frames import look_at
from tests.protocol.decoding import sealed


def one_input(data: bytes) -> None:
    """Hold the decoder, the requests, the answers and the explanations to their promises.

    The top bit of the command says whether the frame is a request or an answer.
    """
    look_at(
        MSERIES,
        data,
        lambda station, command, rest: sealed(
            0x51 + (command >> 7), bytes([station, command & 0x7F]) + rest[:0xFFFD]
        ),
    )
