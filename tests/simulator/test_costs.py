"""What an exchange costs the simulator, counted in calls of the system, not timed."""

from __future__ import annotations

import os
import threading
from collections import Counter
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.pty import PTY_SUPPORTED
from fatektool.simulator.listen.servers import Server, running
from tests.simulator.listen.listeners import ANSWER, ASK, connected, read
from tests.simulator.wire import frame

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_WAITS = {"poll", "control", "select"}  # epoll's, kqueue's, and that of the rest
_CALLS = _WAITS | {"recv", "send", "read", "write", "register", "modify", "unregister"}
EXCHANGES = 50
SLACK = {-1, 0, 1}
"""The wait after an exchange may have begun or not, before the first that counts and after the last."""


@contextmanager
def counted(server: Server) -> Iterator[Counter[str]]:
    """The calls that the server's thread makes of the system, as long as the context lasts."""
    found: Counter[str] = Counter()

    def profile(_frame: object, event: str, called: Any) -> None:
        if event == "c_call" and called.__name__ in _CALLS:
            found["wait" if called.__name__ in _WAITS else called.__name__] += 1

    threading.setprofile(profile)
    try:
        with running(server):
            threading.setprofile(None)
            yield found
    finally:
        threading.setprofile(None)


@pytest.mark.parametrize("clients", [1, 20])
def test_over_tcp_an_exchange_is_one_wait_one_read_and_one_write(clients: int) -> None:
    server = Server(build_simulation())
    listener = server.open_tcp()
    with counted(server) as calls:
        for _ in range(clients):
            with connected(listener) as client:
                client.sendall(ASK)
                assert read(client, len(ANSWER)) == ANSWER
        with connected(listener) as client:
            client.sendall(ASK)
            assert read(client, len(ANSWER)) == ANSWER
            calls.clear()
            for _ in range(EXCHANGES):
                client.sendall(ASK)
                assert read(client, len(ANSWER)) == ANSWER
            found = dict(calls)
    assert found.pop("wait") - EXCHANGES in SLACK
    assert found == {"recv": EXCHANGES, "send": EXCHANGES}


def test_requests_that_come_together_are_read_together() -> None:
    server = Server(build_simulation())
    listener = server.open_tcp()
    with counted(server) as calls, connected(listener) as client:
        client.sendall(ASK)
        assert read(client, len(ANSWER)) == ANSWER
        calls.clear()
        client.sendall(ASK * EXCHANGES)
        assert read(client, EXCHANGES * len(ANSWER)) == ANSWER * EXCHANGES
        assert calls["recv"] == 1
        assert calls["send"] <= EXCHANGES


@pytest.mark.skipif(not PTY_SUPPORTED, reason="no pseudo terminals here")
def test_over_a_pty_without_a_pace_the_same(tmp_path: Path) -> None:
    server = Server(build_simulation())
    listener = server.open_pty(tmp_path / "plc")
    client = os.open(listener.address, os.O_RDWR | os.O_NOCTTY)
    with counted(server) as calls:
        for exchange in range(1 + EXCHANGES):
            os.write(client, ASK)
            answer = b""
            while len(answer) < len(ANSWER):
                answer += os.read(client, len(ANSWER) - len(answer))
            assert answer == ANSWER
            if not exchange:
                calls.clear()
        found = dict(calls)
    os.close(client)
    assert found.pop("wait") - EXCHANGES in SLACK
    assert found == {"read": EXCHANGES, "write": EXCHANGES}


def test_a_page_is_put_into_its_frame_once() -> None:
    """A program that 500 clients read is turned into hex once."""
    from fatektool.simulator.slaves.facon.slave import _page_answer

    simulation = build_simulation(ladder_words=8192)
    asks = [frame(f"4F{page:04X}") for page in range(129)]
    _page_answer.cache_clear()
    for _ in range(3):
        line = simulation.line()
        for ask in asks:
            line.receive(ask, 0.0)
    assert _page_answer.cache_info().misses == len({*simulation.plcs[1].pages})
