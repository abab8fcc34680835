"""What RTU, ASCII and TCP differ in: how a station and a PDU become a frame, and what a frame looks like."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.codec import Decoder

LAST_STATION: Final = 247
MAX_PDU: Final = 253


class FramePart(NamedTuple):
    """A part of a frame before the station or behind the PDU, for who explains it.

    Attributes:
        name: the specification's word for it.
        size: in bytes on the wire.
        meaning: its bytes in words; of a frame whose checksum holds.
    """

    name: str
    size: int
    meaning: Callable[[bytes], str]


@dataclass(frozen=True, slots=True)
class Framing:
    """One framing.

    Attributes:
        name: of ``--protocol``.
        form: what a frame looks like, in words.
        encode: station, PDU and number as a frame.
        decoder: a new decoder.
        size: length of a frame around a PDU of so many bytes.
        repeated: the bytes of a request that its good answer repeats: station, function, number.
        before: the parts before the station.
        behind: the parts behind the PDU; none if there is no checksum.
        checksum: of station and PDU, as it is sent; None if there is none.
        octet: bytes on the wire for one of station and PDU.
        data_bits: that a serial line needs; None if it is not used there.
        tcp_port: unless one is named.
        stations: that one PLC can be asked under.
        own_units: the stations that mean the PLC at the address itself.
        numbers: how many requests can be told apart by the number that their answers repeat.
        quiet_chars: the silence in characters before a frame.
    """

    name: str
    form: str
    encode: Callable[[int, bytes, int], bytes]
    decoder: Callable[[], Decoder]
    size: Callable[[int], int]
    repeated: Callable[[bytes], bytes]
    before: tuple[FramePart, ...] = ()
    behind: tuple[FramePart, ...] = ()
    checksum: Callable[[bytes], bytes] | None = None
    octet: int = 1
    data_bits: int | None = None
    tcp_port: int | None = None
    stations: range = range(1, 1 + LAST_STATION)
    own_units: frozenset[int] = frozenset()
    numbers: int = 1
    quiet_chars: float = 0.0


def always(meaning: str) -> Callable[[bytes], str]:
    """The meaning of a part that says the same in every frame."""
    return lambda _: meaning
