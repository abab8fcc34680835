"""Late answers: never taken for the next question's."""

from __future__ import annotations

import pytest

from fatektool.errors import NoAnswer
from fatektool.protocol.commands import Loopback, ReadBriefStatus, ReadRegisters
from fatektool.protocol.elements import Element
from tests.exchange.peer import (
    RUNNING,
    SILENCE,
    STATUS,
    STOPPED,
    Pieces,
    Rules,
    Script,
    fences,
    frame,
    linked,
    nonce,
    read_registers,
    register,
    soon,
)

R0 = ReadRegisters(Element.parse("R0"), 1)
R1 = ReadRegisters(Element.parse("R1"), 1)
ASK_R0, ASK_R1 = read_registers(0), read_registers(1)
ZERO, ONE, STALE = register(0xA000), register(0xA001), register(0xDEAD)


def test_an_answer_before_the_fence_is_dropped() -> None:
    peer = Script(
        SILENCE,  # R0
        soon(RUNNING),  # does this line echo?
        soon(STALE, nonce(0)),  # the fence: first what is late, then its own answer
        soon(ZERO),  # R0 again
    )
    link = linked(peer)
    assert link.ask(R0) == (0xA000,)
    assert peer.heard == [ASK_R0, STATUS, nonce(0), ASK_R0]
    assert link.counters.strays == 1
    assert link.unsolicited == 0  # it was owed


def test_an_answer_between_two_requests_puts_up_a_fence() -> None:
    peer = Script([(0.01, ZERO), (0.01, STALE)], soon(nonce(0)), soon(ONE))
    link = linked(peer)
    assert link.ask(R0) == (0xA000,)
    assert link.ask(R1) == (0xA001,)
    assert peer.heard == [ASK_R0, nonce(0), ASK_R1]
    assert link.unsolicited == 1  # nobody asked for it


def test_half_an_answer_left_over_is_not_glued_to_the_next() -> None:
    peer = Script(soon(ZERO + STALE[:8]), soon(STALE[8:], nonce(0)), soon(ONE))
    link = linked(peer)
    assert link.ask(R0) == (0xA000,)
    assert link.ask(R1) == (0xA001,)
    assert peer.heard == [ASK_R0, nonce(0), ASK_R1]


def test_a_late_answer_behind_the_fence_is_one_to_the_same_question() -> None:
    # Only a medium that changes the order can do that; the one behind it is seen before the next request.
    peer = Script(
        SILENCE,
        soon(RUNNING),
        soon(nonce(0)),
        [(0.01, ZERO), (0.01, ZERO)],
        soon(nonce(1)),
        soon(ONE),
    )
    link = linked(peer)
    assert link.ask(R0) == (0xA000,)
    assert link.ask(R1) == (0xA001,)
    assert peer.heard[-2:] == [nonce(1), ASK_R1]


def test_only_the_last_nonce_brings_the_fence_down() -> None:
    peer = Script(
        SILENCE,  # R0
        soon(RUNNING),
        SILENCE,  # fence 0
        soon(STALE, nonce(0)),  # fence 1: what was late comes, and the echo of fence 0
        soon(nonce(1), nonce(2)),  # fence 2: the same once more
        soon(ONE),
    )
    link = linked(peer)
    assert link.ask(R1) == (0xA001,)
    assert peer.heard == [ASK_R1, STATUS, nonce(0), nonce(1), nonce(2), ASK_R1]


def test_one_behind_for_ever_is_no_answer_and_no_endless_wait() -> None:
    held: list[bytes] = []

    class OneBehind:
        def receive(self, data: bytes, now: float) -> Pieces:
            held.append({ASK_R0: ZERO, ASK_R1: ONE, STATUS: RUNNING}.get(data, data))
            return [(now + 0.01, held[-2])] if len(held) > 1 else SILENCE

    link = linked(OneBehind())
    for request in (R0, R1, R0):
        with pytest.raises(NoAnswer):
            link.ask(request)


def test_a_loopback_takes_its_own_answer_only() -> None:
    peer = Rules({frame("4EB"): lambda _: soon(frame("4EA"), frame("4EB"))})
    link = linked(peer)
    assert link.ask(Loopback(b"A")) == b"A"
    assert link.ask(Loopback(b"B")) == b"B"
    assert link.counters.strays == 1


