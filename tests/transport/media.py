"""Every medium with its other side, so that one suite runs over all of them."""

from __future__ import annotations

import contextlib
import os
import socket
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pytest

from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from fatektool.transport.serial_line.port import DeviceTransport, SerialTransport, open_serial
from fatektool.transport.tcp import TcpTransport
from fatektool.transport.udp import UdpTransport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

    from fatektool.transport.base import Transport

needs_pty = pytest.mark.skipif(not hasattr(os, "openpty"), reason="no pseudo terminals here")
LINE = LineSettings(4_000_000, "8N1")
PATIENCE_S = 20.0


@dataclass
class Medium:
    """A transport, and its other side.

    Attributes:
        send: the other side sends.
        receive: the other side takes exactly so many bytes.
        hang_up: the other side goes.
        whole: True where messages keep together.
        most: the largest message.
    """

    transport: Transport
    send: Callable[[bytes], None]
    receive: Callable[[int], bytes]
    hang_up: Callable[[], None]
    whole: bool = False
    most: int = 1 << 18


def ask_twice(transport: Transport) -> None:
    for _ in range(2):  # some media tell only after the first
        transport.write(b"anybody?")
        transport.read(16, PATIENCE_S)


def receive_all(recv: Callable[[int], bytes], count: int) -> bytes:
    data = b""
    while len(data) < count and (more := recv(count - len(data))):
        data += more
    return data


@contextlib.contextmanager
def listening() -> Iterator[tuple[socket.socket, int]]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(20)
        yield server, server.getsockname()[1]


@contextlib.contextmanager
def over_socket(connect: Callable[[int], Transport]) -> Iterator[Medium]:
    with listening() as (server, port), connect(port) as transport:
        other, _ = server.accept()
        other.settimeout(20)
        with other:
            yield Medium(transport, other.sendall, lambda count: receive_all(other.recv, count), other.close)


def tcp() -> AbstractContextManager[Medium]:
    return over_socket(lambda port: TcpTransport("tcp://plc", ("127.0.0.1", port)))


def socket_url() -> AbstractContextManager[Medium]:
    return over_socket(lambda port: open_serial(f"socket://127.0.0.1:{port}", LINE))


@contextlib.contextmanager
def udp() -> Iterator[Medium]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        other.settimeout(20)
        with UdpTransport("udp://plc", other.getsockname()) as transport:
            transport.write(b"who")
            _, client = other.recvfrom(16)
            yield Medium(
                transport,
                lambda data: [other.sendto(data, client)].clear(),
                lambda count: other.recv(count + 1),
                other.close,
                whole=True,
                most=8192,
            )


@contextlib.contextmanager
def over_pty(prefix: str, most: int = 1 << 18) -> Iterator[Medium]:
    master, slave = os.openpty()
    open_ends = [master]

    def hang_up() -> None:
        while open_ends:
            os.close(open_ends.pop())

    try:
        with open_serial(prefix + os.ttyname(slave), LINE) as transport:
            os.close(slave)
            yield Medium(
                transport,
                lambda data: send_all(master, data),
                lambda count: receive_all(lambda size: os.read(master, size), count),
                hang_up,
                most=most,
            )
    finally:
        hang_up()


def send_all(descriptor: int, data: bytes) -> None:
    while data:
        data = data[os.write(descriptor, data) :]


@contextlib.contextmanager
def device() -> Iterator[Medium]:
    with over_pty("") as medium:
        assert isinstance(medium.transport, DeviceTransport)
        yield medium


@contextlib.contextmanager
def spy_url() -> Iterator[Medium]:
    with over_pty("spy://", most=1 << 14) as medium:  # each byte is printed, too
        assert isinstance(medium.transport, SerialTransport)
        yield medium


@contextlib.contextmanager
def loop_url() -> Iterator[Medium]:
    with open_serial("loop://", LINE) as transport:
        assert isinstance(transport, SerialTransport)
        port = transport._port

        def receive(count: int) -> bytes:
            return receive_all(port.read, count)

        yield Medium(transport, port.write, receive, port.close, most=4000)


class MemoryPeer:
    """Keeps what it hears; what it has to say goes out with the next bytes that it hears, even none."""

    def __init__(self) -> None:
        self.heard = b""
        self.to_say: list[tuple[float, bytes]] = []

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        self.heard += data
        said, self.to_say = self.to_say, []
        return [(now + after, piece) for after, piece in said]


@contextlib.contextmanager
def memory() -> Iterator[Medium]:
    peer = MemoryPeer()
    with MemoryTransport(peer) as transport:

        def send(data: bytes) -> None:
            peer.to_say.append((0.0, data))
            transport.write(b"")

        def receive(count: int) -> bytes:
            taken, peer.heard = peer.heard[:count], peer.heard[count:]
            return taken

        yield Medium(transport, send, receive, transport.close)


MEDIA = [
    pytest.param(tcp, id="tcp"),
    pytest.param(udp, id="udp"),
    pytest.param(device, id="device", marks=needs_pty),
    pytest.param(socket_url, id="socket-url"),
    pytest.param(spy_url, id="spy-url", marks=needs_pty),
    pytest.param(loop_url, id="loop-url"),
    pytest.param(memory, id="memory"),
]
