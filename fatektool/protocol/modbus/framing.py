"""The differences between RTU, ASCII and TCP: encoding and form of a frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.codec import Decoder

LAST_STATION: Final = 247
MAX_PDU: Final = 253


class FramePart(NamedTuple):
    """A part of a frame before the station or after the PDU, for explanations.

    Attributes:
        name: as in the specification.
        size: in bytes on the wire.
        meaning: of its bytes, in a frame with a correct checksum.
    """

    name: str
    size: int
    meaning: Callable[[bytes], str]


@dataclass(frozen=True, slots=True)
class Framing:
    """One framing.

    Attributes:
        name: of ``--protocol``.
        form: the form of a frame, as text.
        encode: station, PDU and number as a frame.
        decoder: a new decoder.
        size: length of a frame around a PDU of so many bytes.
        repeated: the bytes of a request that a valid answer repeats: station, function, number.
        before: the parts before the station.
        after: the parts after the PDU; none if there is no checksum.
        checksum: of station and PDU, as it is sent; None if there is none.
        octet: bytes on the wire for one byte of station and PDU.
        data_bits: that a serial line needs; None if it is not used there.
        tcp_port: the default.
        stations: valid for one PLC.
        own_units: the stations that mean the PLC at the address itself.
        numbers: the count of different numbers that answers repeat; 1 if they have none.
        quiet_chars: the silence in characters before a frame.
    """

    name: str
    form: str
    encode: Callable[[int, bytes, int], bytes]
    decoder: Callable[[], Decoder]
    size: Callable[[int], int]
    repeated: Callable[[bytes], bytes]
    before: tuple[FramePart, ...] = ()
    after: tuple[FramePart, ...] = ()
    checksum: Callable[[bytes], bytes] | None = None
    octet: int = 1
    data_bits: int | None = None
    tcp_port: int | None = None
    stations: range = range(1, 1 + LAST_STATION)
    own_units: frozenset[int] = frozenset()
    numbers: int = 1
    quiet_chars: float = 0.0


def always(meaning: str) -> Callable[[bytes], str]:
    """The meaning of a part that is the same in every frame."""
    return lambda _: meaning
