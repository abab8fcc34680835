"""Doors of a simulator on the network: TCP, with many connections, and UDP.

::

    TcpDoor ──accept──> TcpConnection ── one line each ──┐
    UdpDoor ──datagram─> one line for each sender ───────┴──> the same PLCs

A door reads bytes when the server says so, gives them to a line, and asks the server to call
``deliver`` when a piece of the answer is due. When the power is cut, TCP connections are closed and new
ones are closed at once; UDP is silent.
"""

from __future__ import annotations

import contextlib
import os
import selectors
import socket
from collections import OrderedDict
from typing import TYPE_CHECKING, Protocol

from fatektool.errors import LineError

if TYPE_CHECKING:
    from fatektool.simulator.listen.servers import Server

_READ_BYTES = 65536
_MAX_BACKLOG = 1 << 18
"""Answers in bytes that a client may leave unread before its requests are left unread too."""

_MAX_PENDING = 1 << 14
"""Pieces that may wait for their time before requests are left unread."""

_MAX_SENDERS = 64
_MAX_PORT = 0xFFFF


class Line(Protocol):
    """What is behind a door: bytes and times in, bytes and times out."""

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """Take bytes of a stream; give what comes back, as (due time, bytes), times never decreasing."""

    def datagram(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        """The same for a message that stands by itself."""


class Lines(Protocol):
    """Where doors get their lines from: a ``Simulation`` or a ``Replay``."""

    @property
    def powered(self) -> bool:
        """False while nothing answers and no connection is held."""

    def line(self, *, whole_answers: bool = False) -> Line:
        """A new line; ``whole_answers`` for a medium of datagrams."""


class Door(Protocol):
    """One way in to a simulator."""

    @property
    def address(self) -> str:
        """In words: ``tcp://127.0.0.1:40123``, or the path of a link."""

    def lose_power(self) -> None:
        """Drop what a PLC without power would drop."""

    def close(self) -> None:
        """Give the address back; twice is fine."""


class TcpDoor:
    """A listening TCP socket."""

    def __init__(self, server: Server, host: str, port: int) -> None:
        self._server = server
        self._socket = bound(socket.SOCK_STREAM, "tcp", host, port)
        self._socket.listen(128)
        self.address = address_of("tcp", self._socket)
        self.connections: set[TcpConnection] = set()
        server.selector.register(self._socket, selectors.EVENT_READ, self._on_ready)

    def _on_ready(self, _events: int) -> None:
        # One connection an event: the selector says so again if more are waiting.
        try:
            client, _ = self._socket.accept()
        except OSError:
            return
        if not self._server.simulation.powered:
            client.close()
            return
        client.settimeout(0)
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.connections.add(TcpConnection(self._server, self, client))

    def lose_power(self) -> None:
        """Close every connection; the door stays to refuse new ones."""
        for connection in tuple(self.connections):
            connection.close()

    def close(self) -> None:
        """Close the door and every connection."""
        if self._socket.fileno() >= 0:
            self._server.selector.unregister(self._socket)
            self._socket.close()
        self.lose_power()


class TcpConnection:
    """One client over TCP, with a framing buffer and a timeline of its own."""

    def __init__(self, server: Server, door: TcpDoor, client: socket.socket) -> None:
        self._server = server
        self._door = door
        self._socket = client
        self._line: Line = server.simulation.line()
        self._backlog = bytearray()
        self._events = selectors.EVENT_READ
        self._pending = 0
        self._ended = False
        server.selector.register(client, selectors.EVENT_READ, self._on_ready)

    def _on_ready(self, events: int) -> None:
        if events & selectors.EVENT_WRITE:
            self._write()
            self._settle()
        if events & selectors.EVENT_READ and not self._ended:
            try:
                data = self._socket.recv(_READ_BYTES)
            except (BlockingIOError, InterruptedError):
                return
            except OSError:
                self.close()
                return
            if data:
                server = self._server
                self._pending += server.dispatch(self._line.receive(data, server.now()), self.deliver)
                if self._pending > _MAX_PENDING:
                    self._settle()
                return
            # The client has closed its half: what it asked for before still comes.
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
        """Close a connection that is done; else watch for what it still needs."""
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
        selector = self._server.selector
        if not events:
            selector.unregister(self._socket)
        elif not self._events:
            selector.register(self._socket, events, self._on_ready)
        else:
            selector.modify(self._socket, events, self._on_ready)
        self._events = events

    def close(self) -> None:
        """Close the connection; twice is fine."""
        if self._socket.fileno() >= 0:
            if self._events:
                self._server.selector.unregister(self._socket)
            self._socket.close()
        self._door.connections.discard(self)


class UdpDoor:
    """A UDP socket. A request is one datagram, an answer is one, whatever the baud rate."""

    def __init__(self, server: Server, host: str, port: int) -> None:
        self._server = server
        self._socket = bound(socket.SOCK_DGRAM, "udp", host, port)
        self.address = address_of("udp", self._socket)
        # A line keeps the pace and the late answers of one sender; the oldest senders are forgotten.
        self._lines: OrderedDict[object, Line] = OrderedDict()
        server.selector.register(self._socket, selectors.EVENT_READ, self._on_ready)

    def _on_ready(self, _events: int) -> None:
        # Windows reports here that an earlier answer found nobody; that is no fault of this one.
        with contextlib.suppress(OSError):
            data, sender = self._socket.recvfrom(_READ_BYTES)
            due = self._line(sender).datagram(data, self._server.now())
            self._server.dispatch(due, lambda piece: self._send(piece, sender), join=False)

    def _line(self, sender: object) -> Line:
        line = self._lines.pop(sender, None) or self._server.simulation.line(whole_answers=True)
        self._lines[sender] = line
        if len(self._lines) > _MAX_SENDERS:
            self._lines.popitem(last=False)
        return line

    def _send(self, data: bytes, sender: tuple[str, int]) -> None:
        if self._socket.fileno() >= 0:
            with contextlib.suppress(OSError):
                self._socket.sendto(data, sender)

    def lose_power(self) -> None:
        """Forget the senders."""
        self._lines.clear()

    def close(self) -> None:
        """Close the socket; twice is fine."""
        if self._socket.fileno() >= 0:
            self._server.selector.unregister(self._socket)
            self._socket.close()


def bound(kind: socket.SocketKind, scheme: str, host: str, port: int) -> socket.socket:
    """A socket at this address; LineError if it cannot be had."""
    shown = f"{scheme}://{f'[{host}]' if ':' in host else host}:{port}"
    if not 0 <= port <= _MAX_PORT:  # getaddrinfo would take it modulo 65536
        raise LineError(f"cannot listen on {shown}: a port is 0 to {_MAX_PORT}", address=shown)
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=kind, flags=socket.AI_PASSIVE)[0]
        opened = socket.socket(family, kind)
    except (OSError, UnicodeError, OverflowError) as error:
        raise _cannot_listen(shown, error) from error
    try:
        # On Windows the option would let two servers share a port.
        if kind == socket.SOCK_STREAM and os.name == "posix":
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        opened.bind(address)
        opened.settimeout(0)
    except (OSError, OverflowError) as error:
        opened.close()
        raise _cannot_listen(shown, error) from error
    return opened


def _cannot_listen(shown: str, error: Exception) -> LineError:
    reason = getattr(error, "strerror", None) or str(error)
    return LineError(
        f"cannot listen on {shown}: {reason}",
        hint="choose another port, or 0 for any free one",
        address=shown,
    )


def address_of(scheme: str, opened: socket.socket) -> str:
    """Where a socket listens, in words."""
    host, port = opened.getsockname()[:2]
    return f"{scheme}://[{host}]:{port}" if ":" in host else f"{scheme}://{host}:{port}"
