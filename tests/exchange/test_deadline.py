"""How long a try, an exchange and a dead line take, exactly, on a clock of their own."""

from __future__ import annotations

import pytest

from fatektool.errors import NoAnswer, TransportTimeout
from fatektool.exchange.link import Link
from fatektool.protocol.commands import Loopback, ReadBriefStatus, ReadPage, ReadRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from tests.exchange.peer import (
    BYTE_S,
    SILENCE,
    Pieces,
    Rules,
    Script,
    ask_page,
    fences,
    frame,
    linked,
    page_answer,
    register,
)
from tests.rows import each

R0 = ReadRegisters(Element.parse("R0"), 1)
ASK_R0_BYTES, ANSWER_R0_BYTES = 16, 13
STATUS_BYTES = 8 + 15
FENCE_BYTES = 2 * len(b"\x02014EN0XX\x03")


@each(
    ("line", "byte_s"),
    [
        (LineSettings(), 10 / 9600),
        (LineSettings(4800, "8E2"), 12 / 4800),
        (LineSettings(921600, "8N1"), 10 / 921600),
    ],
)
@each("timeout_s", [0.05, 0.5, 30.0])
@each(
    ("request_", "size"),
    [
        (R0, ASK_R0_BYTES + ANSWER_R0_BYTES),
        (ReadBriefStatus(), STATUS_BYTES),
        (ReadPage(0), 12 + 265),
        (ReadRegisters(Element.parse("R0"), 64), 16 + 9 + 256),
    ],
)
def test_one_try_is_the_wire_time_of_both_frames_and_the_plcs_time_and_a_listening_for_what_is_late(
    line: LineSettings, byte_s: float, timeout_s: float, request_: ReadPage, size: int
) -> None:
    link = linked(Script(), line=line, timeout_s=timeout_s, retries=0)
    with pytest.raises(NoAnswer):
        link.ask(request_)
    with pytest.raises(TransportTimeout):
        linked(Script(), line=line, timeout_s=timeout_s).attempts.once(request_)
    listened_s = min(3 * timeout_s, 2.0)
    assert link.transport.clock() == pytest.approx(size * byte_s + timeout_s + listened_s, abs=1e-9)


@pytest.mark.parametrize("early_s", [1e-6, 0.1, 0.5])
def test_an_answer_is_taken_up_to_the_last_moment(early_s: float) -> None:
    deadline = (ASK_R0_BYTES + ANSWER_R0_BYTES) * BYTE_S + 0.5
    assert linked(Script([(deadline - early_s, register(7))]), retries=0).ask(R0) == (7,)
    with pytest.raises(NoAnswer):
        linked(Script([(deadline + early_s, register(7))]), retries=0).ask(R0)


@pytest.mark.parametrize("late_s", [0.0, 0.6, 3600.0])
def test_an_answer_that_came_in_time_counts_however_late_it_is_looked_at(late_s: float) -> None:
    """A busy computer may stop this process behind the request for longer than a try lasts."""
    link = linked(Script([(0.1, register(7))]), retries=0)
    transport = link.transport
    assert isinstance(transport, MemoryTransport)
    write, clock = transport.write, transport.clock
    looks = 0

    def sent(data: bytes) -> None:
        nonlocal looks
        write(data)
        looks = 1

    def stopped() -> float:
        nonlocal looks
        looks += looks > 0
        if looks == 3:  # the first look sets the deadline, the second is behind the stop
            transport._now += late_s
        return clock()

    transport.write = sent  # type: ignore[method-assign]
    transport.clock = stopped
    assert link.ask(R0) == (7,)
    assert link.counters.trouble == 0


def test_a_dead_line_takes_one_try_more_than_there_are_retries_and_one() -> None:
    # The request once; from then on the fence alone is tried, which first asks for the status.
    for retries in range(1, 6):
        peer = Script()
        link = linked(peer, retries=retries)
        with pytest.raises(NoAnswer):
            link.ask(R0)
        assert len(peer.heard) == retries + 2
        wire_s = (ASK_R0_BYTES + ANSWER_R0_BYTES + (retries + 1) * STATUS_BYTES) * BYTE_S
        first_s = (ASK_R0_BYTES + ANSWER_R0_BYTES) * BYTE_S + 4 * 0.5  # so long it is listened for at least
        took_s = max(wire_s + (retries + 2) * 0.5, first_s)
        assert link.transport.clock() == pytest.approx(took_s, abs=1e-9)


