"""The interface between a line and a protocol: the slave.

A line (see ``line``) passes on bytes, with timing and faults, for any protocol. A slave splits the bytes into
requests and answers them from its PLCs. To add a protocol, write one class with these methods, based on the
operations of ``SimulatedPlc``, with a ``SlaveType`` for ``protocols.py``.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.simulator.plc import SimulatedPlc

BROADCAST = 0


class RequestKind(Enum):
    """What a request does, for faults and replay."""

    OTHER = "other"
    LOOPBACK = "loopback"
    WRITE = "write"
    PAGE_WRITE = "page-write"


class RequestFrame(NamedTuple):
    """One request from the stream, with a correct checksum.

    Attributes:
        end: its end in the bytes just received.
        raw: the frame.
        station: 0 broadcast, 1 to 254.
        command: the command in the frame.
        data: the bytes after the command, without checksum.
        kind: what it does.
    """

    end: int
    raw: bytes
    station: int
    command: bytes
    data: bytes
    kind: RequestKind


def addressed(plcs: Mapping[int, SimulatedPlc], station: int) -> SimulatedPlc | None:
    """The PLC that answers this station: the one with this number, else one without station check (R4149).

    A line of the simulator is port 0. If the low byte of R4149 is 1, that port answers every number.
    """
    found = plcs.get(station)
    if found is not None or station == BROADCAST:
        return found
    return next((plc for plc in plcs.values() if not plc.checks_station), None)


class SlaveType(NamedTuple):
    """One protocol of the simulator.

    Attributes:
        make: a new slave for a line, with the PLCs of all lines.
        model: the default model, a name of ``MODELS``.
        bits_per_char: the default of its lines: 10 for 7E1, 11 for 8E1.
        make_without_error_character: the same with answers to 4F and 53 as in the figures of the FACON paper;
            None for other protocols.
    """

    make: Callable[[Mapping[int, SimulatedPlc]], Slave]
    model: str
    bits_per_char: float
    make_without_error_character: Callable[[Mapping[int, SimulatedPlc]], Slave] | None = None


class Slave(Protocol):
    """The protocol of one connection: its own framing buffer, with shared PLCs."""

    @property
    def plcs(self) -> Mapping[int, SimulatedPlc]:
        """The PLCs of this line by station."""

    @property
    def delimiters(self) -> tuple[bytes, ...]:
        """The bytes that begin and end an answer, the end last; noise contains some of them."""

    def cut(self, data: bytes) -> list[RequestFrame]:
        """Receive bytes, in any pieces; returns the requests that they complete."""

    def answer(self, request: RequestFrame) -> bytes | None:
        """Execute a request; None if no PLC answers."""

    def readdressed(self, answer: bytes, station: int) -> bytes:
        """The same answer from another station, with a correct checksum."""

    def reset(self) -> None:
        """Drop an incomplete request."""
