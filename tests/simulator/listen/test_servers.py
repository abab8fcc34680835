"""Real sockets, served by a thread of this process."""

from __future__ import annotations

import select
import selectors
import socket
from contextlib import closing
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import DataError, LineError
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running
from tests.guard import GUARD_S
from tests.platforms import not_in_wine
from tests.simulator.listen.listeners import ANSWER, ASK, PAGE_HEX, connected, place, read, tcp
from tests.simulator.wire import frame

if TYPE_CHECKING:
    from pathlib import Path


def test_tcp() -> None:
    with tcp() as (_, listener), connected(listener) as client:
        assert listener.address.startswith("tcp://127.0.0.1:")
        for _ in range(3):
            client.sendall(ASK)
            assert read(client, len(ANSWER)) == ANSWER
        for at in range(len(ASK)):
            client.sendall(ASK[at : at + 1])
        assert read(client, len(ANSWER)) == ANSWER
        client.sendall(ASK * 200)
        assert read(client, 200 * len(ANSWER)) == ANSWER * 200


def test_connections_share_the_plc_and_not_the_framing() -> None:
    with tcp() as (_, listener), connected(listener) as one, connected(listener) as other:
        one.sendall(ASK[:5])
        other.sendall(frame("4701R000071234"))
        assert read(other, 9) == frame("470")
        one.sendall(ASK[5:])
        assert read(one, len(ANSWER)) == frame("4601234")


def test_a_client_that_closes_its_half_still_hears_the_answer() -> None:
    # At this pace the answer is long not due when the end of the requests is seen.
    with tcp(baud=115200) as (_, listener), connected(listener) as client:
        client.sendall(frame("4F0000"))
        client.shutdown(socket.SHUT_WR)
        assert len(read(client, 1000)) == 265


def test_a_client_that_goes_leaves_the_others() -> None:
    with tcp(baud=921600) as (_, listener), connected(listener) as stays:
        for _ in range(5):
            with connected(listener) as goes:
                goes.sendall(frame("4F0000") * 20)
        stays.sendall(ASK)
        assert read(stays, len(ANSWER)) == ANSWER


@pytest.mark.parametrize(
    "baud", [None, pytest.param(1e9, marks=not_in_wine("a wait of microseconds takes it many times that"))]
)
def test_a_client_that_does_not_read_is_held_back(baud: float | None) -> None:
    with tcp(baud=baud) as (_, listener), connected(listener) as client, connected(listener) as other:
        for buffer in (socket.SO_SNDBUF, socket.SO_RCVBUF):
            client.setsockopt(socket.SOL_SOCKET, buffer, 1 << 15)
        requests = frame("4F0000") * 1000
        sent = 0
        while select.select([], [client], [], 0.2)[1]:
            sent += client.send(requests[sent % len(requests) :])
        other.sendall(ASK)
        assert read(other, len(ANSWER)) == ANSWER
        client.shutdown(socket.SHUT_WR)
        answers = read(client, 1 << 30)
        assert len(answers) == sent // 12 * 265


def test_an_answer_larger_than_the_buffers_comes_whole() -> None:
    with tcp() as (_, listener), connected(listener) as client:
        client.sendall(frame("4F0000") * 3000)
        assert len(read(client, 3000 * 265)) == 3000 * 265


@pytest.mark.parametrize("baud", [None, 921600.0])
def test_paced_and_not(baud: float | None) -> None:
    with tcp(baud=baud, faults=["duplicate=1"]) as (_, listener), connected(listener) as client:
        page = frame("4F0001")
        expected = frame("4F0" + build_simulation().plcs[1].pages[1].hex().upper())
        for _ in range(5):
            client.sendall(page)
            assert read(client, 2 * len(expected)) == expected * 2