@pytest.mark.parametrize("delay_s", [0.55, 0.8, 1.0, 1.5, 1.9])
def test_a_slow_plc_is_understood_and_given_more_time(delay_s: float) -> None:
    class Slow:
        """Answers one after the other, each with the same delay."""

        def __init__(self) -> None:
            self.values = {ASK_R0: ZERO, ASK_R1: ONE, STATUS: RUNNING}

        def receive(self, data: bytes, now: float) -> Pieces:
            return [(now + delay_s, self.values.get(data, data))]

    link = linked(Slow(), retries=5)
    assert link.ask(R0) == (0xA000,)
    for _ in range(5):
        assert link.ask(R1) == (0xA001,)
        assert link.ask(R0) == (0xA000,)
    before = link.counters.exchanges
    assert link.ask(R1) == (0xA001,)
    assert link.ask(R0) == (0xA000,)
    assert link.counters.exchanges == before + 2  # in time by now


def test_a_silent_plc_is_not_given_more_time() -> None:
    peer = Script()
    link = linked(peer)
    for _ in range(3):
        with pytest.raises(NoAnswer):
            link.ask(R0)
    gaps = [after - before for before, after in zip(peer.times, peer.times[1:], strict=False)]
    assert max(gaps) < 0.6


def test_patience_has_an_end() -> None:
    def late(_: int) -> Pieces:
        return [(10.0, ZERO)]

    link = linked(Rules({ASK_R0: late}), retries=3)
    for _ in range(6):
        with pytest.raises(NoAnswer):
            link.ask(R0)
    assert 0.5 <= link.state.wait_s <= 4 * 0.5


# --- a PLC without 4E -------------------------------------------------------------------------------


@pytest.mark.parametrize("refuses", [False, True])
def test_a_plc_without_loopback_serves_a_clean_line(refuses: bool) -> None:
    peer = Rules({ASK_R0: ZERO, nonce(0): frame("4E4") if refuses else b""}, loopback=False)
    notes: list[str] = []
    link = linked(peer, notes=notes)
    assert link.ask(R0) == (0xA000,)
    assert link.fences.pass_last() is False
    assert "does not answer the loopback (4E)" in notes[0]
    assert link.ask(R0) == (0xA000,)
    assert link.counters.fences == 0


def test_a_plc_without_loopback_is_not_trusted_after_a_doubt() -> None:
    peer = Rules({ASK_R0: lambda asked: soon(ZERO) if asked else SILENCE}, loopback=False)
    with pytest.raises(NoAnswer):
        linked(peer).ask(R0)
    peer = Rules({ASK_R0: lambda _: soon(ZERO + b"noise")}, loopback=False)
    link = linked(peer)
    assert link.ask(R0) == (0xA000,)
    with pytest.raises(NoAnswer):
        link.fences.pass_last()


def test_a_loopback_that_was_answered_once_is_owed_ever_after() -> None:
    peer = Rules({ASK_R0: ZERO, nonce(1): lambda _: SILENCE, nonce(2): lambda _: SILENCE})
    link = linked(peer, retries=1)
    assert link.fences.pass_last() is True
    with pytest.raises(NoAnswer):
        link.fences.pass_last()


def test_a_refused_fence_leaves_it_to_silence() -> None:
    """The refusal of what the link asks for itself is not told as that of what it was asked."""
    peer = Rules({ASK_R0: lambda asked: soon(ZERO) if asked else SILENCE}, loopback=False)
    peer.answers |= {nonce(number): frame("4E4") for number in range(4)}
    link = linked(peer)
    assert link.ask(R0) == (0xA000,)
    assert peer.heard == [ASK_R0, STATUS, nonce(0), ASK_R0]
    assert peer.times[3] - peer.times[2] > 0.5  # as long as a PLC may take, nothing was heard
    assert link.counters.fences == 0


def test_a_public_fence_is_one_loopback_once_the_line_is_known() -> None:
    peer = Rules({STATUS: STOPPED})
    link = linked(peer)
    assert not link.ask(ReadBriefStatus()).flags.running
    link.fence()
    link.fence()
    assert peer.heard == [STATUS, nonce(0), nonce(1)]
    assert fences(peer.heard) == link.counters.fences == 2
