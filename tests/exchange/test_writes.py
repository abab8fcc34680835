"""A write whose answer was lost is read back, and sent again only when it did not take."""

from __future__ import annotations

from typing import Any

import pytest

from fatektool.errors import NoAnswer, PlcRefused
from fatektool.protocol.commands import (
    Control,
    ControlDiscrete,
    Request,
    RunStop,
    WriteDiscretes,
    WriteMixed,
    WritePage,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from tests.exchange.peer import RUNNING, SILENCE, STATUS, STOP, STOPPED, Pieces, Rules, frame, linked, soon

PAGE = bytes(range(128))
R5, X16, M3 = Element.parse("R5"), Element.parse("X16"), Element.parse("M3")

WRITES: list[Any] = [
    pytest.param(RunStop(run=False), STOP, STATUS, STOPPED, RUNNING, id="41-stop"),
    pytest.param(RunStop(run=True), frame("411"), STATUS, RUNNING, STOPPED, id="41-run"),
    pytest.param(
        ControlDiscrete(Control.DISABLE, X16),
        frame("421X0016"),
        frame("4301X0016"),
        frame("4301"),
        frame("4300"),
        id="42-disable",
    ),
    pytest.param(
        ControlDiscrete(Control.ENABLE, X16),
        frame("422X0016"),
        frame("4301X0016"),
        frame("4300"),
        frame("4301"),
        id="42-enable",
    ),
    pytest.param(
        ControlDiscrete(Control.SET, M3),
        frame("423M0003"),
        frame("4401M0003"),
        frame("4401"),
        frame("4400"),
        id="42-set",
    ),
    pytest.param(
        ControlDiscrete(Control.RESET, M3),
        frame("424M0003"),
        frame("4401M0003"),
        frame("4400"),
        frame("4401"),
        id="42-reset",
    ),
    pytest.param(
        WriteDiscretes(M3, (True, False)),
        frame("4502M000310"),
        frame("4402M0003"),
        frame("44010"),
        frame("44011"),
        id="45",
    ),
    pytest.param(
        WriteRegisters(R5, (0x1234,)),
        frame("4701R000051234"),
        frame("4601R00005"),
        frame("4601234"),
        frame("4604321"),
        id="47",
    ),
    pytest.param(
        WriteMixed(((R5, 0xABCD), (M3, 1))),
        frame("4902R00005ABCDM00031"),
        frame("4802R00005M0003"),
        frame("480ABCD1"),
        frame("480ABCD0"),
        id="49",
    ),
    pytest.param(
        WritePage(7, PAGE),
        frame("500007" + PAGE.hex().upper()),
        frame("4F0007"),
        frame("4F0" + PAGE.hex().upper()),
        frame("4F0" + bytes(128).hex()),
        id="50",
    ),
]


def good(raw: bytes) -> bytes:
    return frame(raw[3:5].decode() + "0")


@pytest.mark.parametrize(("write", "raw", "question", "taken", "not_taken"), WRITES)
def test_a_lost_answer(
    write: Request[None], raw: bytes, question: bytes, taken: bytes, not_taken: bytes
) -> None:
    # It took: it is not sent again.
    peer = Rules({question: taken, raw: lambda _: SILENCE})
    link = linked(peer)
    link.ask(write)
    assert peer.heard.count(raw) == 1
    assert peer.heard[-1] == question

    # It did not: it is.
    def then_heard(asked: int) -> Pieces:
        return soon(good(raw)) if asked else SILENCE

    peer = Rules({question: not_taken, raw: then_heard})
    link = linked(peer)
    link.ask(write)
    assert peer.heard.count(raw) == 2
    assert peer.heard[-1] == raw

    # It never does: as often as there are tries, and not once more.
    peer = Rules({question: not_taken, raw: lambda _: SILENCE})
    with pytest.raises(NoAnswer, match=rf"\({raw[3:5].decode()}\) in 4 tries"):
        linked(peer).ask(write)
    assert peer.heard.count(raw) == 4


@pytest.mark.parametrize(("write", "raw", "question", "taken", "not_taken"), WRITES)
def test_a_late_acknowledgement_acknowledges_nothing_else(
    write: Request[None], raw: bytes, question: bytes, taken: bytes, not_taken: bytes
) -> None:
    del taken
    # The answer to the first comes when the second is under way: what counts is what is read back.
    peer = Rules({question: not_taken, raw: lambda _: [(0.9, good(raw))]})
    with pytest.raises(NoAnswer):
        linked(peer, retries=0).ask(write)


def test_a_refused_write_is_neither_read_back_nor_sent_again() -> None:
    write, raw = WritePage(7, PAGE), frame("500007" + PAGE.hex().upper())
    peer = Rules({raw: frame("503")})
    with pytest.raises(PlcRefused, match="ROM pack"):
        linked(peer).ask(write)
    assert peer.heard == [raw]


def test_a_write_that_cannot_be_read_back_is_sent_again() -> None:
    write, raw = WritePage(7, PAGE), frame("500007" + PAGE.hex().upper())
    peer = Rules({raw: lambda asked: soon(frame("500")) if asked else SILENCE, frame("4F0007"): frame("4F4")})
    linked(peer).ask(write)
    assert peer.heard.count(raw) == 2


def test_a_write_on_a_line_that_dies_says_that_its_fate_is_not_known() -> None:
    peer = Rules(dead=True)
    with pytest.raises(NoAnswer, match=r"to 'write registers'.*it is not known whether the PLC executed it"):
        linked(peer).ask(WriteRegisters(R5, (1,)))
    assert sum(request[3:5] == b"47" for request in peer.heard) == 1


def test_a_damaged_acknowledgement_is_read_back_too() -> None:
    write, raw = WriteRegisters(R5, (0x1234,)), frame("4701R000051234")
    peer = Rules({raw: frame("470").replace(b"0\x03", b"1\x03"), frame("4601R00005"): frame("4601234")})
    linked(peer).ask(write)
    assert peer.heard.count(raw) == 1
