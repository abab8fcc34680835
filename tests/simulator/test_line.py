"""The pace of a line, to the character, on a clock of numbers."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatektool.simulator.build import build_simulation
from fatektool.simulator.line import WHOLE_ANSWERS, SimulatedLine
from fatektool.simulator.plc import SimulatedPlc
from fatektool.simulator.slaves.facon.slave import FaconSlave
from tests.simulator.wire import frame, sent

STATUS, STATUS_ANSWER = frame("40"), frame("400005400")
PAGE = frame("4F0000")
CHAR_S = 10 / 9600


def test_without_baud_all_is_due_at_once() -> None:
    assert build_simulation().line().receive(STATUS + STATUS, 5.0) == [
        (5.0, STATUS_ANSWER),
        (5.0, STATUS_ANSWER),
    ]


def test_without_baud_the_scan_time_is_kept() -> None:
    assert build_simulation(scan_ms=20).line().receive(STATUS, 5.0) == [(5.02, STATUS_ANSWER)]


def test_a_paced_exchange() -> None:
    line = build_simulation(baud=9600, scan_ms=10).line()
    due = line.receive(STATUS, 100.0)
    # 8 characters there, 10 ms, 15 characters back in pieces of 2 ms: 2 characters.
    start = 100.0 + 8 * CHAR_S + 0.010
    assert [moment for moment, _ in due] == pytest.approx(
        [start + n * CHAR_S for n in (2, 4, 6, 8, 10, 12, 14, 15)]
    )
    assert b"".join(piece for _, piece in due) == STATUS_ANSWER
    assert {len(piece) for _, piece in due[:-1]} == {2}


@pytest.mark.parametrize(("baud", "chars"), [(300, 1), (4800, 1), (9600, 2), (115200, 23), (921600, 184)])
def test_a_piece_is_of_about_two_milliseconds(baud: int, chars: int) -> None:
    assert len(build_simulation(baud=baud).line().receive(PAGE, 0.0)[0][1]) == chars


def test_an_answer_is_one_piece_where_messages_are_datagrams() -> None:
    simulation = build_simulation(baud=9600)
    ((moment, answer),) = simulation.line(whole_answers=True).receive(PAGE, 0.0)
    assert moment == pytest.approx((12 + len(answer)) * CHAR_S)


def test_bits_of_a_character() -> None:
    line = SimulatedLine(FaconSlave({1: SimulatedPlc()}), None, 1200, 12, piece_s=WHOLE_ANSWERS)
    assert line.receive(STATUS, 0.0)[0][0] == pytest.approx((8 + 15) * 12 / 1200)


def test_bytes_wait_for_those_before_them() -> None:
    whole = build_simulation(baud=9600).line().receive(STATUS, 0.0)
    line = build_simulation(baud=9600).line()
    # Both halves arrive at once: the second crosses after the first.
    assert line.receive(STATUS[:3], 0.0) == []
    halved = line.receive(STATUS[3:], 0.0)
    assert [piece for _, piece in halved] == [piece for _, piece in whole]
    assert [moment for moment, _ in halved] == pytest.approx([moment for moment, _ in whole])


def test_a_late_half_counts_from_its_own_arrival() -> None:
    line = build_simulation(baud=9600).line()
    line.receive(STATUS[:3], 0.0)
    assert line.receive(STATUS[3:], 1.0)[-1][0] == pytest.approx(1.0 + (5 + 15) * CHAR_S)


def test_answers_wait_for_those_before_them() -> None:
    line = build_simulation(baud=9600).line()
    first, second = line.receive(STATUS, 0.0), line.receive(STATUS, 0.0)
    # The second request has crossed long before the first answer has.
    assert first[-1][0] == pytest.approx((8 + 15) * CHAR_S)
    assert second[-1][0] == pytest.approx((8 + 15 + 15) * CHAR_S)


def test_a_request_inside_a_chunk_is_answered_when_its_own_last_character_has_crossed() -> None:
    line = build_simulation(baud=9600).line()
    due = line.receive(b"??" + STATUS + b"?" * 10, 0.0)
    assert due[-1][0] == pytest.approx((2 + 8 + 15) * CHAR_S)
    # The trailing bytes keep the wire busy for the next request.
    assert line.receive(STATUS, 0.0)[-1][0] == pytest.approx((20 + 8 + 15) * CHAR_S)


def test_an_echo_has_the_pace_of_the_request() -> None:
    due = build_simulation(baud=9600, faults=["echo=1"]).line().receive(STATUS, 0.0)
    assert b"".join(piece for _, piece in due) == STATUS + STATUS_ANSWER
    assert [piece for _, piece in due[:4]] == [STATUS[n - 2 : n] for n in (2, 4, 6, 8)]
    assert [moment for moment, _ in due[:5]] == pytest.approx([n * CHAR_S for n in (2, 4, 6, 8, 10)])


def test_nothing_comes_of_nothing() -> None:
    assert build_simulation(baud=9600, faults=["echo=1"]).line().receive(b"", 0.0) == []


def test_a_slow_answer_keeps_its_pace() -> None:
    due = build_simulation(baud=9600, faults=["slow=1"]).line().receive(STATUS, 0.0)
    assert [due[0][0], due[-1][0]] == pytest.approx([0.8 + 10 * CHAR_S, 0.8 + 23 * CHAR_S])


def test_what_is_saved_is_saved_before_it_is_acknowledged() -> None:
    plc = SimulatedPlc()
    seen: list[list[int]] = []
    line = SimulatedLine(FaconSlave({1: plc}), after_request=lambda: seen.append(plc.read_words("R", 0, 1)))
    sent(line, frame("4701R000000001") + frame("4701R000000002") + frame("40", station=9))
    assert seen == [[1], [2], [2]]


def test_a_datagram_stands_by_itself() -> None:
    line = build_simulation().line()
    assert line.datagram(STATUS[:4], 0.0) == []
    assert line.datagram(STATUS[4:], 0.0) == []
    assert line.datagram(STATUS, 0.0) == [(0.0, STATUS_ANSWER)]


@given(
    st.lists(
        st.tuples(st.sampled_from([STATUS, PAGE, b"\x0201", b"40C7\x03"]), st.floats(0, 1)), max_size=20
    ),
    st.integers(0, 1000),
    st.sampled_from([None, 9600.0, 921600.0]),
)
def test_times_never_decrease(chunks: list[tuple[bytes, float]], seed: int, baud: float | None) -> None:
    faults = [
        f"{kind}=0.3" for kind in ("slow", "late", "duplicate", "noise", "echo", "drop", "truncate", "flip")
    ]
    line = build_simulation(faults=faults, seed=seed, baud=baud, scan_ms=3).line()
    now = 0.0
    times = []
    for data, wait_s in chunks:
        now += wait_s
        due = line.receive(data, now)
        assert all(moment >= now for moment, _ in due)
        times += [moment for moment, _ in due]
    assert times == sorted(times)
