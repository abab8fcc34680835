"""M-series through real listeners: a socket, datagrams, a serial port on a pty; and spoiled on the way."""

from __future__ import annotations

import socket
from typing import TYPE_CHECKING

import pytest
import serial

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.pty import PTY_SUPPORTED
from fatektool.simulator.listen.servers import Server, running
from tests.guard import GUARD_S
from tests.simulator.listen.listeners import connected, place, read, tcp
from tests.simulator.slaves.mseries_wire import framed, reply, request
from tests.simulator.wire import sent

if TYPE_CHECKING:
    from pathlib import Path

ASK, ANSWER = request("4601'R'0007"), reply("46000000")
LOOPBACK = framed(b"\x01\x4e" + bytes(range(256)))


def test_tcp() -> None:
    with tcp(protocol="mseries") as (_, listener), connected(listener) as client:
        client.sendall(ASK * 100)
        assert read(client, 100 * len(ANSWER)) == ANSWER * 100
        for at in range(len(LOOPBACK)):
            client.sendall(LOOPBACK[at : at + 1])
        assert read(client, len(LOOPBACK)) == b"\x52" + LOOPBACK[1:]
        client.sendall(b"\x51\x10\x01\x00\x55\xaa" + request("40", station=9) + ASK + ASK[:5])
        assert read(client, len(ANSWER)) == ANSWER
        with connected(listener) as other:
            other.sendall(request("4701'R'00071234"))
            assert read(other, len(reply("4700"))) == reply("4700")
        client.sendall(ASK[5:])
        assert read(client, len(ANSWER)) == reply("46001234")


def test_udp() -> None:
    server = Server(build_simulation(protocol="mseries", baud=115200))
    listener = server.open_udp()
    with running(server), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.settimeout(GUARD_S)
        client.sendto(ASK[:6], place(listener))
        client.sendto(LOOPBACK, place(listener))
        assert client.recv(1000) == b"\x52" + LOOPBACK[1:]
        client.sendto(ASK, place(listener))
        assert client.recv(1000) == ANSWER


@pytest.mark.skipif(not PTY_SUPPORTED, reason="no pseudo terminals here")
def test_pty(tmp_path: Path) -> None:
    server = Server(build_simulation(protocol="mseries", baud=921600))
    server.open_pty(tmp_path / "plc")
    with running(server), serial.Serial(str(tmp_path / "plc"), timeout=GUARD_S) as port:
        # Every byte passes as it is: 11H and 13H, line ends, FFH.
        port.write(LOOPBACK)
        assert port.read(len(LOOPBACK)) == b"\x52" + LOOPBACK[1:]
        port.write(ASK)
        assert port.read(len(ANSWER)) == ANSWER


def test_a_character_has_eleven_bits_unless_told_otherwise() -> None:
    chars = len(ASK) + len(ANSWER)
    for said, bits in ((None, 11), (10, 10)):
        line = build_simulation(protocol="mseries", baud=9600, bits_per_char=said).line()
        assert line.receive(ASK, 0.0)[-1][0] == pytest.approx(chars * bits / 9600)


def story(*faults: str) -> list[bytes]:
    line = build_simulation(protocol="mseries", faults=faults).line()
    return [sent(line, ASK) for _ in range(200)]


def test_flip_hits_every_byte_of_an_answer() -> None:
    hit = set()
    for answer in story("flip=1"):
        places = [at for at, (a, b) in enumerate(zip(answer, ANSWER, strict=True)) if a != b]
        assert len(places) == 1
        hit.update(places)
    assert hit == set(range(len(ANSWER)))


def test_noise_holds_headers_and_terminators() -> None:
    heard = story("noise=1")
    assert all(answer.endswith(ANSWER) and 1 <= len(answer) - len(ANSWER) <= 8 for answer in heard)
    noise = [answer.removesuffix(ANSWER) for answer in heard]
    assert sum(b"\x55\xaa" in each for each in noise) > 20
    assert sum(b"\x52\x10" in each for each in noise) > 20


def test_wrong_station_has_a_right_crc() -> None:
    stations = {answer[4] for answer in story("wrong-station=1")}
    assert len(stations) > 50
    assert not stations & {0, 1, 255}
    assert all(
        answer == reply("46000000", station=answer[4]) for answer in story("wrong-station=1", "echo=0")
    )


def test_the_other_faults_strike_here_too() -> None:
    assert story("drop=1") == [b""] * 200
    assert story("duplicate=1") == [ANSWER * 2] * 200
    assert story("echo=1") == [ASK + ANSWER] * 200
    assert set(story("truncate=1")) == {ANSWER[:length] for length in range(1, len(ANSWER))}
    assert story("late=1")[:3] == [b"", ANSWER, ANSWER]
