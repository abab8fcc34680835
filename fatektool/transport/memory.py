"""A line within this process, with a clock of its own: nothing waits for real time.

The other end is any object with ``receive``, such as a simulated line: it gets bytes and the time, and
returns the answer in pieces, each with the time at which it arrives. Waiting sets the clock forward, so
time-outs, slow answers and the speed of a line are exact and take no real time.
"""

from __future__ import annotations

from collections import deque
from typing import Protocol

from fatektool.errors import TransportClosed, TransportTimeout
from fatektool.transport.base import Transport


class Peer(Protocol):
    """The other end of a line."""

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """Get bytes at this time; return the answer in pieces, each with its time, in order."""


class MemoryTransport(Transport):
    """A line to a peer in this process.

    Args:
        peer: the other end.
        name: the target, for messages.
    """

    def __init__(self, peer: Peer, name: str = "sim:") -> None:
        self.name = name
        self._peer = peer
        self._now = 0.0
        self._coming: deque[tuple[float, bytes]] = deque()
        self._closed = False
        self.clock = lambda: self._now

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Return the next piece if it arrives in time; else set the clock forward by the time-out."""
        if self._closed:
            raise TransportClosed(f"{self.name}: closed")
        if not self._coming or self._coming[0][0] > self._now + timeout_s:
            self._now += max(0.0, timeout_s)
            raise TransportTimeout(f"{self.name}: nothing received within {timeout_s:.3f} s")
        due, data = self._coming.popleft()
        self._now = max(self._now, due)
        if len(data) > max_bytes:
            self._coming.appendleft((due, data[max_bytes:]))
        return data[:max_bytes]

    def write(self, data: bytes) -> None:
        """Give bytes to the peer."""
        if self._closed:
            raise TransportClosed(f"{self.name}: closed")
        self._coming.extend(self._peer.receive(data, self._now))

    def drain(self) -> bytes:
        """Return the pieces that have arrived by now."""
        taken = bytearray()
        while not self._closed and self._coming and self._coming[0][0] <= self._now:
            taken += self._coming.popleft()[1]
        return bytes(taken)

    def close(self) -> None:
        """Close the line."""
        self._closed = True
