"""TCP: to a PLC's Ethernet module or to a serial gateway. A stream may split or join frames anywhere."""

from __future__ import annotations

import socket
from typing import TYPE_CHECKING

from fatektool.errors import TransportClosed
from fatektool.transport.base import MOST_SAID
from fatektool.transport.sockets import SocketTransport, connected_to

if TYPE_CHECKING:
    from fatektool.transport.sockets import Address


class TcpTransport(SocketTransport):
    """A TCP connection.

    Args:
        name: the target, for messages.
        address: IP address and port.
        connect_timeout_s: how long a connection may take to be made.

    Raises:
        TransportClosed: nobody accepts it.
    """

    def __init__(self, name: str, address: Address, *, connect_timeout_s: float = 5.0) -> None:
        self._connect_timeout_s = connect_timeout_s
        super().__init__(name, address)

    def _connect(self) -> socket.socket:
        self._first = bytearray()
        try:
            return connected_to(self._address, socket.SOCK_STREAM, self._connect_timeout_s)
        except OSError as error:
            reason = error.strerror or str(error)
            raise TransportClosed(
                f"{self.name}: cannot connect to {self._address[0]} port {self._address[1]}: {reason}",
                hint="check address and port, and that the PLC's Ethernet module or the gateway is on",
                may_return=isinstance(error, ConnectionError),
            ) from error

    def _receive(self, connected: socket.socket, max_bytes: int) -> bytes:
        data = connected.recv(max_bytes)
        if not data:
            from fatektool.transport.said import said_text

            said = said_text(bytes(self._first))
            self.close()
            words = f", after it said {said!r}" if said else ""
            raise TransportClosed(
                f"{self.name}: the other side closed the connection{words}",
                hint="another program may hold the PLC's only connection",
                may_return=True,
            )
        if len(self._first) <= MOST_SAID:
            self._first += data
        return data
