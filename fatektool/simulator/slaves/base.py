"""The seam between a line and a protocol: what any slave over simulated PLCs must offer.

A line (see ``line``) carries bytes, paces them and spoils them; it knows no protocol. A slave cuts
requests out of the bytes and answers them from its PLCs. To add a protocol, write one class with
these methods over ``SimulatedPlc``'s operations, with a ``SlaveType`` for ``protocols.py``.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.simulator.plc import SimulatedPlc

BROADCAST = 0


class RequestKind(Enum):
    """What a request does, as far as the fault layer and a replay must know."""

    OTHER = "other"
    LOOPBACK = "loopback"
    WRITE = "write"
    PAGE_WRITE = "page-write"


class RequestFrame(NamedTuple):
    """One request cut out of the stream, its checksum already right.

    Attributes:
        end: how many bytes of the chunk just fed had crossed the wire with its last one.
        raw: the frame.
        station: 0 broadcast, 1 to 254.
        command: the command as it is in the frame.
        data: what follows the command, without checksum.
        kind: what it does.
    """

    end: int
    raw: bytes
    station: int
    command: bytes
    data: bytes
    kind: RequestKind


def addressed(plcs: Mapping[int, SimulatedPlc], station: int) -> SimulatedPlc | None:
    """Who answers under this number: the PLC that has it, else one whose station check is off (R4149).

    A line of the simulator is port 0. Where the low byte of R4149 is 1, that port answers every number.
    """
    found = plcs.get(station)
    if found is not None or station == BROADCAST:
        return found
    return next((plc for plc in plcs.values() if not plc.checks_station), None)


class SlaveType(NamedTuple):
    """One protocol of the simulator.

    Attributes:
        make: a new slave for a line, over the PLCs that all lines share.
        model: a name of ``MODELS``: what the PLCs are, unless one is named.
        bits_per_char: of its lines, unless a format is named: 10 for 7E1, 11 for 8E1.
        make_without_error_character: the same with answers to 4F and 53 as the figures of the FACON paper
            show them; None for a protocol whose papers agree.
    """

    make: Callable[[Mapping[int, SimulatedPlc]], Slave]
    model: str
    bits_per_char: float
    make_without_error_character: Callable[[Mapping[int, SimulatedPlc]], Slave] | None = None


class Slave(Protocol):
    """One connection's view of the PLCs: a framing buffer of its own over shared PLCs."""

    @property
    def plcs(self) -> Mapping[int, SimulatedPlc]:
        """The PLCs of this line by station."""

    @property
    def delimiters(self) -> tuple[bytes, ...]:
        """What begins and ends an answer, the end last: what noise must hold to be taken for one."""

    def cut(self, data: bytes) -> list[RequestFrame]:
        """Take bytes, whatever the chunking; give the requests that they complete."""

    def answer(self, request: RequestFrame) -> bytes | None:
        """Execute a request; None where a PLC is silent."""

    def readdressed(self, answer: bytes, station: int) -> bytes:
        """The same answer as another station would send it, its checksum right."""

    def reset(self) -> None:
        """Forget an unfinished request."""
