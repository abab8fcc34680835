"""What somebody reads at three in the morning: what was heard, and what to look at first."""

from __future__ import annotations

import pytest

from fatektool.errors import LineError, NoAnswer
from fatektool.exchange.link import Link
from fatektool.protocol.commands import Loopback, ReadPage, ReadRegisters, WritePage, WriteRegisters
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from tests.exchange.peer import (
    SILENCE,
    Pieces,
    Rules,
    Script,
    ask_page,
    frame,
    linked,
    page_answer,
    read_registers,
    soon,
)

R0 = ReadRegisters(Element.parse("R0"), 1)
ASK_R0 = read_registers(0)


class Whatever:
    """Answers every request with the same bytes."""

    def __init__(self, said: bytes) -> None:
        self.said = said

    def receive(self, _: bytes, now: float) -> Pieces:
        return [(now + 0.01, self.said)]


class Stranger:
    """A PLC of another station that answers everything, as some gateways make it."""

    def receive(self, data: bytes, now: float) -> Pieces:
        return [(now + 0.01, frame(data[3:-3].decode("latin-1"), station=7))]


def said(link: Link, request: object = R0) -> NoAnswer:
    with pytest.raises(NoAnswer) as caught:
        link.ask(request)  # type: ignore[arg-type]
    error = caught.value
    assert error.exit_code == 3
    assert "\n" not in str(error)
    assert error.message.startswith("no answer from station 1 on sim: (")
    assert error.details["station"] == 1
    assert error.details["target"] == "sim:"
    return error


def test_a_dead_line() -> None:
    error = said(linked(Script()))
    assert (
        "to 'read registers' (46) in 1 try and 4 other requests, 2.6 s in total: nothing received"
        in error.message
    )
    assert "check that the PLC is on, the cable" in str(error.hint)
    assert "9600 7E1" in str(error.hint)
    assert error.details["heard"] is None


def test_garbage() -> None:
    error = said(linked(Whatever(b"\x8a\xf0\x13\x91\x7f")))
    assert "received 5 bytes without a valid frame" in error.message
    assert "--baud, --line and --protocol" in str(error.hint)
    assert "termination" in str(error.hint)


def test_frames_with_wrong_checksums() -> None:
    error = said(linked(Whatever(b"\x0201460AAAA00\x03")))
    assert "received a damaged frame (checksum: expected" in error.message
    assert "--baud, --line" in str(error.hint)


def test_another_station() -> None:
    error = said(linked(Stranger()))
    assert "received a frame of station 7" in error.message
    assert error.hint == "check --station"


def test_the_echo_only() -> None:
    error = said(linked(Rules(echo=True, dead=True)))
    assert "received its own request only (the line echoes)" in error.message
    assert "A and B" in str(error.hint)


def test_always_the_same_answer() -> None:
    error = said(linked(Whatever(frame("470"))))
    assert "an answer to another command (47)" in error.message
    assert "--protocol" in str(error.hint)


def test_answers_of_a_wrong_length() -> None:
    error = said(linked(Rules({ASK_R0: frame("46012345678")})))
    assert "it answers loopbacks, but not this request" in error.message
    assert "expected 5 characters of data, got 9" in error.message


def test_a_program_that_is_not_offered() -> None:
    for request in (ReadPage(0), WritePage(0, bytes(128))):
        error = said(linked(Rules({ask_page(0): lambda _: SILENCE})), request)
        assert f"({request.command:02X}) in 4 tries" in error.message or "not known" in error.message
        assert "FBs papers have neither 4F nor 50" in str(error.hint) or "not known" in error.message
    error = said(linked(Rules()), ReadPage(0))
    assert "it answers loopbacks, but not this request; nothing received" in error.message


def test_a_program_that_was_offered_and_no_more() -> None:
    peer = Rules({ask_page(0): lambda asked: SILENCE if asked else soon(page_answer(bytes(128)))})
    link = linked(peer)
    assert link.ask(ReadPage(0)) == bytes(128)
    assert "--timeout" in str(said(link, ReadPage(0)).hint)


def test_a_live_plc_that_loses_this_one() -> None:
    error = said(linked(Rules()))
    assert "it answers loopbacks, but not this request; nothing received" in error.message
    assert "--timeout" in str(error.hint)
    assert "--retries" in str(error.hint)


def test_a_write_of_unknown_fate() -> None:
    error = said(linked(Script()), WriteRegisters(Element.parse("R0"), (1,)))
    assert "to 'write registers' (47)" in error.message
    assert "it is not known whether the PLC executed it" in error.message


def test_one_try() -> None:
    assert "in 1 try, 2.0 s in total: nothing received" in said(linked(Script(), retries=0)).message


def test_the_line_is_named_where_there_is_one() -> None:
    transport = MemoryTransport(Script(), "/dev/ttyUSB0")
    transport.serial_settings = "19200 8N1"
    link = Link(transport, FACON, 9, LineSettings(19200, "8N1"), timeout_s=1.25, retries=1)
    with pytest.raises(NoAnswer) as caught:
        link.ask(Loopback(b"A"))
    assert caught.value.message.startswith(
        "no answer from station 9 on /dev/ttyUSB0 (19200 8N1) to 'read brief status' (40), "
        "which is sent before 'loopback' (4E)"
    )
    assert "in 3 requests, 3.8 s in total: nothing received" in caught.value.message
    assert isinstance(caught.value, LineError)
