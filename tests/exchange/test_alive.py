"""A line that is open: is anybody there, and another station on it."""

from __future__ import annotations

import pytest

import fatektool
from fatektool.client import Plc
from fatektool.errors import NoAnswer, UsageError
from fatektool.protocol.commands import ReadRegisters
from fatektool.protocol.elements import Element
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running
from tests.exchange.peer import (
    RUNNING,
    SILENCE,
    STATUS,
    Script,
    frame,
    linked,
    nonce,
    read_registers,
    register,
    soon,
)

R0 = ReadRegisters(Element.parse("R0"), 1)


def test_is_open_until_it_is_closed() -> None:
    plc = fatektool.connect("sim:")
    assert plc.is_open
    assert plc.is_alive()
    plc.close()
    assert not plc.is_open
    assert not plc.is_alive()
    plc.close()


def test_is_alive_asks_one_harmless_thing() -> None:
    peer = Script(soon(RUNNING))
    assert Plc(linked(peer), "x").is_alive()
    assert peer.heard == [STATUS]


def test_a_refusal_is_an_answer() -> None:
    assert Plc(linked(Script(soon(frame("404")))), "x").is_alive()


def test_silence_is_not_alive() -> None:
    peer = Script(*[SILENCE] * 9)
    assert not Plc(linked(peer), "x").is_alive()
    assert 1 <= len(peer.heard) <= 9


def test_another_station_on_an_open_line() -> None:
    server = Server(build_simulation([1, 7]))
    address = server.open_tcp().address
    with running(server), fatektool.connect(address, timeout_s=5) as plc:
        plc.write_registers(Element.parse("R0"), [11])
        plc.station = 7
        assert plc.station == 7
        assert plc.read_registers(Element.parse("R0"), 1) == (0,)
        plc.write_registers(Element.parse("R0"), [77])
        plc.station = 1
        assert plc.read_registers(Element.parse("R0"), 1) == (11,)


@pytest.mark.parametrize("station", [0, -1, 999])
def test_a_station_that_no_plc_has(station: int) -> None:
    with fatektool.connect("sim:") as plc:
        with pytest.raises(UsageError, match="station: expected 1 to"):
            plc.station = station
        assert plc.station == 1
        assert plc.is_alive()


def test_a_late_answer_of_the_station_before_is_not_taken_when_it_is_asked_again() -> None:
    """Station 1 owes an answer; station 2 is asked meanwhile; back at 1 a fence comes first."""
    stale, right = register(0xDEAD), register(0xA000)
    peer = Script(
        SILENCE,  # R0 of station 1
        soon(frame("4EN0", 2)),  # the fence of station 2
        soon(frame("460B000", 2)),
        soon(stale, nonce(1)),  # back at station 1: the fence, and what was late
        soon(right),
    )
    plc = Plc(linked(peer, retries=0), "x")
    plc.link.state.echoes = False
    with pytest.raises(NoAnswer):
        plc.link.ask(R0)
    plc.station = 2
    assert plc.link.ask(R0) == (0xB000,)
    plc.station = 1
    assert plc.link.ask(R0) == (0xA000,)
    assert peer.heard == [
        read_registers(0),
        frame("4EN0", 2),
        frame("4601R00000", 2),
        nonce(1),
        read_registers(0),
    ]
