"""What one medium does and another does not: broken connections, full buffers, pseudo terminals."""

from __future__ import annotations

import os
import socket
import struct
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import PortBusy, TransportClosed, TransportTimeout
from fatektool.transport import sockets
from fatektool.transport.base import DRAIN_LIMIT, LineSettings
from fatektool.transport.memory import MemoryTransport
from fatektool.transport.serial_line import port as serial_port
from fatektool.transport.serial_line.port import open_serial
from fatektool.transport.tcp import TcpTransport
from fatektool.transport.udp import UdpTransport
from tests.transport.media import (
    LINE,
    PATIENCE_S,
    MemoryPeer,
    ask_twice,
    device,
    listening,
    needs_pty,
    socket_url,
    spy_url,
    tcp,
    udp,
)

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextlib import AbstractContextManager

from tests.platforms import not_in_wine
from tests.transport.media import Medium

MORE_THAN_ANY_BUFFER = bytes(1 << 25)


def hang_up_hard(connection: socket.socket) -> None:
    """Close with a reset instead of an end."""
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    connection.close()


# --- TCP --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("hang_up", [socket.socket.close, hang_up_hard], ids=["end", "reset"])
@pytest.mark.parametrize("noticed_by", ["read", "drain"])
def test_tcp_connects_anew_at_the_next_write(
    hang_up: Callable[[socket.socket], None], noticed_by: str
) -> None:
    with listening() as (server, port), TcpTransport("tcp://plc", ("127.0.0.1", port)) as transport:
        hang_up(server.accept()[0])
        if noticed_by == "read":
            with pytest.raises(TransportClosed, match="tcp://plc"):
                transport.read(16, PATIENCE_S)
            with pytest.raises(TransportClosed, match="closed"):
                transport.read(16, PATIENCE_S)
        else:
            transport.renew()
            assert transport.drain() == b""
        transport.write(b"again")
        other, _ = server.accept()
        with other:
            assert other.recv(16) == b"again"
            other.sendall(b"here")
            assert transport.read(16, PATIENCE_S)[:1] == b"h"


def test_what_came_before_the_end_is_read() -> None:
    with tcp() as medium:
        medium.send(b"last words")
        medium.hang_up()
        data = b""
        while len(data) < len(b"last words"):
            data += medium.transport.read(16, PATIENCE_S)
        assert data == b"last words"
        with pytest.raises(TransportClosed, match="closed the connection"):
            medium.transport.read(16, PATIENCE_S)


def test_tcp_that_cannot_connect_anew_says_so() -> None:
    with listening() as (server, port):
        transport = TcpTransport("tcp://plc", ("127.0.0.1", port))
        server.accept()[0].close()
        server.close()
        transport.renew()
        for _ in range(2):
            with pytest.raises(TransportClosed, match=f"cannot connect to 127.0.0.1 port {port}") as caught:
                transport.write(b"again")
            assert caught.value.hint


def test_tcp_sends_requests_at_once() -> None:
    with tcp() as medium:
        assert isinstance(medium.transport, TcpTransport)
        assert medium.transport._socket is not None
        assert medium.transport._socket.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)


def test_a_babbling_connection_is_not_drained_for_ever() -> None:
    with tcp() as medium:
        medium.send(bytes(4 * DRAIN_LIMIT)[: 1 << 17])
        medium.transport.read(1, PATIENCE_S)
        assert len(medium.transport.drain()) < DRAIN_LIMIT + 4096


@pytest.mark.parametrize("make", [TcpTransport, UdpTransport])
def test_an_error_of_the_system_when_making_a_socket(
    make: Callable[[str, sockets.Address], object],
) -> None:
    resource = pytest.importorskip("resource", reason="no such limit here")
    lowest_free = os.dup(0)
    os.close(lowest_free)
    limits = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (lowest_free, limits[1]))
    try:
        with pytest.raises(TransportClosed, match="Too many open files"):
            make("net://plc", ("127.0.0.1", 500))
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, limits)


# --- a medium that takes no bytes --------------------------------------------------------------------


