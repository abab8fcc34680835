"""What TCP and UDP share: a connected socket, and its errors as the project's own.

After a connection is lost, the next ``write`` makes a new one: Ethernet modules sometimes stop answering
until a reconnect [E:ethernet-reconnect].
"""

from __future__ import annotations

import contextlib
import socket
from abc import abstractmethod
from typing import TYPE_CHECKING, cast

from fatektool.errors import LineError, TransportClosed, TransportTimeout
from fatektool.transport.base import DRAIN_LIMIT, WRITE_TIMEOUT_S, Transport
from fatektool.transport.wait import readable, writable

if TYPE_CHECKING:
    from collections.abc import Callable

Address = tuple[str, int] | tuple[str, int, int, int]
"""IP address and port; for IPv6 also flow and scope, which a link-local address needs."""


def resolve(host: str, port: int) -> Address:
    """The IP address of a host, with the port; IPv4 first, because the modules of these PLCs have IPv4 only.

    Raises:
        LineError: the name has no address.
    """
    try:
        # Text would load IDNA, which only names outside ASCII need.
        found = socket.getaddrinfo(host.encode() if host.isascii() else host, port, type=socket.SOCK_STREAM)
    except (OSError, ValueError) as error:  # UnicodeError among them
        reason = getattr(error, "strerror", None) or str(error)
        raise LineError(
            f"{host}: no such host: {reason}", hint="check the name, or give its IP address", host=host
        ) from error
    addresses = [place[4] for place in sorted(found, key=lambda place: place[0] != socket.AF_INET)]
    return cast("Address", addresses[0])


def connected_to(address: Address, kind: socket.SocketKind, timeout_s: float) -> socket.socket:
    """A socket connected to an address; raises the errors of the operating system."""
    connecting = socket.socket(socket.AF_INET6 if ":" in address[0] else socket.AF_INET, kind)
    try:
        connecting.settimeout(timeout_s)
        if kind == socket.SOCK_STREAM:
            connecting.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        connecting.connect(address)
    except BaseException:
        connecting.close()
        raise
    return connecting


class SocketTransport(Transport):
    """A connected socket; connecting and receiving are the subclass's.

    Args:
        name: the target, for messages.
        address: IP address and port.
    """

    def __init__(self, name: str, address: Address) -> None:
        self.name = name
        self._address = address
        self._socket: socket.socket | None = None
        self._readable: Callable[[float], bool] = lambda _: False
        self._writable: Callable[[float], bool] = lambda _: False
        self._use(self._connect())

    @abstractmethod
    def _connect(self) -> socket.socket:
        """Make a connected socket, or raise ``TransportClosed``."""

    @abstractmethod
    def _receive(self, connected: socket.socket, max_bytes: int) -> bytes:
        """Receive at least one byte, or raise ``BlockingIOError`` or ``TransportClosed``."""

    def _use(self, connected: socket.socket) -> socket.socket:
        connected.setblocking(False)  # noqa: FBT003
        self._socket = connected
        self._readable = readable(connected.fileno())
        self._writable = writable(connected.fileno())
        return connected

    def _sent_reason(self) -> str:
        """The reason that the other side sent as text, as part of a sentence; empty if none."""
        return ""

    def _broken(self, error: OSError) -> TransportClosed:
        reason = self._sent_reason()
        self.close()
        return TransportClosed(
            f"{self.name}: the connection was lost: {error.strerror or error}{reason}",
            hint="check that the PLC's Ethernet module or the gateway is on, and its cable. Other programs "
            "may use all of its connections (a FATEK module has 8, many gateways 1)",
            may_return=isinstance(error, ConnectionError),
        )

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read what is received first, at most ``max_bytes``."""
        connected = self._socket
        if connected is None:
            raise TransportClosed(f"{self.name}: the connection is closed")
        try:
            # Waiting by the socket's own time-out would have each write wait too: a system call more.
            data = self._receive(connected, max_bytes) if self._readable(timeout_s) else b""
        except BlockingIOError:  # it was a datagram with a wrong checksum
            data = b""
        except OSError as error:
            raise self._broken(error) from error
        if not data:
            raise TransportTimeout(f"{self.name}: nothing received within {timeout_s:.3f} s")
        return data

    def write(self, data: bytes) -> None:
        """Send all of ``data``; connect first if the connection was lost."""
        connected = self._socket or self._use(self._connect())
        rest = data
        try:
            while rest:
                try:
                    rest = rest[connected.send(rest) :]
                except BlockingIOError:
                    if not self._writable(WRITE_TIMEOUT_S):
                        self.close()
                        raise TransportTimeout(
                            f"{self.name}: the write blocked for {WRITE_TIMEOUT_S:g} s"
                        ) from None
        except OSError as error:
            raise self._broken(error) from error

    def drain(self) -> bytes:
        """Return what was received already."""
        connected = self._socket
        if connected is None or not self._readable(0.0):  # the usual case
            return b""
        taken = bytearray()
        with contextlib.suppress(OSError, TransportClosed):
            while len(taken) < DRAIN_LIMIT and self._readable(0.0):
                taken += self._receive(connected, 4096)
        return bytes(taken)

    def renew(self) -> None:
        """Close the connection; the next ``write`` makes a new one."""
        self.close()

    def close(self) -> None:
        """Close the socket."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None
