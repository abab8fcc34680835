"""A TCP listener: a line for each connection.

When the power is cut, connections are closed, and new ones are closed at once.
"""

from __future__ import annotations

import selectors
import socket
from typing import TYPE_CHECKING

from fatektool.simulator.listen.sockets import READ_BYTES, address_of, bound

if TYPE_CHECKING:
    from fatektool.simulator.listen.base import ServedLine
    from fatektool.simulator.listen.reactor import Reactor

_MAX_BACKLOG = 1 << 18
"""Bytes of answers that a client may leave unread before its requests are not read any more."""

_MAX_PENDING = 1 << 14
"""Pieces that may wait for their time before requests are not read any more."""


class TcpListener:
    """A listening TCP socket."""

    def __init__(self, reactor: Reactor, host: str, port: int) -> None:
        self._reactor = reactor
        self._socket = bound(socket.SOCK_STREAM, "tcp", host, port)
        self._socket.listen(128)
        self.address = address_of("tcp", self._socket)
        self.connections: set[TcpConnection] = set()
        reactor.selector.register(self._socket, selectors.EVENT_READ, self._on_ready)

    def _on_ready(self, _events: int) -> None:
        # One connection for each event: the selector reports again if more are waiting.
        try:
            client, _ = self._socket.accept()
        except OSError:
            return
        if not self._reactor.lines.powered:
            client.close()
            return
        client.settimeout(0)
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.connections.add(TcpConnection(self._reactor, self, client))

    def lose_power(self) -> None:
        """Close every connection; the listener stays open, to refuse new ones."""
        for connection in tuple(self.connections):
            connection.close()

    def close(self) -> None:
        """Close the listener and every connection."""
        if self._socket.fileno() >= 0:
            self._reactor.selector.unregister(self._socket)
            self._socket.close()
        self.lose_power()


class TcpConnection:
    """One client over TCP, with its own framing buffer and timing."""

    def __init__(self, reactor: Reactor, listener: TcpListener, client: socket.socket) -> None:
        self._reactor = reactor
        self._listener = listener
        self._socket = client
        self._line: ServedLine = reactor.lines.line()
        self._backlog = bytearray()
        self._events = selectors.EVENT_READ
        self._pending = 0
        self._ended = False
        reactor.selector.register(client, selectors.EVENT_READ, self._on_ready)

    def _on_ready(self, events: int) -> None:
        if events & selectors.EVENT_WRITE:
            self._write()
            self._settle()
        if events & selectors.EVENT_READ and not self._ended:
            try:
                data = self._socket.recv(READ_BYTES)
            except (BlockingIOError, InterruptedError):
                return
            except OSError:
                self.close()
                return
            if data:
                reactor = self._reactor
                self._pending += reactor.dispatch(self._line.receive(data, reactor.now()), self.deliver)
                if self._pending > _MAX_PENDING:
                    self._settle()
                return
            # The client has closed its half: the answers to its requests are still sent.
            self._ended = True
        self._settle()

    def deliver(self, data: bytes) -> None:
        """Send a piece that is due."""
        self._pending -= 1
        if self._socket.fileno() < 0:
            return
        self._backlog += data
        self._write()
        if self._events != selectors.EVENT_READ:
            self._settle()

    def _write(self) -> None:
        try:
            sent = self._socket.send(self._backlog)
        except (BlockingIOError, InterruptedError):
            sent = 0
        except OSError:
            self.close()
            return
        del self._backlog[:sent]
        if self._backlog:
            self._settle()

    def _settle(self) -> None:
        """Close a connection that is done; else wait for what it still needs."""
        if self._socket.fileno() < 0:
            return
        if self._ended and not self._pending and not self._backlog:
            self.close()
            return
        full = len(self._backlog) > _MAX_BACKLOG or self._pending > _MAX_PENDING
        events = 0 if self._ended or full else selectors.EVENT_READ
        if self._backlog:
            events |= selectors.EVENT_WRITE
        if events != self._events:
            self._watch(events)

    def _watch(self, events: int) -> None:
        selector = self._reactor.selector
        if not events:
            selector.unregister(self._socket)
        elif not self._events:
            selector.register(self._socket, events, self._on_ready)
        else:
            selector.modify(self._socket, events, self._on_ready)
        self._events = events

    def close(self) -> None:
        """Close the connection; may be called again."""
        if self._socket.fileno() >= 0:
            if self._events:
                self._reactor.selector.unregister(self._socket)
            self._socket.close()
        self._listener.connections.discard(self)
