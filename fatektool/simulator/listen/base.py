"""Interfaces of lines, without a medium, and of listeners, which connect clients to them."""

from __future__ import annotations

from typing import Protocol


class ServedLine(Protocol):
    """One connection to PLCs: bytes and times in, bytes and times out."""

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """Receive bytes of a stream; returns the answers as (due time, bytes), times never decreasing."""

    def datagram(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """The same for a complete message."""


class Lines(Protocol):
    """The source of lines for listeners: a ``Simulation`` or a ``Replay``."""

    @property
    def powered(self) -> bool:
        """False during a power cut: no answers, no connections."""

    def line(self, *, whole_answers: bool = False) -> ServedLine:
        """A new line; ``whole_answers`` for a medium with datagrams."""


class Listener(Protocol):
    """One address of a simulator."""

    @property
    def address(self) -> str:
        """The address as text: ``tcp://127.0.0.1:40123``, or the path of a link."""

    def lose_power(self) -> None:
        """Drop connections and bytes, as a PLC without power."""

    def close(self) -> None:
        """Close it; may be called again."""
