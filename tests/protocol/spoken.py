"""The protocols that the same tests run over, and what each needs for that."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.protocol.fatek.facon.codec import FACON, FaconCodec
from fatektool.protocol.fatek.mseries.codec import MSERIES, MseriesCodec
from tests.protocol import vectors
from tests.protocol.decoding import framed, sealed
from tests.protocol.fatek.mseries import vectors as mseries_vectors

if TYPE_CHECKING:
    from tests.protocol.vectors import Example


@dataclass(frozen=True)
class Spoken:
    """A protocol.

    Attributes:
        codec: what is tested.
        examples: exchanges of its paper.
        noise: bytes that are no frame, nor the beginning of one that swallows the next for good.
        symbols: a few bytes that mean something to its decoder.
        cut: a frame that began.
        shell: how many bytes stand before and behind the data.
    """

    codec: FaconCodec | MseriesCodec
    examples: list[Example]
    noise: dict[str, bytes]
    symbols: bytes
    cut: bytes
    shell: tuple[int, int]

    @property
    def name(self) -> str:
        return self.codec.name

    @property
    def frames(self) -> list[bytes]:
        return [raw for example in self.examples for raw in (example.asks, example.answers)]

    def framed(self, header: int, station: int, command: int, data: bytes) -> bytes:
        """A frame as the paper describes it, not as the code under test writes it."""
        if self.codec is FACON:
            return framed(b"%02X%02X%b" % (station, command, data))
        return sealed(header, bytes([station, command]) + data)


FACON_SPOKEN = Spoken(
    FACON,
    vectors.EXAMPLES,
    {
        "zeros of a line that wakes up": b"\x00\x00",
        "stray ETX": b"\x03",
        "the tail of another frame": b"30F8\x03",
        "stray STX": b"\x02",
        "STX and garbage": b"\x02\xff\x7f0141",
        "STX, garbage and ETX": b"\x02zz\x03",
        "a frame that broke off": b"\x0201460010A5",
        "many of all": b"\x03\x03\x02\x02\xff\x03\x02",
    },
    b"\x02\x030123ABCDEF",
    b"\x0201",
    (5, 3),
)
MSERIES_SPOKEN = Spoken(
    MSERIES,
    mseries_vectors.EXAMPLES + mseries_vectors.PAYLOADS,
    {
        "zeros of a line that wakes up": b"\x00\x00",
        "stray terminator": b"\x55\xaa",
        "the tail of another frame": b"\x00\x45\xd4\x55\xaa",
        "stray header": b"\x51",
        "header and ID": b"\x52\x10",
        "another ID": b"\x51\x11\x00\x02\x01\x40\xa1\x84\x55\xaa",
        "another header": b"\x53\x10\x00\x02\x01\x40\xa1\x84\x55\xaa",
        "a length of no frame": b"\x51\x10\xff\xff\x01",
        "a length of nothing": b"\x52\x10\x00\x00",
        "a length that lies": b"\x52\x10\x01\xc5\x01\x40",
        "a frame that broke off": b"\x52\x10\x00\x07\x01\x46\x00\xff",
        "a wrong CRC": b"\x51\x10\x00\x02\x01\x40\xa1\x85\x55\xaa",
        "many of all": b"\x55\xaa\x51\x52\x10\x51\x10\x00\x51\x10\x00\x40\x52",
    },
    b"\x51\x52\x10\x00\x01\x02\x55\xaa",
    b"\x51\x10\x00",
    (6, 4),
)

SPOKEN = [FACON_SPOKEN, MSERIES_SPOKEN]
each_protocol = pytest.mark.parametrize("spoken", SPOKEN, ids=lambda spoken: spoken.name)

EACH_EXAMPLE: list[Any] = [
    pytest.param(spoken, example, id=f"{spoken.name} {example.name}")
    for spoken in SPOKEN
    for example in spoken.examples
]
each_example = pytest.mark.parametrize(("spoken", "example"), EACH_EXAMPLE)
each_frame = pytest.mark.parametrize(
    ("spoken", "raw"),
    [
        pytest.param(spoken, raw, id=f"{spoken.name} {example.name} {side}")
        for spoken in SPOKEN
        for example in spoken.examples
        for side, raw in (("asks", example.asks), ("answers", example.answers))
    ],
)
