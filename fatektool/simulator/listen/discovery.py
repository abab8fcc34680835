"""A listener that answers the discovery requests for Ethernet modules by UDP.

The layout of an answer is not known. So this answer has the length and the two port numbers of a real one,
and a text that it is from a simulator.
"""

from __future__ import annotations

import contextlib
import selectors
import socket
from typing import TYPE_CHECKING

from fatektool.simulator.listen.sockets import address_of, bound

if TYPE_CHECKING:
    from fatektool.simulator.listen.reactor import Reactor

ANSWER_PORT = 53238
_REQUESTS = {
    b"\x13\x0c\x2f\x9b\x77\x70\x89\xaa",
    b"\x09\x50\x83\x04\x5a\x22\x00\x22",
}
_LENGTH = 351
_PORTS = b"\x01\xf4\x01\xf6"
_WORDS = b"fatektool simulator"
ANSWER = _WORDS.ljust(_LENGTH - len(_PORTS), b"\0") + _PORTS
_READ_BYTES = 2048


class DiscoveryListener:
    """A UDP socket that answers the two requests, to the known port.

    Args:
        reactor: serves it.
        host: where it listens.
        port: 111, as real ones; 0 for a free one.
        answer_port: to which the answers go.
    """

    def __init__(self, reactor: Reactor, host: str, port: int, answer_port: int) -> None:
        self._reactor = reactor
        self._answer_port = answer_port
        self._socket = bound(socket.SOCK_DGRAM, "discovery", host, port)
        self.address = address_of("discovery", self._socket)
        reactor.selector.register(self._socket, selectors.EVENT_READ, self._on_ready)

    def _on_ready(self, _events: int) -> None:
        with contextlib.suppress(OSError):
            data, sender = self._socket.recvfrom(_READ_BYTES)
            if data in _REQUESTS and self._reactor.lines.powered:
                self._socket.sendto(ANSWER, (sender[0], self._answer_port, *sender[2:]))

    def lose_power(self) -> None:
        """Nothing to drop."""

    def close(self) -> None:
        """Close the socket; may be called again."""
        if self._socket.fileno() >= 0:
            self._reactor.selector.unregister(self._socket)
            self._socket.close()
