"""A UDP listener: a line for each sender. During a power cut it does not answer."""

from __future__ import annotations

import contextlib
import selectors
import socket
from collections import OrderedDict
from typing import TYPE_CHECKING

from fatektool.simulator.listen.sockets import READ_BYTES, address_of, bound

if TYPE_CHECKING:
    from fatektool.simulator.listen.base import ServedLine
    from fatektool.simulator.listen.reactor import Reactor

_MAX_SENDERS = 64


class UdpListener:
    """A UDP socket. A request is one datagram, and so is an answer, with any baud rate."""

    def __init__(self, reactor: Reactor, host: str, port: int) -> None:
        self._reactor = reactor
        self._socket = bound(socket.SOCK_DGRAM, "udp", host, port)
        self.address = address_of("udp", self._socket)
        # A line has the timing and the late answers of one sender; the oldest senders are dropped.
        self._lines: OrderedDict[object, ServedLine] = OrderedDict()
        reactor.selector.register(self._socket, selectors.EVENT_READ, self._on_ready)

    def _on_ready(self, _events: int) -> None:
        # Windows reports here that an earlier answer was not received; this does not concern the request.
        with contextlib.suppress(OSError):
            data, sender = self._socket.recvfrom(READ_BYTES)
            due = self._line(sender).datagram(data, self._reactor.now())
            self._reactor.dispatch(due, lambda piece: self._send(piece, sender), join=False)

    def _line(self, sender: object) -> ServedLine:
        line = self._lines.pop(sender, None) or self._reactor.lines.line(whole_answers=True)
        self._lines[sender] = line
        if len(self._lines) > _MAX_SENDERS:
            self._lines.popitem(last=False)
        return line

    def _send(self, data: bytes, sender: tuple[str, int]) -> None:
        if self._socket.fileno() >= 0:
            with contextlib.suppress(OSError):
                self._socket.sendto(data, sender)

    def lose_power(self) -> None:
        """Drop the senders."""
        self._lines.clear()

    def close(self) -> None:
        """Close the socket; may be called again."""
        if self._socket.fileno() >= 0:
            self._reactor.selector.unregister(self._socket)
            self._socket.close()
