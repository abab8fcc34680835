"""The fast way: what is encoded, sent and looked at in which order, and how writes end that go wrong."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.errors import LineError, LineReadOnly, NoAnswer, PlcRefused
from fatektool.exchange.batch import read_all, write_all
from fatektool.exchange.link import Link
from fatektool.protocol.commands import ReadPage, WritePage
from fatektool.protocol.fatek.facon.codec import FaconCodec
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from tests.exchange.peer import SILENCE, Pieces, Rules, ask_page, frame, linked, page_answer, soon
from tests.night import examples
from tests.rows import each

if TYPE_CHECKING:
    from fatektool.protocol.codec import Frame
    from fatektool.protocol.commands import Request

PAGES = [bytes([number]) * 128 for number in range(6)]
WRITES = [WritePage(number, data) for number, data in enumerate(PAGES)]
READS = [ReadPage(number) for number in range(len(PAGES))]
RAW_WRITES = [frame(f"50{number:04X}" + data.hex().upper()) for number, data in enumerate(PAGES)]
TAKEN = frame("500")
REFUSED = frame("503")

Events = list[tuple[str, int]]


class Watched(FaconCodec):
    """Notes when a request is encoded and when its answer is looked at."""

    def __init__(self, events: Events) -> None:
        super().__init__()
        self._events = events

    def encode(self, station: int, request: Request[Any], number: int = 0) -> bytes:
        self._note("encode", request)
        return super().encode(station, request, number)

    def parse_answer(self, request: Request[Any], frame: Frame) -> Any:
        self._note("decode", request)
        return super().parse_answer(request, frame)

    def good_answer(self, request: Request[Any], asked: bytes, raw: bytes) -> Any:
        self._note("decode", request)
        return super().good_answer(request, asked, raw)

    def _note(self, what: str, request: Request[Any]) -> None:
        if isinstance(request, ReadPage | WritePage):
            self._events.append((what, request.page))


class Heard(Rules):
    """Notes when a request comes."""

    def __init__(self, events: Events) -> None:
        super().__init__(dict(zip(RAW_WRITES, [TAKEN] * len(PAGES), strict=True)))
        self.answers |= {ask_page(number): page_answer(page) for number, page in enumerate(PAGES)}
        self._events = events

    def receive(self, data: bytes, now: float) -> Pieces:
        if data[3:5] in {b"4F", b"50"}:
            self._events.append(("hear", int(data[5:9], 16)))
        return super().receive(data, now)


def watched(events: Events) -> Link:
    return Link(MemoryTransport(Heard(events)), Watched(events), 1, LineSettings())


def order_of(events: Events, first: tuple[str, int], second: tuple[str, int]) -> None:
    assert events.index(first) < events.index(second), events


def test_a_read_is_encoded_and_sent_before_the_answer_before_it_is_looked_at() -> None:
    events: Events = []
    assert read_all(watched(events), READS) == PAGES
    for page in range(1, len(PAGES) - 1):  # by the first, the line is found to have no echo
        order_of(events, ("encode", page + 1), ("decode", page))
        order_of(events, ("hear", page + 1), ("decode", page))


def test_a_write_is_encoded_before_the_answer_before_it_is_looked_at_and_sent_behind_it() -> None:
    events: Events = []
    write_all(watched(events), WRITES)
    for page in range(1, len(PAGES) - 1):  # by the first, the line is found to have no echo
        order_of(events, ("encode", page + 1), ("decode", page))
        order_of(events, ("decode", page), ("hear", page + 1))
    assert [page for what, page in events if what == "hear"] == list(range(len(PAGES)))


def test_writes_cost_an_exchange_each_and_no_more() -> None:
    peer = Rules(dict(zip(RAW_WRITES, [TAKEN] * len(PAGES), strict=True)))
    done: list[int] = []
    write_all(linked(peer), WRITES, done.append)
    assert peer.heard == RAW_WRITES
    assert done == [1, 2, 3, 4, 5, 6]


def test_nothing_to_write_is_nothing_sent() -> None:
    peer = Rules()
    write_all(linked(peer), [])
    assert peer.heard == []


def lost_once(raw: bytes) -> Rules:
    """A PLC that does not answer this write the first time it comes."""
    peer = Rules(dict(zip(RAW_WRITES, [TAKEN] * len(PAGES), strict=True)))
    peer.answers[raw] = lambda asked: soon(TAKEN) if asked else SILENCE
    return peer


@pytest.mark.parametrize("page", range(len(PAGES)))
def test_a_lost_answer_is_read_back_and_what_took_is_not_sent_again(page: int) -> None:
    peer = lost_once(RAW_WRITES[page])
    peer.answers[ask_page(page)] = page_answer(PAGES[page])
    write_all(linked(peer), WRITES)
    assert [raw for raw in peer.heard if raw[3:5] == b"50"] == RAW_WRITES
    assert peer.heard.count(ask_page(page)) == 1


@pytest.mark.parametrize("page", range(len(PAGES)))
def test_a_lost_answer_is_read_back_and_what_did_not_take_is_sent_again(page: int) -> None:
    peer = lost_once(RAW_WRITES[page])
    peer.answers[ask_page(page)] = page_answer(bytes(128) if page else b"\xff" * 128)
    write_all(linked(peer), WRITES)
    expected = [*RAW_WRITES[: page + 1], *RAW_WRITES[page:]]
    assert [raw for raw in peer.heard if raw[3:5] == b"50"] == expected


@pytest.mark.parametrize("page", range(len(PAGES)))
def test_a_refused_write_ends_it_and_nothing_behind_it_is_sent(page: int) -> None:
    peer = Rules(dict(zip(RAW_WRITES, [TAKEN] * len(PAGES), strict=True)))
    peer.answers[RAW_WRITES[page]] = REFUSED
    done: list[int] = []
    with pytest.raises(PlcRefused):
        write_all(linked(peer), WRITES, done.append)
    assert peer.heard == RAW_WRITES[: page + 1]
    assert done == list(range(1, page + 1))


@each("page", range(len(PAGES)))
@each(
    "instead",
    [b"\x02015006A\x03", b"\x0201500\x03", frame("510"), frame("500", station=2), b"\xff" * 9],
)
def test_what_is_no_acknowledgement_is_none(page: int, instead: bytes) -> None:
    peer = Rules(dict(zip(RAW_WRITES, [TAKEN] * len(PAGES), strict=True)))
    peer.answers[RAW_WRITES[page]] = lambda asked: soon(TAKEN if asked else instead)
    peer.answers[ask_page(page)] = page_answer(b"\xaa" * 128)
    write_all(linked(peer), WRITES)
    assert [raw for raw in peer.heard if raw[3:5] == b"50"] == [*RAW_WRITES[: page + 1], *RAW_WRITES[page:]]


def test_a_plc_that_falls_silent_ends_it_with_what_is_not_known() -> None:
    peer = Rules(dict(zip(RAW_WRITES[:3], [TAKEN] * 3, strict=True)), loopback=False)
    done: list[int] = []
    with pytest.raises(NoAnswer):
        write_all(linked(peer, retries=1), WRITES, done.append)
    assert done == [1, 2, 3]
    assert RAW_WRITES[4] not in peer.heard


def test_a_read_only_line_takes_no_write_even_in_a_stream() -> None:
    peer = Rules(dict(zip(RAW_WRITES, [TAKEN] * len(PAGES), strict=True)))
    link = Link(MemoryTransport(peer), FaconCodec(), 1, LineSettings(), read_only=True)
    link.state.echoes = False
    with pytest.raises(LineReadOnly):
        write_all(link, WRITES)
    assert peer.heard == []


@given(
    kind=st.sampled_from(["drop", "flip", "duplicate", "late", "noise", "truncate"]),
    often=st.sampled_from([0.02, 0.1, 0.3]),
    seed=st.integers(0, 1 << 16),
)
@settings(max_examples=examples(40), deadline=None)
def test_acknowledged_writes_over_a_bad_line_are_in_the_plc(kind: str, often: float, seed: int) -> None:
    simulation = build_simulation(ladder_words=600, faults=[f"{kind}={often}"], seed=seed)
    device = simulation.plcs[1]
    todo = [WritePage(page, bytes([page + 1]) * 128) for page in range(10)]
    done = 0

    def count(acknowledged: int) -> None:
        nonlocal done
        done = acknowledged

    link = Link(MemoryTransport(simulation.line()), FaconCodec(), 1, LineSettings(), retries=2)
    try:
        write_all(link, todo, count)
    except LineError:
        assert done < len(todo)
    else:
        assert done == len(todo)
    # An answer that came twice can stand for the next write's, whose own was lost: one, and the read-back
    # finds it. A line that only loses and spoils cannot lie.
    if kind not in {"duplicate", "late"}:
        assert device.pages[:done] == [request.data for request in todo[:done]]
