"""One exchange: what is taken for the answer, and what is not."""

from __future__ import annotations

from typing import Any

import pytest

from fatektool.errors import FatektoolError, NoAnswer, PlcRefused, TransportClosed, UsageError
from fatektool.exchange.link import Link
from fatektool.protocol.commands import (
    Loopback,
    ReadBriefStatus,
    ReadPage,
    ReadRegisters,
    Request,
    RunStop,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from tests.exchange.peer import (
    RUNNING,
    SILENCE,
    STATUS,
    Pieces,
    Rules,
    Script,
    frame,
    linked,
    nonce,
    page_answer,
    read_registers,
    register,
    soon,
)

R0 = ReadRegisters(Element.parse("R0"), 1)
R1 = ReadRegisters(Element.parse("R1"), 1)
ASK_R0, ASK_R1 = read_registers(0), read_registers(1)
ANSWER = register(0x10F6)
assert ASK_R0 == b"\x02014601R0000070\x03"
assert ANSWER == b"\x020146010F6DA\x03"


def test_a_clean_exchange_is_one_request_and_one_answer() -> None:
    peer = Script(soon(ANSWER))
    link = linked(peer)
    assert link.ask(R0) == (0x10F6,)
    assert peer.heard == [ASK_R0]
    assert link.counters.exchanges == 1
    assert link.counters.trouble == 0
    assert link.counters.bytes_received == len(ANSWER)
    assert link.unsolicited == 0


@pytest.mark.parametrize("size", [1, 2, 3, 7, 12])
def test_an_answer_in_pieces(size: int) -> None:
    pieces = [(0.001 * at, ANSWER[at : at + size]) for at in range(0, len(ANSWER), size)]
    link = linked(Script(pieces))
    assert link.ask(R0) == (0x10F6,)
    assert link.counters.trouble == 0


DIRT = [
    pytest.param(b"\x00\xff~~", id="noise"),
    pytest.param(b"\x03", id="an-end"),
    pytest.param(b"\x02", id="a-beginning"),
    pytest.param(ANSWER[:7], id="a-broken-frame"),
    pytest.param(b"\x02014600000FF\x03", id="bad-lrc-of-another-size"),
    pytest.param(b"\x02zz4600000D9\x03", id="no-station"),
    pytest.param(register(0xBEEF).replace(b"\x0201", b"\x0202")[:-3] + b"61\x03", id="bad-lrc"),
    pytest.param(frame("460BEEF", station=2), id="another-station"),
    pytest.param(frame("460BEEF", station=0), id="station-0"),
    pytest.param(frame("460BEEF", station=255), id="station-255"),
    pytest.param(frame("470"), id="another-command"),
    pytest.param(frame("990BEEF"), id="an-unknown-command"),
    pytest.param(frame("46"), id="no-data"),
    pytest.param(frame("460"), id="too-short"),
    pytest.param(frame("460BEE"), id="one-less"),
    pytest.param(frame("460BEEF0"), id="one-more"),
    pytest.param(frame("46GBEEF"), id="no-error-character"),
    pytest.param(frame("464BEEF"), id="an-error-and-data"),
    pytest.param(frame("4EN0"), id="a-loopback"),
    pytest.param(RUNNING, id="a-status"),
]


@pytest.mark.parametrize("dirt", DIRT)
def test_dirt_before_the_answer_is_dropped_and_counted(dirt: bytes) -> None:
    peer = Rules({ASK_R0: lambda asked: soon(dirt + ANSWER) if not asked else soon(ANSWER)})
    link = linked(peer)
    assert link.ask(R0) == (0x10F6,)
    assert link.counters.trouble >= 1
    assert link.ask(R0) == (0x10F6,)
    assert nonce(0) in peer.heard  # a doubt, and so a fence


@pytest.mark.parametrize("dirt", DIRT)
def test_dirt_alone_is_no_answer(dirt: bytes) -> None:
    peer = Rules({ASK_R0: lambda _: soon(dirt)})
    with pytest.raises(NoAnswer):
        linked(peer, retries=1).ask(R0)
    assert peer.heard.count(ASK_R0) == 2


def test_a_damaged_answer_is_asked_again_at_once() -> None:
    damaged = ANSWER.replace(b"F6", b"F7")
    peer = Rules({ASK_R0: lambda asked: soon(ANSWER if asked else damaged)})
    link = linked(peer)
    assert link.ask(R0) == (0x10F6,)
    assert link.counters.checksum_errors == 1
    assert link.counters.timeouts == 0
    assert link.transport.clock() < 0.1


def test_a_refusal_is_an_answer_and_is_not_tried_again() -> None:
    peer = Rules({ASK_R0: frame("46A")})
    link = linked(peer)
    with pytest.raises(PlcRefused, match="illegal address") as caught:
        link.ask(R0)
    assert caught.value.code == 0xA
    assert peer.heard == [ASK_R0]
    assert link.counters.trouble == 0
    with pytest.raises(PlcRefused):
        link.ask(R0)
    assert peer.heard == [ASK_R0, ASK_R0]


def test_retries_zero_is_one_try() -> None:
    peer = Script()
    with pytest.raises(NoAnswer, match=r"in 1 try, 2\.0 s in total: nothing received"):
        linked(peer, retries=0).ask(R0)
    assert peer.heard == [ASK_R0]


def test_a_live_plc_is_asked_once_and_as_often_as_there_are_retries() -> None:
    for retries in range(5):
        peer = Rules({ASK_R0: lambda _: SILENCE})
        with pytest.raises(NoAnswer):
            linked(peer, retries=retries).ask(R0)
        assert peer.heard.count(ASK_R0) == 1 + retries
        assert sum(request[3:5] == b"4E" for request in peer.heard) == retries


def test_a_broadcast_is_sent_and_not_waited_for() -> None:
    peer = Script()
    link = linked(peer)
    link.broadcast(RunStop(run=False))
    assert peer.heard == [b"\x0200410F7\x03"]
    assert link.transport.clock() == 0


def test_an_echo_of_a_broadcast_is_no_answer() -> None:
    peer = Rules({ASK_R0: ANSWER}, echo=True)
    link = linked(peer)
    link.broadcast(RunStop(run=False))
    assert link.ask(R0) == (0x10F6,)


@pytest.mark.parametrize("station", [-1, 0, 255, 256])
def test_a_station_that_cannot_answer(station: int) -> None:
    with pytest.raises(UsageError, match=f"expected 1 to 254, got {station}"):
        Link(MemoryTransport(Script()), FACON, station, LineSettings())


def test_a_request_that_cannot_be_said_is_not_sent() -> None:
    peer = Script(soon(RUNNING))
    link = linked(peer)
    with pytest.raises(UsageError):
        link.ask(Loopback(b"\x02"))
    assert set(peer.heard) <= {STATUS}
    assert link.counters.trouble == 0


def test_counters_tell_what_was_seen() -> None:
    peer = Rules(
        {
            ASK_R0: lambda asked: [
                soon(b"~~" + ANSWER),
                soon(frame("460BEEF", station=9), ANSWER),
                soon(ANSWER.replace(b"F6", b"F7")),
                SILENCE,
                soon(ANSWER),
            ][asked]
        }
    )
    link = linked(peer)
    for _ in range(3):
        assert link.ask(R0) == (0x10F6,)
    counters = link.counters
    assert (counters.garbled, counters.strays, counters.checksum_errors, counters.timeouts) == (1, 1, 1, 1)
    assert counters.trouble == 4
    assert counters.fences == 4
    assert counters.exchanges == len(peer.heard)
    assert counters.echoes == 0


class Interrupted(MemoryTransport):
    """A line on which somebody presses Ctrl-C during the first wait."""

    pressed = False

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        if not self.pressed:
            self.pressed = True
            raise KeyboardInterrupt
        return super().read(max_bytes, timeout_s)


def test_after_an_interrupt_the_answer_to_come_is_not_the_next_ones() -> None:
    peer = Rules({ASK_R0: lambda _: [(0.3, ANSWER)], ASK_R1: register(1)})
    link = linked(peer, transport=Interrupted(peer))
    with pytest.raises(KeyboardInterrupt):
        link.ask(R0)
    assert link.ask(R1) == (1,)


class Breaking(MemoryTransport):
    """A connection that breaks at some of its writes or reads, and is as good as new at the next."""

    def __init__(self, peer: Rules, writes: set[int], reads: set[int]) -> None:
        super().__init__(peer)
        self.writes, self.reads = writes, reads
        self.written = self.read_so_far = self.renewed = 0

    def write(self, data: bytes) -> None:
        self.written += 1
        if self.written in self.writes:
            raise TransportClosed("the connection broke", hint="look at the cable")
        super().write(data)

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        self.read_so_far += 1
        if self.read_so_far in self.reads:
            raise TransportClosed("the connection broke", hint="look at the cable")
        return super().read(max_bytes, timeout_s)

    def renew(self) -> None:
        self.renewed += 1


@pytest.mark.parametrize(("writes", "reads"), [({1}, set()), (set(), {1}), ({1, 3}, {2})])
def test_a_connection_that_breaks_is_used_again(writes: set[int], reads: set[int]) -> None:
    peer = Rules({ASK_R0: ANSWER})
    link = linked(peer, transport=Breaking(peer, writes, reads))
    assert link.ask(R0) == (0x10F6,)


def test_a_connection_that_stays_broken_says_why_and_soon() -> None:
    peer = Rules()
    for retries in range(5):
        transport = Breaking(peer, set(range(100)), set())
        link = linked(peer, retries=retries, transport=transport)
        with pytest.raises(TransportClosed, match="the connection broke") as caught:
            link.ask(R0)
        assert caught.value.hint == "look at the cable"
        assert transport.written <= retries + 2  # each may cost the time of a vain connection


def test_a_connection_is_renewed_after_two_silences() -> None:
    peer = Rules(dead=True)
    transport = Breaking(peer, set(), set())
    link = linked(peer, retries=3, transport=transport)
    with pytest.raises(NoAnswer):
        link.ask(R0)
    assert transport.renewed == 2
    assert transport.written == 5


class Renewed(MemoryTransport):
    """A connection that is closed when it is renewed, and open again from the next write on, as of TCP."""

    closed = False

    def write(self, data: bytes) -> None:
        self.closed = False
        super().write(data)

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        if self.closed:
            raise TransportClosed("the connection is closed")
        return super().read(max_bytes, timeout_s)

    def renew(self) -> None:
        self.closed = True


@pytest.mark.parametrize("retries", range(4))
@pytest.mark.parametrize("doubt", [False, True])
@pytest.mark.parametrize("writes", [False, True])
def test_a_silence_whose_last_try_was_due_for_a_new_connection(
    retries: int, *, doubt: bool, writes: bool
) -> None:
    link = Link(Renewed(Rules(dead=True)), FACON, 1, LineSettings(), retries=retries)
    link.receiver.needs_fence = doubt
    request: Request[Any] = WriteRegisters(Element("R", 0), (7,)) if writes else R0
    with pytest.raises(NoAnswer, match="nothing received"):
        link.ask(request)


def test_garbage_is_no_reason_to_renew() -> None:
    peer = Rules({ASK_R0: lambda _: soon(b"garbage")})
    transport = Breaking(peer, set(), set())
    link = linked(peer, transport=transport)
    with pytest.raises(NoAnswer):
        link.ask(R0)
    assert transport.renewed == 0


def test_a_page_without_the_error_character_is_taken() -> None:
    data = bytes(range(128))
    page = ReadPage(5)
    for answer in (page_answer(data), frame("4F" + data.hex().upper())):
        assert linked(Script(soon(answer))).ask(page) == data


def test_a_status_is_read_back_as_it_stands_in_the_paper() -> None:
    assert FACON.encode(1, ReadBriefStatus()) == STATUS
    assert linked(Script(soon(RUNNING))).ask(ReadBriefStatus()).flags.running


def test_every_error_of_an_exchange_is_the_projects() -> None:
    chaos: list[Pieces] = [[(0.0, bytes([byte]) * 40)] for byte in range(256)]
    for turn in chaos:
        with pytest.raises(FatektoolError):
            linked(Script(turn, turn, turn), retries=1).ask(R0)
