"""The interface of a Modbus slave's framing: requests from a stream, frames of answers.

The header of an answer is that of its request: over TCP with its transaction.
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
    """One framing of a body: station, function and data."""

    @property
    def delimiters(self) -> tuple[bytes, ...]:
        """The bytes that begin and end a frame."""

    @property
    def own_units(self) -> frozenset[int]:
        """The stations that mean the PLC at the address itself."""

    def feed(self, data: bytes) -> list[CutRequest]:
        """Requests that ``data`` completes, with correct checksums."""

    def sealed(self, body: bytes, request: bytes) -> bytes:
        """The frame of an answer to a request."""

    def readdressed(self, frame: bytes, station: int) -> bytes:
        """A frame with another station and a correct checksum."""

    def reset(self) -> None:
        """Drop an incomplete request."""
