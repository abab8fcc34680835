"""The loopback test: each exchange counts as what became of it, none is retried, and nothing piles up."""

from __future__ import annotations

import gc
import tracemalloc

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatektool.client import Plc
from fatektool.errors import TransportClosed, UsageError
from fatektool.jobs.linetest.loopback.data import Pattern
from fatektool.jobs.linetest.loopback.result import ERRORS, LoopbackPlan, LoopbackResult
from fatektool.jobs.linetest.loopback.run import run_loopback
from tests.exchange.peer import RUNNING, STATUS, Rules, Script, frame, linked, soon
from tests.night import examples
from tests.rigs import simulated
from tests.tree import PACKAGE

A = frame("4Eabcd")
ONE_SIZE = LoopbackPlan(count=1, sizes=(4,), patterns=(Pattern.ONES,))
ONES = frame("4E" + 4 * "\x7f")


def once(*turns: list[tuple[float, bytes]], count: int = 1, plan: LoopbackPlan = ONE_SIZE) -> LoopbackResult:
    """Run a test against a peer that answers its turns, after the question whether the line echoes."""
    peer = Script(soon(RUNNING), *turns)
    link = linked(peer, timeout_s=0.5)
    plan = LoopbackPlan(count=count, sizes=plan.sizes, patterns=plan.patterns)
    return run_loopback(Plc(link, "peer"), plan)


@pytest.mark.parametrize(
    ("pieces", "kind"),
    [
        ([], "timeout"),
        ([(0.0, frame("4E" + "\x7f\x7f\x7f\x7d"))], "mismatch"),
        ([(0.0, frame("4E" + "\x7f"))], "mismatch"),
        ([(0.0, ONES[:-3] + b"00\x03")], "checksum"),
        ([(0.0, b"\x00\xff\x80")], "garbled"),
        ([(0.0, ONES[:5])], "garbled"),
        ([(0.0, ONES[1:])], "garbled"),
        ([(0.0, frame("4E4"))], "refused"),
        ([(0.0, frame("4E" + 4 * "\x7f", station=2))], "mismatch"),
        ([(0.0, RUNNING)], "stale"),
        ([(0.7, ONES)], "timeout"),
    ],
)
def test_an_exchange_counts_as_what_became_of_it(pieces: list[tuple[float, bytes]], kind: str) -> None:
    result = once(pieces)
    assert result.total.errors == dict.fromkeys(ERRORS, 0) | {kind: 1}
    assert (result.total.sent, result.total.ok) == (1, 0)
    assert result.total.latency.count == 0


@pytest.mark.parametrize("before", [b"\x00\xff", frame("4Exyz"), frame("4E", station=9), RUNNING])
def test_what_comes_before_the_right_answer_is_no_error(before: bytes) -> None:
    result = once([(0.0, before), (0.01, ONES)])
    assert result.total.ok == 1
    assert result.faults == []


def test_nothing_is_sent_twice() -> None:
    peer = Script(soon(RUNNING))
    run_loopback(Plc(linked(peer), "peer"), LoopbackPlan(count=3, sizes=(4, 5, 6)))
    assert [len(request) for request in peer.heard] == [len(STATUS), 12, 13, 14]


def test_a_late_answer_is_never_taken_for_the_next_one() -> None:
    late = [(0.6, ONES)]  # 0.1 s after the time is over
    result = once(late, [], late, [], count=4)
    assert result.total.errors["timeout"] == 4
    assert result.total.ok == 0
    assert result.heard.late == 2


def test_the_last_answer_may_be_late_as_the_ones_before() -> None:
    """The test waits for it: it is not lost."""
    late = [(0.6, ONES)]
    result = once(late, [], late, count=3)
    assert (result.total.errors["timeout"], result.heard.late) == (3, 2)


def test_an_answer_that_comes_twice_is_counted_apart() -> None:
    peer = Script(soon(RUNNING), soon(frame("4E" + "\x7f"), frame("4E" + "\x7f")), soon(frame("4E\x7f\x7f")))
    plan = LoopbackPlan(count=2, sizes=(1, 2), patterns=(Pattern.ONES,))
    result = run_loopback(Plc(linked(peer), "peer"), plan)
    assert result.total.ok == 2
    assert (result.heard.twice, result.heard.late) == (1, 0)


def test_on_an_echoing_line_the_echo_is_no_answer() -> None:
    answered = run_loopback(Plc(linked(Rules(echo=True)), "peer"), LoopbackPlan(count=12))
    assert answered.total.ok == 12
    dead = run_loopback(Plc(linked(Rules(echo=True, dead=True)), "peer"), LoopbackPlan(count=12))
    assert dead.total.errors["timeout"] == 12
    assert dead.echoes is True


def test_an_echo_that_wakes_up_in_the_middle_is_no_answer() -> None:
    rules = Rules(dead=True)
    plan = LoopbackPlan(count=4, sizes=(3,), patterns=(Pattern.RAMP,))

    def plug_in(result: LoopbackResult) -> None:
        rules.echo = result.total.sent >= 2

    result = run_loopback(Plc(linked(rules), "peer"), plan, plug_in)
    assert result.total.errors["timeout"] == 4


def test_ctrl_c_gives_the_figures_so_far() -> None:
    def interrupt(result: LoopbackResult) -> None:
        if result.total.sent == 5:
            raise KeyboardInterrupt

    result = run_loopback(simulated(baud=9600).plc, LoopbackPlan(count=100), interrupt)
    assert (result.total.sent, result.total.ok, result.ended) == (5, 5, "interrupted")
    assert result.bytes_received == result.bytes_sent > 0


