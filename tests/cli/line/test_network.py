"""``scan --network``: who answers a call on UDP, which goes to the address that is named alone."""

from __future__ import annotations

import math
import socket
import threading
from itertools import chain, repeat
from types import SimpleNamespace
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import LineError
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.discovery import ANSWER
from fatektool.simulator.listen.servers import Server, running
from fatektool.transport import discovery
from fatektool.transport.discovery import REQUESTS, discover
from tests.guard import GUARD_S

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.cli.running import Cli


@pytest.fixture
def answer_port(monkeypatch: pytest.MonkeyPatch) -> int:
    """A free port in place of 53238, which one test at a time could have."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("", 0))
        port = int(taken.getsockname()[1])
    monkeypatch.setattr(discovery, "ANSWER_PORT", port)
    return port


def listen_to(datagrams: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have the time for answers end when so many datagrams were received."""
    moments = chain(repeat(0.0, 1 + datagrams), repeat(math.inf))
    monkeypatch.setattr(discovery, "time", SimpleNamespace(perf_counter=lambda: next(moments)))


@pytest.fixture
def module(answer_port: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A simulated module, which answers both requests; its address."""
    listen_to(len(REQUESTS), monkeypatch)
    server = Server(build_simulation([1]))
    door = server.open_discovery("127.0.0.1", 0, answer_port)
    with running(server):
        yield door.address.removeprefix("discovery://")


def test_the_bytes_of_the_call() -> None:
    """As the driver that uses them sends them."""
    assert [request.hex(" ").upper() for request in REQUESTS] == [
        "13 0C 2F 9B 77 70 89 AA",
        "09 50 83 04 5A 22 00 22",
    ]
    assert (discovery.MODULE_PORT, discovery.ANSWER_PORT, len(ANSWER)) == (111, 53238, 351)


def test_a_module_answers_and_is_told_once(module: str, cli: Cli) -> None:
    done = cli("scan", "--network", module, "--timeout", GUARD_S)
    assert done.code == 0
    head, *lines = done.out.splitlines()
    assert head == "127.0.0.1  351 bytes; their meaning is not documented:"
    assert len(lines) == 22  # of 16 bytes each
    assert lines[0].startswith("  0000  66 61 74 65 6B 74 6F 6F")
    assert "1 module answered at 127.0.0.1" in done.err


def test_the_document_keeps_every_byte(module: str, cli: Cli) -> None:
    document = cli("scan", "--network", module, "--timeout", GUARD_S, "--json").document("network")
    (answer,) = document["answers"]
    assert bytes.fromhex(answer["hex"]) == ANSWER
    assert (answer["address"], answer["bytes"]) == ("127.0.0.1", 351)
    assert document["target"] == module
    assert [bytes.fromhex(request) for request in document["requests"]] == list(REQUESTS)


def test_nobody_there(answer_port: int, cli: Cli) -> None:
    del answer_port
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as deaf:
        deaf.bind(("127.0.0.1", 0))
        port = deaf.getsockname()[1]
        done = cli("scan", "--network", f"127.0.0.1:{port}", "--timeout", "0.05")
        assert done.code == 1
        assert "no modules answered at 127.0.0.1" in done.err
        deaf.settimeout(5)
        heard = [deaf.recvfrom(100)[0] for _ in REQUESTS]
    assert heard == list(REQUESTS)  # the call, once, and nothing else


def test_an_answer_of_anybody_is_kept_as_it_is(answer_port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Short ones too; the same one twice and the call itself, as a broadcast brings it back, are left out."""
    said = (b"\0" * 400, b"short", b"short", REQUESTS[0], REQUESTS[1], b"")
    listen_to(len(said), monkeypatch)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as module:
        module.bind(("127.0.0.1", 0))
        module.settimeout(5)

        def answers() -> None:
            module.recvfrom(100)
            for data in said:
                module.sendto(data, ("127.0.0.1", answer_port))

        thread = threading.Thread(target=answers)
        thread.start()
        found = discover("127.0.0.1", int(module.getsockname()[1]), listen_s=GUARD_S, answer_port=answer_port)
        thread.join()
    assert [answer.data for answer in found] == [b"\0" * 400, b"short", b""]


def test_the_port_is_in_use(answer_port: int, cli: Cli) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("", answer_port))
        done = cli("scan", "--network", "127.0.0.1")
    assert done.code == 3
    assert f"UDP port {answer_port} of this computer cannot be used" in done.err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--network", ":1"], "expected HOST or HOST:PORT"),
        (["--network", "h:99999"], "expected HOST or HOST:PORT"),
        (["--network", "h:x"], "expected HOST or HOST:PORT"),
        (["--network", "h", "-p", "sim:"], "--network does not go with --port"),
        (["--network", "h", "--bauds", "all"], "--network does not go with --bauds"),
        (["--network", "h", "--trace", "t.pcap"], "--network does not go with --trace"),
        (["--network", "h", "-s", "3"], "--network does not go with --station"),
    ],
)
def test_what_does_not_go_with_it(words: list[str], told: str, cli: Cli) -> None:
    done = cli("scan", *words)
    assert done.code == 2
    assert told in done.err


def test_a_name_that_nobody_knows(answer_port: int) -> None:
    with pytest.raises(LineError, match="no such address"):
        discover("no.such.name.invalid", listen_s=0.05, answer_port=answer_port)
