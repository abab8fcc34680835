"""Clients for the tests of listeners: sockets of this process, to a server in a thread."""

from __future__ import annotations

import socket
from contextlib import contextmanager
from typing import TYPE_CHECKING

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running
from tests.guard import GUARD_S
from tests.simulator.wire import frame

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.simulator.listen.base import Listener

ASK, ANSWER = frame("4601R00007"), frame("4600000")
PAGE_HEX = "AB" * 128


def place(listener: Listener) -> tuple[str, int]:
    host, _, port = listener.address.partition("://")[2].rpartition(":")
    return host.strip("[]"), int(port)


@contextmanager
def connected(listener: Listener) -> Iterator[socket.socket]:
    with socket.create_connection(place(listener), timeout=GUARD_S) as client:
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        yield client


def read(client: socket.socket, count: int) -> bytes:
    data = bytearray()
    while len(data) < count and (more := client.recv(min(count - len(data), 1 << 20))):
        data += more
    return bytes(data)


@contextmanager
def tcp(**arguments: object) -> Iterator[tuple[Server, Listener]]:
    server = Server(build_simulation(**arguments))  # type: ignore[arg-type]
    listener = server.open_tcp()
    with running(server):
        yield server, listener
