"""TCP: to a PLC's Ethernet module or a serial gateway. A stream may split or join frames anywhere."""

from __future__ import annotations

import contextlib
import socket
from typing import TYPE_CHECKING, Final

from fatektool.errors import TransportClosed
from fatektool.transport.base import MOST_SAID
from fatektool.transport.sockets import SocketTransport, connected_to

if TYPE_CHECKING:
    from fatektool.transport.sockets import Address

_TAKEN: Final = "other programs may use all of its connections (a FATEK module has 8, many gateways 1)"
_HINTS: Final = (
    "check address and port, and that the PLC's Ethernet module or the gateway is on",
    _TAKEN,
)
"""If it did not accept the connection; if it accepted and reset it."""


class TcpTransport(SocketTransport):
    """A TCP connection.

    Args:
        name: the target, for messages.
        address: IP address and port.
        connect_timeout_s: how long connecting may take, in seconds.

    Raises:
        TransportClosed: the connection is not accepted.
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
                hint=_HINTS[isinstance(error, ConnectionResetError)],
                may_return=isinstance(error, ConnectionError),
            ) from error

    def _receive(self, connected: socket.socket, max_bytes: int) -> bytes:
        data = connected.recv(max_bytes)
        if not data:
            reason = self._sent_reason()
            self.close()
            raise TransportClosed(
                f"{self.name}: the other side closed the connection{reason}",
                hint=_TAKEN,
                may_return=True,
            )
        if len(self._first) <= MOST_SAID:
            self._first += data
        return data

    def _sent_reason(self) -> str:
        from fatektool.transport.said import said_text

        if self._socket is not None:  # bytes received before a reset can still be read
            with contextlib.suppress(OSError):
                self._first += self._socket.recv(MOST_SAID)
        text = said_text(bytes(self._first))
        return f", after it sent {text!r}" if text else ""