def test_a_line_that_is_lost_gives_the_figures_so_far() -> None:
    plc = simulated(baud=9600).plc

    def cut(result: LoopbackResult) -> None:
        if result.total.sent == 3:
            plc.link.transport.close()

    result = run_loopback(plc, LoopbackPlan(count=100), cut)
    assert (result.total.sent, result.total.ok, result.ended) == (4, 3, "line lost")
    assert result.lost is not None
    assert "closed" in result.lost


def test_a_line_that_was_never_there() -> None:
    plc = simulated().plc
    plc.close()
    plc.link.transport.close()
    result = run_loopback(plc, LoopbackPlan())
    assert (result.total.sent, result.faults) == (0, ["nothing was sent"])
    assert issubclass(TransportClosed, Exception)


def test_the_time_is_kept() -> None:
    plan = LoopbackPlan(count=None, duration_s=5.0, interval_s=0.7, sizes=(0,))
    result = run_loopback(simulated(baud=9600).plc, plan)
    assert result.total.sent == 8
    assert result.ended == "duration"
    assert result.duration_s == pytest.approx(5.0)


def test_turnaround_is_latency_less_wire_time() -> None:
    result = run_loopback(simulated(baud=9600, scan_ms=40).plc, LoopbackPlan(count=60))
    assert result.turnaround.summary_ms()["p50"] == pytest.approx(40, rel=0.01)
    assert result.turnaround.summary_ms()["max"] == pytest.approx(40, rel=0.01)
    assert result.line_use == pytest.approx(result.wire_s / result.duration_s)
    assert 0.5 < (result.line_use or 0) < 1
    least = result.total.latency.summary_ms()["min"]
    assert least == pytest.approx(40 + 1000 * 16 * 10 / 9600, rel=0.001)


def test_without_a_line_of_that_speed_there_is_no_wire_time() -> None:
    result = run_loopback(simulated(scan_ms=5).plc, LoopbackPlan(count=60))
    assert result.line_use is None
    assert result.turnaround.summary_ms()["p50"] == pytest.approx(5, rel=0.01)


@pytest.mark.parametrize(
    ("plan", "words"),
    [
        (LoopbackPlan(count=60), ["error rate 0.", "allowed 0"]),
        (LoopbackPlan(count=60, max_error_rate=1.0), []),
        (LoopbackPlan(count=60, max_error_rate=1.0, max_p99_ms=1.0), ["p99", "allowed 1 ms"]),
        (LoopbackPlan(count=60, max_error_rate=1.0, max_p99_ms=9000.0), []),
    ],
)
def test_the_limits(plan: LoopbackPlan, words: list[str]) -> None:
    result = run_loopback(simulated(baud=9600, faults=["drop=0.2"]).plc, plan)
    said = "; ".join(result.faults)
    assert bool(said) == bool(words)
    for word in words:
        assert word in said


def test_a_limit_of_time_is_passed_when_nothing_comes() -> None:
    plan = LoopbackPlan(count=3, max_error_rate=1.0, max_p99_ms=100.0)
    result = run_loopback(simulated(faults=["drop=1"]).plc, plan)
    assert result.faults == ["p99 without an answer, allowed 100 ms"]


@pytest.mark.parametrize("sizes", [(), (-1,), (257,)])
def test_sizes_have_a_range(sizes: tuple[int, ...]) -> None:
    with pytest.raises(UsageError, match="expected 0 to 256"):
        LoopbackPlan(sizes=sizes)
    with pytest.raises(UsageError, match="pattern"):
        LoopbackPlan(patterns=())


FAULTS = ("drop", "flip", "truncate", "noise", "duplicate", "late", "slow", "wrong-station", "echo", "twins")


@settings(max_examples=examples(40), deadline=None)
@given(
    st.lists(
        st.tuples(st.sampled_from(FAULTS), st.sampled_from([0.05, 0.3])), max_size=3, unique_by=lambda f: f[0]
    ),
    st.integers(0, 1000),
    st.lists(st.integers(0, 256), min_size=1, max_size=5),
)
def test_whatever_the_faults_the_figures_agree(
    faults: list[tuple[str, float]], seed: int, sizes: list[int]
) -> None:
    plc = simulated(baud=9600, faults=[f"{kind}={share}" for kind, share in faults], seed=seed).plc
    result = run_loopback(plc, LoopbackPlan(count=50, sizes=tuple(sizes)))
    total = result.total
    assert total.sent == 50
    assert total.ok + sum(total.errors.values()) == total.sent
    assert total.latency.count == total.ok
    assert sum(tally.sent for tally in result.by_size.values()) == total.sent
    assert sum(tally.ok for tally in result.by_size.values()) == total.ok
    assert total.error_rate <= total.error_rate_upper95
    if not faults:
        assert total.ok == 50


def test_the_memory_does_not_grow() -> None:
    plc = simulated(baud=9600, faults=["drop=0.05", "flip=0.05", "noise=0.05"]).plc
    held = {}

    def weigh(result: LoopbackResult) -> None:
        if result.total.sent in {1000, 2000}:
            gc.collect()  # empties the interpreter's lists of freed tuples, too
            ours = tracemalloc.take_snapshot().filter_traces([tracemalloc.Filter(True, f"{PACKAGE}/*")])  # noqa: FBT003
            held[result.total.sent] = sum(each.size for each in ours.traces)

    tracemalloc.start()
    try:
        run_loopback(plc, LoopbackPlan(count=2000, sizes=(0, 8, 16)), weigh)
    finally:
        tracemalloc.stop()
    assert held[2000] - held[1000] < 3000  # three bytes an exchange