def test_a_write_on_a_dead_line_takes_no_longer() -> None:
    from fatektool.protocol.commands import WriteRegisters

    peer = Script()
    link = linked(peer)
    with pytest.raises(NoAnswer):
        link.ask(WriteRegisters(Element.parse("R0"), (1,)))
    assert len(peer.heard) == 5
    assert link.transport.clock() < 5 * 0.6


def test_a_plc_that_answers_loopbacks_only_is_left_after_the_retries() -> None:
    peer = Rules()
    link = linked(peer)
    with pytest.raises(NoAnswer):
        link.ask(ReadPage(0))
    assert fences(peer.heard) == 3
    assert peer.heard.count(ask_page(0)) == 4
    assert link.transport.clock() == pytest.approx(4 * (277 * BYTE_S + 0.5) + 4 * 0.01, abs=1e-9)


class Babbler:
    """A line that never falls silent, and a PLC that is not heard in it."""

    def __init__(self, piece: bytes) -> None:
        self.piece = piece
        self.heard = 0
        self.until = 0.0

    def receive(self, _: bytes, now: float) -> Pieces:
        self.heard += 1
        start, self.until = self.until, max(self.until, now + 3)
        count = round((self.until - start) / 0.002)
        return [(start + step * 0.002, self.piece) for step in range(count)]


@pytest.mark.parametrize(
    "piece",
    [
        b"\x00",
        b"\x02",
        b"\x03",
        b"\x02\x03",
        b"UUUUUUUU" * 64,
        b"\x024F" * 100,
        b"\x02024601R0000071\x03",
        b"\x0201990A2\x03",
    ],
)
def test_a_babbling_line_ends_at_the_deadline(piece: bytes) -> None:
    peer = Babbler(piece)
    link = linked(peer, retries=3)
    with pytest.raises(NoAnswer):
        link.ask(R0)
    assert peer.heard == 5
    assert link.transport.clock() < 5 * 0.6


def test_endless_answers_to_nothing_end_at_the_deadline() -> None:
    peer = Babbler(register(7)[:-3] + b"00\x03")  # an answer of the right size, its checksum wrong
    link = linked(peer, retries=2)
    with pytest.raises(NoAnswer):
        link.ask(Loopback(b"A" * 8))
    assert link.transport.clock() < 4 * 0.6


class Flood(MemoryTransport):
    """A medium on which there is always something to read, as fast as it is read; a read takes a moment."""

    def __init__(self, piece: bytes) -> None:
        super().__init__(Script())
        self.piece = piece
        self.reads = 0

    def read(self, max_bytes: int, timeout_s: float) -> bytes:  # noqa: ARG002  # it never waits
        self.reads += 1
        assert self.reads < 20_000, "it goes on for ever"
        self._now += 0.002
        return self.piece[:max_bytes]


@pytest.mark.parametrize(
    "piece",
    [
        b"\x00",
        b"\x02",
        b"\x02" * 64,
        register(7)[:-3] + b"00\x03",  # its checksum is wrong
        register(7),
        register(7) * 9,
        frame("460007", station=2),
        frame("4EABCD"),
        frame("400"),
    ],
)
def test_a_flood_ends_at_the_deadline(piece: bytes) -> None:
    flood = Flood(piece)
    link = Link(flood, FACON, 1, LineSettings(), retries=2)
    with pytest.raises(NoAnswer):
        link.ask(Loopback(b"A" * 8))
    assert link.transport.clock() < 10


def test_a_clean_answer_costs_no_waiting() -> None:
    peer = Rules({ask_page(0): page_answer(bytes(128))})
    link = linked(peer)
    assert link.ask(ReadPage(0)) == bytes(128)
    assert link.transport.clock() == pytest.approx(0.01)
    assert SILENCE == []
