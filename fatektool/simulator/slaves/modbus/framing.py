"""What a Modbus slave needs of a framing, from the slave's end: requests found in a stream, answers framed.

What is around an answer is its request's: over TCP its transaction too.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

MAX_STATION = 247


class CutRequest(NamedTuple):
    """A request: its end as an offset in the bytes just fed, its bytes, and station, function and data."""

    end: int
    raw: bytes
    body: bytes


class SlaveFraming(Protocol):
    """One way to put a body, which is station, function and data, on a wire."""

    @property
    def delimiters(self) -> tuple[bytes, ...]:
        """What begins and ends a frame."""

    @property
    def own_units(self) -> frozenset[int]:
        """The stations that mean the PLC at the address itself."""

    def feed(self, data: bytes) -> list[CutRequest]:
        """Requests that ``data`` completes, their checksums right."""

    def sealed(self, body: bytes, request: bytes) -> bytes:
        """The frame of an answer to a request."""

    def readdressed(self, frame: bytes, station: int) -> bytes:
        """A frame with another station, its checksum right."""

    def reset(self) -> None:
        """Forget a request that has only begun."""
