"""A two-wire line that gives back every byte: an echo is never taken for an answer."""

from __future__ import annotations

import pytest

from fatektool.client import Plc
from fatektool.errors import NoAnswer, PlcError
from fatektool.protocol.commands import Loopback, ReadBriefStatus, ReadMixed, ReadRegisters, RunStop
from fatektool.protocol.elements import Element
from tests.exchange.peer import (
    RUNNING,
    SILENCE,
    STATUS,
    STOP,
    Pieces,
    Rules,
    Script,
    frame,
    linked,
    nonce,
    read_registers,
    register,
    soon,
)

R0 = ReadRegisters(Element.parse("R0"), 1)
ASK_R0, ZERO = read_registers(0), register(0xA000)
RUN = frame("411")
DD_READ = ReadMixed(tuple(Element.parse(f"DD{place}") for place in range(0, 16, 2)))
ASK_DD = frame("4808" + "".join(f"DD{place:05}" for place in range(0, 16, 2)))


def test_an_echo_is_counted_and_dropped() -> None:
    link = linked(Rules({ASK_R0: ZERO}, echo=True))
    assert link.ask(R0) == (0xA000,)
    assert link.ask(R0) == (0xA000,)
    assert link.counters.echoes == 2
    assert link.counters.trouble == 0


@pytest.mark.parametrize("data", [b"A", b"", b"0", b"7", b"x" * 256])
def test_loopback(data: bytes) -> None:
    peer = Rules(echo=True)
    link = linked(peer)
    assert link.ask(Loopback(data)) == data
    assert link.ask(Loopback(data)) == data
    assert link.counters.echoes == 3
    assert link.counters.trouble == 0
    assert peer.heard[0] == STATUS  # it is learned first that the line echoes


@pytest.mark.parametrize(
    "request_", [Loopback(b"A"), RunStop(run=True), RunStop(run=False), ReadBriefStatus(), R0, DD_READ]
)
def test_a_dead_plc_on_an_echoing_line(request_: Loopback) -> None:
    for retries in range(3):
        link = linked(Rules(echo=True, dead=True), retries=retries)
        for _ in range(2):
            with pytest.raises(NoAnswer, match="received its own request only") as caught:
                link.ask(request_)
            assert "A and B" in str(caught.value.hint)


@pytest.mark.parametrize(("request_", "raw"), [(RunStop(run=True), RUN), (RunStop(run=False), STOP)])
def test_stop_and_run(request_: RunStop, raw: bytes) -> None:
    peer = Rules({STOP: STOP, RUN: frame("410")}, echo=True)
    link = linked(peer)
    link.ask(request_)
    assert peer.heard == [STATUS, raw]
    assert link.counters.trouble == 0


def test_a_refused_run_is_told_from_the_echo_of_run() -> None:
    peer = Rules({RUN: frame("415")}, echo=True)
    with pytest.raises(PlcError, match="ladder checksum error"):
        linked(peer).ask(RunStop(run=True))
    peer = Rules({RUN: frame("411")}, echo=True)  # error 1, as no paper has it
    with pytest.raises(PlcError, match="error 1"):
        linked(peer).ask(RunStop(run=True))


def test_a_stop_that_only_the_line_answers_is_found_out() -> None:
    # The echo of STOP is its good answer. The PLC did not hear it.
    peer = Rules({STATUS: RUNNING, STOP: lambda _: SILENCE}, echo=True)
    plc = Plc(linked(peer), "rs485")
    with pytest.raises(NoAnswer, match="run or stop"):
        plc.stop()
    assert peer.heard.count(STOP) == 4


def test_mixed_reads_that_look_like_their_request() -> None:
    values = "".join(f"{place:08X}" for place in range(8))
    peer = Rules({ASK_DD: frame("480" + values)}, echo=True)
    link = linked(peer)
    for _ in range(2):
        assert link.ask(DD_READ) == tuple(range(8))
    assert link.counters.strays == 0


def test_the_echo_of_a_mixed_read_of_hex_letters_is_no_answer() -> None:
    # 48, n = 08, eight 32-bit elements: the figures of request and answer are of the same kind and number.
    peer = Rules({ASK_DD: lambda _: SILENCE}, echo=True)
    with pytest.raises(NoAnswer):
        linked(peer, retries=1).ask(DD_READ)


def test_a_fence_on_an_echoing_line_needs_both_copies() -> None:
    dead_behind = Script(
        [(0.0, ASK_R0)],  # the echo, and then nothing
        *[[(0.0, nonce(number))] for number in range(4)],
    )
    with pytest.raises(NoAnswer, match="own request only"):
        linked(dead_behind).ask(R0)
    assert dead_behind.heard == [ASK_R0, nonce(0), nonce(1), nonce(2), nonce(3)]


def test_an_echo_that_was_not_there_before_casts_a_doubt() -> None:
    peer = Rules({ASK_R0: ZERO})
    link = linked(peer)
    link.ask(Loopback(b"A"))
    peer.echo = True  # somebody plugs in another adapter
    assert link.ask(R0) == (0xA000,)
    assert link.unsolicited == 1
    assert link.ask(Loopback(b"A")) == b"A"
    assert link.ask(R0) == (0xA000,)


def test_a_damaged_echo_does_not_teach_that_there_is_none() -> None:
    def echo_and_answer(asked: int) -> Pieces:
        echo = STATUS if asked else b"\x020150C7\x03"  # the first is damaged on the way
        return [(0.0, echo), (0.01, RUNNING)]

    peer = Rules({STATUS: echo_and_answer, STOP: lambda _: [(0.0, STOP)]})
    for fence in map(nonce, range(9)):
        peer.answers[fence] = fence + fence
    with pytest.raises(NoAnswer, match="own request only"):
        linked(peer, retries=1).ask(RunStop(run=False))  # its own echo is not its answer


def test_two_answers_to_the_question_whether_the_line_echoes() -> None:
    peer = Rules({STATUS: lambda asked: soon(RUNNING) if asked else soon(RUNNING + RUNNING)})
    link = linked(peer)
    assert link.ask(Loopback(b"A")) == b"A"
    assert link.echoes is False