@pytest.mark.parametrize(
    "make",
    [
        pytest.param(tcp, id="tcp"),
        pytest.param(device, id="device", marks=needs_pty),
        pytest.param(socket_url, id="socket-url"),
        pytest.param(spy_url, id="spy-url", marks=needs_pty),
    ],
)
def test_a_medium_that_takes_no_bytes(
    make: Callable[[], AbstractContextManager[Medium]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sockets, "WRITE_TIMEOUT_S", 0.05)
    monkeypatch.setattr(serial_port, "WRITE_TIMEOUT_S", 0.05)
    size = 1 << 20 if make is device else 1 << 18 if make is spy_url else len(MORE_THAN_ANY_BUFFER)
    with make() as medium, pytest.raises(TransportTimeout, match=r"the write blocked for 0\.05 s"):
        medium.transport.write(MORE_THAN_ANY_BUFFER[:size])


def test_tcp_that_took_half_a_request_starts_afresh(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sockets, "WRITE_TIMEOUT_S", 0.05)
    with listening() as (server, port), TcpTransport("tcp://plc", ("127.0.0.1", port)) as transport:
        stuck, _ = server.accept()
        with stuck, pytest.raises(TransportTimeout):
            transport.write(MORE_THAN_ANY_BUFFER)
        transport.write(b"whole")
        other, _ = server.accept()
        with other:
            assert other.recv(16) == b"whole"


# --- UDP --------------------------------------------------------------------------------------------


def test_udp_hears_nobody_else() -> None:
    with udp() as medium, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        assert isinstance(medium.transport, UdpTransport)
        assert medium.transport._socket is not None
        stranger.sendto(b"stranger", medium.transport._socket.getsockname())
        medium.send(b"plc")
        assert medium.transport.read(64, PATIENCE_S) == b"plc"
        assert medium.transport.drain() == b""


def test_an_empty_datagram_is_nothing() -> None:
    with udp() as medium:
        medium.send(b"")
        with pytest.raises(TransportTimeout):
            medium.transport.read(64, PATIENCE_S)
        medium.send(b"")
        medium.send(b"plc")
        data = b""
        while not data:
            data = medium.transport.drain()
        assert data == b"plc"


@not_in_wine("an unreachable UDP port is not reported")
def test_udp_after_an_unreachable_port_goes_on() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        place = other.getsockname()
    with UdpTransport("udp://plc", place) as transport:
        with pytest.raises(TransportClosed, match="udp://plc") as caught:
            ask_twice(transport)
        assert caught.value.hint
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(place)
            other.settimeout(PATIENCE_S)
            transport.write(b"now?")
            data, client = other.recvfrom(16)
            assert data == b"now?"
            other.sendto(b"yes", client)
            assert transport.read(16, PATIENCE_S) == b"yes"


# --- pseudo terminals -------------------------------------------------------------------------------


@needs_pty
@pytest.mark.parametrize("opening", range(2))
def test_a_pty_opens_with_7e1_again_and_again(opening: int) -> None:
    master, slave = os.openpty()
    try:
        for _ in range(2 + opening):
            notes: list[str] = []
            with open_serial(os.ttyname(slave), LineSettings(9600, "7E1"), note=notes.append) as transport:
                transport.write(b"\x02\x80\xff")
                assert os.read(master, 3) == b"\x02\x80\xff"
                assert transport.serial_settings == "9600 7E1"
            assert "pseudo terminal" in notes[0]
    finally:
        os.close(master)
        os.close(slave)


@needs_pty
def test_two_openings_at_once_are_one_too_many() -> None:
    master, slave = os.openpty()
    name = os.ttyname(slave)
    try:
        with (
            open_serial(name, LINE),
            pytest.raises(PortBusy, match="another program has the port open") as caught,
        ):
            open_serial(name, LINE)
        assert caught.value.hint
        open_serial(name, LINE).close()
    finally:
        os.close(master)
        os.close(slave)


@needs_pty
def test_a_port_that_went_stays_gone() -> None:
    with device() as medium:
        medium.hang_up()
        for _ in range(2):
            with pytest.raises(TransportClosed, match="the port is lost"):
                medium.transport.read(16, PATIENCE_S)
            with pytest.raises(TransportClosed, match="the port is lost"):
                medium.transport.write(b"?")


@needs_pty
def test_a_spied_port_is_spied(capfd: pytest.CaptureFixture[str]) -> None:
    with spy_url() as medium:
        medium.transport.write(b"REQUEST")
        medium.receive(7)
        medium.send(b"ANSWER!")
        data = b""
        while len(data) < len(b"ANSWER!"):
            data += medium.transport.read(16, PATIENCE_S)
    said = capfd.readouterr().err
    assert "TX" in said
    assert "RX" in said


# --- memory -----------------------------------------------------------------------------------------


def test_waiting_in_memory_moves_its_clock_and_nothing_else() -> None:
    peer = MemoryPeer()
    transport = MemoryTransport(peer)
    peer.to_say = [(0.5, b"a"), (0.75, b"b"), (2.0, b"c")]
    transport.write(b"?")
    assert transport.drain() == b""
    with pytest.raises(TransportTimeout):
        transport.read(16, 0.25)
    assert transport.clock() == 0.25
    assert transport.read(16, 0.25) == b"a"  # due with the end of the time-out is in time
    assert transport.clock() == 0.5
    with pytest.raises(TransportTimeout):
        transport.read(16, 0.25 - 1e-9)
    assert transport.read(16, 100) == b"b"
    assert transport.clock() == 0.75
    assert transport.drain() == b""
    assert transport.read(16, 1.25) == b"c"
    assert transport.clock() == 2.0
    transport.close()
    with pytest.raises(TransportClosed):
        transport.write(b"?")