def test_a_wait_without_a_descriptor(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(selectors, "DefaultSelector", selectors.SelectSelector)
    with tcp(baud=115200) as (_, listener), connected(listener) as client:
        client.sendall(ASK)
        assert read(client, len(ANSWER)) == ANSWER


@pytest.mark.skipif(not hasattr(selectors, "EpollSelector"), reason="needs a selector with a descriptor")
def test_a_wait_with_a_descriptor_that_select_cannot_name(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise ValueError

    monkeypatch.setattr("fatektool.simulator.listen.reactor.select.select", refuse)
    with tcp(baud=115200) as (_, listener), connected(listener) as client:
        client.sendall(ASK)
        assert read(client, len(ANSWER)) == ANSWER


def test_udp() -> None:
    server = Server(build_simulation(baud=921600))
    listener = server.open_udp()
    with running(server), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.settimeout(GUARD_S)
        assert listener.address.startswith("udp://127.0.0.1:")
        # A datagram stands by itself: neither half is a request, and nothing is left of them.
        for data in (ASK[:5], ASK[5:], ASK + ASK):
            client.sendto(data, place(listener))
        assert [client.recv(1000), client.recv(1000)] == [ANSWER, ANSWER]
        client.sendto(frame("4F0000"), place(listener))
        assert len(client.recv(1000)) == 265


def test_udp_answers_the_sender() -> None:
    server = Server(build_simulation())
    listener = server.open_udp()
    with running(server):
        for _ in range(100):
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
                client.settimeout(GUARD_S)
                client.sendto(ASK, place(listener))
                assert client.recv(1000) == ANSWER


def test_power_cut_closes_connections_and_refuses_new_ones() -> None:
    simulation = build_simulation(faults=["power-cut=2"])
    server = Server(simulation)
    listeners = [server.open_tcp(), server.open_tcp()]
    with running(server), connected(listeners[0]) as client, connected(listeners[1]) as other:
        client.sendall(frame("500000" + PAGE_HEX))
        assert read(client, 9) == frame("500")
        other.sendall(ASK)
        assert read(other, len(ANSWER)) == ANSWER
        client.sendall(frame("500001" + PAGE_HEX) + ASK)
        assert read(client, 100) == b""
        assert read(other, 100) == b""
        with connected(listeners[0]) as refused:
            assert read(refused, 100) == b""
        simulation.power_on()
        with connected(listeners[0]) as again:
            again.sendall(ASK)
            assert read(again, len(ANSWER)) == ANSWER


@not_in_wine("two servers can share a port")
def test_a_port_in_use_is_one_clear_line() -> None:
    with closing(Server(build_simulation())) as server:
        host, port = place(server.open_tcp())
        with pytest.raises(LineError) as refused:
            server.open_tcp(host, port)
        assert f"cannot listen on tcp://127.0.0.1:{port}: " in str(refused.value)
        assert "\n" not in str(refused.value)
        for host, port in (
            ("127.0.0.1", 65536),
            ("192.0.2.1", 0),
            ("x" * 70, 0),
        ):
            with pytest.raises(LineError, match="cannot listen on udp://"):
                server.open_udp(host, port)


@pytest.mark.skipif(not socket.has_ipv6, reason="no IPv6 here")
def test_an_ipv6_address_in_words() -> None:
    with closing(Server(build_simulation())) as server:
        try:
            listener = server.open_tcp("::1", 0)
        except LineError:
            pytest.skip("no IPv6 address here")
        assert listener.address.startswith("tcp://[::1]:")
        with pytest.raises(LineError, match=r"tcp://\[::1\]:"):
            server.open_tcp(*place(listener))


def test_stop_before_serving_and_a_predicate() -> None:
    with closing(Server(build_simulation())) as server:
        server.stop()
        server.serve_until()
        server.serve_until(lambda: True)
        server.close()


def test_close_gives_the_port_back() -> None:
    with tcp() as (_, listener):
        address = place(listener)
        with connected(listener) as client:
            client.sendall(ASK)
            assert read(client, len(ANSWER)) == ANSWER
    with pytest.raises(OSError, match=r"."), socket.create_connection(address, timeout=GUARD_S):
        pass


def test_a_failure_of_the_thread_is_not_lost(tmp_path: Path) -> None:
    folder = tmp_path / "plc"
    folder.mkdir()
    server = Server(build_simulation(state=folder / "state.json"))
    listener = server.open_tcp()
    (folder / "state.json").unlink()
    folder.rmdir()
    failing = running(server)
    failing.__enter__()
    with connected(listener) as client:
        client.sendall(frame("411"))
        assert read(client, 1) == b""
    with pytest.raises(DataError, match="cannot be written"):
        failing.__exit__(None, None, None)
