"""A USB adapter that hands on what it received at its ticks: in memory, on a pty, over TCP."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import pytest
import serial
from hypothesis import given
from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.pty import PTY_SUPPORTED
from fatektool.simulator.listen.servers import Server, running
from tests.guard import GUARD_S
from tests.simulator.listen.listeners import ANSWER, ASK, connected, read, tcp
from tests.simulator.wire import frame, sent

if TYPE_CHECKING:
    from pathlib import Path

PAGE = frame("4F0000")
TICK_S = 0.016


def test_without_a_wire_an_answer_comes_with_the_next_tick() -> None:
    line = build_simulation(latency_timer_ms=16).line()
    assert line.receive(ASK, 0.0) == [(TICK_S, ANSWER)]
    assert line.receive(ASK, 0.001) == [(TICK_S, ANSWER)]
    # What comes at a tick has missed it, whatever the rounding of the clock.
    for tick in range(1, 1000):
        ((due, _),) = line.receive(ASK, tick * TICK_S)
        assert due == (tick + 1) * TICK_S


def test_a_long_answer_comes_in_as_many_steps_as_it_takes_ticks() -> None:
    built = build_simulation(latency_timer_ms=16, baud=9600)
    due = built.line().receive(PAGE, 0.0)
    wire_s = (len(PAGE) + 265) * 10 / 9600
    ticks = sorted({moment for moment, _ in due})
    assert ticks == pytest.approx([TICK_S * n for n in range(1, 1 + len(ticks))])
    assert wire_s < ticks[-1] <= wire_s + TICK_S
    assert b"".join(piece for _, piece in due) == sent(build_simulation().line(), PAGE)


def test_the_wire_is_no_slower_for_it() -> None:
    line = build_simulation(latency_timer_ms=16, baud=9600).line()
    due = [piece for _ in range(10) for piece in line.receive(ASK, 0.0)]
    wire_s = (10 * len(ASK) + len(ANSWER)) * 10 / 9600
    assert due[-1][0] <= wire_s + TICK_S


def test_an_echo_waits_for_a_tick_too() -> None:
    line = build_simulation(latency_timer_ms=16, faults=["echo=1"]).line()
    assert line.receive(ASK, 0.5) == [(32 * TICK_S, ASK), (32 * TICK_S, ANSWER)]


@given(st.lists(st.floats(0, 0.1), max_size=20), st.floats(0.1, 50), st.sampled_from([None, 9600.0]))
def test_it_is_late_by_at_most_a_tick_and_never_early(
    waits: list[float], timer_ms: float, baud: float | None
) -> None:
    plain = build_simulation(baud=baud, scan_ms=1, ladder_words=1).line()
    ticking = build_simulation(baud=baud, scan_ms=1, ladder_words=1, latency_timer_ms=timer_ms).line()
    now = 0.0
    last = 0.0
    for wait_s in waits:
        now += wait_s
        pairs = zip(plain.receive(ASK, now), ticking.receive(ASK, now), strict=True)
        for (crossed, piece), (due, same) in pairs:
            assert piece == same
            assert crossed < due <= crossed + timer_ms / 1000 * 1.001
            assert due >= last
            last = due


def test_over_tcp() -> None:
    with tcp(latency_timer_ms=16) as (_, listener), connected(listener) as client:
        start = time.perf_counter()
        for _ in range(10):
            client.sendall(ASK)
            assert read(client, len(ANSWER)) == ANSWER
        # Each comes at a tick of its own; the first may have come soon.
        assert time.perf_counter() - start >= 9 * TICK_S


@pytest.mark.skipif(not PTY_SUPPORTED, reason="no pseudo terminals here")
def test_on_a_pty(tmp_path: Path) -> None:
    server = Server(build_simulation(latency_timer_ms=16, baud=921600))
    server.open_pty(tmp_path / "plc")
    with running(server), serial.Serial(str(tmp_path / "plc"), timeout=GUARD_S) as port:
        start = time.perf_counter()
        for _ in range(10):
            port.write(ASK)
            assert port.read(len(ANSWER)) == ANSWER
        assert time.perf_counter() - start >= 9 * TICK_S


@pytest.mark.parametrize("timer_ms", [-1.0, float("nan"), float("inf")])
def test_what_is_no_timer(timer_ms: float) -> None:
    with pytest.raises(UsageError, match="latency timer: expected 0 ms or more, got"):
        build_simulation(latency_timer_ms=timer_ms)
