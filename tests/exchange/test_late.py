"""Answers that come later than the time-out: told as late, with the time seen and a time-out to give."""

from __future__ import annotations

from typing import Any

import pytest

from fatektool.errors import NoAnswer
from fatektool.exchange.link import Link
from fatektool.exchange.no_answer import longer_timeout
from fatektool.protocol.commands import (
    Loopback,
    ReadBriefStatus,
    ReadPage,
    ReadRegisters,
    Request,
    WriteRegisters,
)
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from tests.rows import each

R0 = ReadRegisters(Element("R", 0), 1)
TO_R0 = WriteRegisters(Element("R", 0), (7,))
REQUESTS = [R0, TO_R0, ReadBriefStatus(), Loopback(b"A"), ReadPage(1)]


def late(
    delay_s: float, *, retries: int = 3, timeout_s: float = 0.5, warnings: list[str] | None = None
) -> Link:
    """A link to a PLC that takes so long for each answer, one after the other."""
    simulation = build_simulation([1], ladder_words=64, scan_ms=1000 * delay_s, baud=9600)
    return Link(
        MemoryTransport(simulation.line()),
        FACON,
        1,
        LineSettings(),
        timeout_s=timeout_s,
        retries=retries,
        warn=(lambda _: None) if warnings is None else warnings.append,
    )


def failure_of(link: Link, request: Request[Any]) -> NoAnswer | None:
    try:
        link.ask(request)
    except NoAnswer as error:
        return error
    return None


@each("request_", REQUESTS, ids=lambda request: type(request).__name__)
@each("delay_s", [0.55, 0.7, 0.9, 1.1, 1.3, 1.6, 1.9])
def test_it_is_answered_or_told_as_late(delay_s: float, request_: Request[Any]) -> None:
    for retries in range(5):
        warnings: list[str] = []
        link = late(delay_s, retries=retries, warnings=warnings)
        error = failure_of(link, request_)
        if error is not None:
            assert "its answers are late: after" in error.message
            assert "(--timeout is 0.5)" in error.message
            assert f"use --timeout {longer_timeout(link.state.late_s):g}" in str(error.hint)
            assert error.details["late_s"] == pytest.approx(link.state.late_s, abs=0.001)
        else:
            (told,) = warnings
            assert told.startswith("answers are late: after ")
            assert "use --timeout" in told
        assert delay_s - 0.01 <= link.state.late_s <= delay_s + 0.06


@pytest.mark.parametrize("delay_s", [0.55, 0.7, 0.9, 1.1, 1.3, 1.6, 1.9])
def test_the_time_out_that_is_told_is_enough(delay_s: float) -> None:
    link = late(delay_s, retries=0)
    with pytest.raises(NoAnswer) as caught:
        link.ask(R0)
    told = float(str(caught.value.hint).removeprefix("use --timeout "))
    warnings: list[str] = []
    link = late(delay_s, retries=0, timeout_s=told, warnings=warnings)
    for _ in range(3):
        assert link.ask(R0) == (0,)
    assert warnings == []


class Connection(MemoryTransport):
    """One over TCP: what is still on its way is lost when it is made anew."""

    def renew(self) -> None:
        self._coming.clear()


@each("request_", REQUESTS, ids=lambda request: type(request).__name__)
@each("delay_s", [0.55, 0.9, 1.1, 1.3, 1.6, 1.9])
def test_no_late_answer_is_lost_with_its_connection(delay_s: float, request_: Request[Any]) -> None:
    for retries in range(5):
        warnings: list[str] = []
        simulation = build_simulation([1], ladder_words=64, scan_ms=1000 * delay_s, baud=9600)
        link = Link(
            Connection(simulation.line(), "tcp://plc:500"),
            FACON,
            1,
            LineSettings(),
            retries=retries,
            warn=warnings.append,
        )
        error = failure_of(link, request_)
        said = warnings[0] if error is None else error.message
        assert "late: after" in said


def test_one_that_is_later_than_anybody_listens_is_silent() -> None:
    link = late(30.0, retries=1)
    with pytest.raises(NoAnswer, match="nothing received"):
        link.ask(R0)


def test_it_is_told_once() -> None:
    warnings: list[str] = []
    link = late(0.9, warnings=warnings)
    for _ in range(5):
        link.ask(R0)
    assert len(warnings) == 1


def test_it_is_never_told_as_sooner_than_the_time_out() -> None:
    """Whatever else is on the line: who is told of a late answer is told of one later than the time-out."""
    for delay_s in (0.3, 0.45, 0.6, 1.2):
        for faults in (["drop=0.3"], ["late=0.4"], ["slow=0.5"], ["duplicate=0.5", "drop=0.2"]):
            simulation = build_simulation(
                [1], ladder_words=64, scan_ms=1000 * delay_s, baud=9600, faults=faults, seed=5
            )
            warnings: list[str] = []
            link = Link(MemoryTransport(simulation.line()), FACON, 1, LineSettings(), warn=warnings.append)
            for _ in range(20):
                failure_of(link, R0)
            assert link.state.late_s == 0 or link.state.late_s > 0.5
            assert len(warnings) <= 4
