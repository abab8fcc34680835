"""Lines, which know no medium, and listeners, which bring clients to them."""

from __future__ import annotations

from typing import Protocol


class ServedLine(Protocol):
    """What a client talks to: bytes and times in, bytes and times out."""

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """Take bytes of a stream; give what comes back, as (due time, bytes), times never decreasing."""

    def datagram(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """The same for a message that is complete."""


class Lines(Protocol):
    """Where listeners get their lines from: a ``Simulation`` or a ``Replay``."""

    @property
    def powered(self) -> bool:
        """False while nothing answers and no connection is held."""

    def line(self, *, whole_answers: bool = False) -> ServedLine:
        """A new line; ``whole_answers`` for a medium of datagrams."""


class Listener(Protocol):
    """One address at which clients reach a simulator."""

    @property
    def address(self) -> str:
        """In words: ``tcp://127.0.0.1:40123``, or the path of a link."""

    def lose_power(self) -> None:
        """Drop what a PLC without power would drop."""

    def close(self) -> None:
        """Give the address back; twice is fine."""
