"""UDP: to a PLC's Ethernet module.

A datagram may be lost, duplicated or late. The exchange detects that with fences, not this file.
"""

from __future__ import annotations

import socket
from typing import Final

from fatektool.errors import TransportClosed
from fatektool.transport.sockets import SocketTransport, connected_to

_DATAGRAM: Final = 65535


class UdpTransport(SocketTransport):
    """A UDP socket that receives from its target only. A datagram is returned whole."""

    def _connect(self) -> socket.socket:
        try:
            return connected_to(self._address, socket.SOCK_DGRAM, 0)
        except OSError as error:
            raise TransportClosed(
                f"{self.name}: cannot send to {self._address[0]}: {error.strerror or error}",
                hint="check the address and the network of this computer",
            ) from error

    def _receive(self, connected: socket.socket, max_bytes: int) -> bytes:
        return connected.recv(max(max_bytes, _DATAGRAM))
