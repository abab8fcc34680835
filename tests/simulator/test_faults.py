"""Each fault: what it does, how often, and that a seed repeats it."""

from __future__ import annotations

import pytest

from fatektool.errors import UsageError
from fatektool.simulator.build import Simulation, build_simulation
from fatektool.simulator.faults import FAULT_KINDS, PROBABILITY_KINDS, parse_faults
from tests.simulator.wire import frame, sent

ASK, ANSWER = frame("4601R00007"), frame("4600000")
PAGE_HEX = bytes(range(128)).hex().upper()


def simulation(*faults: str, seed: int = 0) -> Simulation:
    return build_simulation(faults=faults, seed=seed)


def story(*faults: str, seed: int = 0) -> list[bytes]:
    line = simulation(*faults, seed=seed).line()
    return [sent(line, ASK) for _ in range(200)]


@pytest.mark.parametrize("kind", PROBABILITY_KINDS)
def test_a_seed_repeats_a_story(kind: str) -> None:
    fault = f"{kind}=0.2"
    assert story(fault, seed=1) == story(fault, seed=1)


@pytest.mark.parametrize("kind", sorted(set(PROBABILITY_KINDS) - {"slow", "lying-write"}))
def test_some_answers_are_hit_and_others_not(kind: str) -> None:
    built = simulation(f"{kind}=0.2", seed=1)
    line = built.line()
    heard = [sent(line, ASK) for _ in range(200)]
    assert built.faults is not None
    assert 20 <= built.faults.counts[kind] <= 60
    clean = sum(answer == ANSWER for answer in heard)
    assert 80 <= clean <= 180
    assert heard != story(f"{kind}=0.2", seed=2)


def test_probability_nought_hits_none_and_one_hits_all() -> None:
    assert story(*[f"{kind}=0" for kind in PROBABILITY_KINDS]) == [ANSWER] * 200
    assert story("drop=1") == [b""] * 200
    assert story("duplicate=1") == [ANSWER * 2] * 200
    assert story("echo=1") == [ASK + ANSWER] * 200


def test_one_more_kind_leaves_the_others_where_they_were() -> None:
    alone = [answer == b"" for answer in story("drop=0.3", seed=4)]
    together = [answer == b"" for answer in story("drop=0.3", "flip=0.5", "echo=0", seed=4)]
    assert alone == together


def test_flip_is_one_of_the_low_seven_bits() -> None:
    for answer in story("flip=1"):
        changed = [a ^ b for a, b in zip(answer, ANSWER, strict=True) if a != b]
        assert len(changed) == 1
        assert changed[0] in (1, 2, 4, 8, 16, 32, 64)
        assert answer.upper() != ANSWER, "a letter in the other case is no wrong answer"


def test_truncate_leaves_a_beginning() -> None:
    heard = set(story("truncate=1"))
    assert heard == {ANSWER[:length] for length in range(1, len(ANSWER))}


def test_noise_comes_before_and_holds_delimiters() -> None:
    heard = story("noise=1")
    assert all(answer.endswith(ANSWER) and 1 <= len(answer) - len(ANSWER) <= 8 for answer in heard)
    noise = b"".join(answer.removesuffix(ANSWER) for answer in heard)
    assert {2, 3} <= set(noise)


def test_wrong_station_is_any_other_with_a_right_checksum() -> None:
    stations = set()
    for answer in story("wrong-station=1"):
        station = int(answer[1:3], 16)
        stations.add(station)
        assert answer == frame("4600000", station=station)
    assert len(stations) > 50
    assert 1 not in stations
    assert stations <= set(range(1, 255))


def test_late_comes_after_the_next_request_and_before_its_answer() -> None:
    line = build_simulation(faults=["late=1"]).line()
    assert sent(line, ASK) == b""
    assert sent(line, frame("4601R00008")) == ANSWER
    # Any request that was received lets it go, one that nobody answers too.
    assert sent(line, frame("40", station=9)) == ANSWER
    assert sent(line, frame("40", station=9)) == b""


def test_late_belongs_to_its_own_line() -> None:
    built = simulation("late=1")
    one, other = built.line(), built.line()
    sent(one, ASK)
    assert sent(other, ASK) == b""
    assert sent(one, frame("40", station=9)) == ANSWER


def test_slow_is_late_by_slow_s() -> None:
    assert build_simulation(faults=["slow=1"]).line().receive(ASK, 10.0) == [(10.8, ANSWER)]
    assert build_simulation(faults=["slow=1"], slow_s=2.0).line().receive(ASK, 10.0) == [(12.0, ANSWER)]


@pytest.mark.parametrize(
    ("write", "acknowledged"),
    [
        ("4501Y00001", "450"),
        ("423Y0000", "420"),
        ("4701R000000001", "470"),
        ("4901R000000001", "490"),
        ("500000" + PAGE_HEX, "500"),
    ],
)
def test_lying_write_is_acknowledged_and_not_made(write: str, acknowledged: str) -> None:
    built = simulation("lying-write=1")
    assert sent(built.line(), frame(write)) == frame(acknowledged)
    assert built.plcs[1].revision == 0
    # A broadcast acknowledges nothing, so it cannot lie.
    sent(built.line(), frame(write, station=0))
    assert built.plcs[1].revision > 0


def test_lying_write_still_refuses_what_is_wrong() -> None:
    line = build_simulation(faults=["lying-write=1"]).line()
    assert sent(line, frame("4501Y02561")) == frame("45A")
    assert sent(line, frame("411")) == frame("410")
    assert sent(line, frame("40")) == frame("400015400")


def test_power_cut() -> None:
    built = simulation("power-cut=3")
    faults, plc = built.faults, built.plcs[1]
    assert faults is not None
    line, other = built.line(), built.line()
    pages = list(plc.pages)

    def write(page: int) -> bytes:
        return sent(line, frame(f"50{page:04X}{PAGE_HEX}"))

    assert [write(0), write(1)] == [frame("500")] * 2
    assert sent(other, frame("50000200", station=9)) == b""
    assert built.powered
    assert line.receive(frame(f"500002{PAGE_HEX}") + ASK, 0.0) == []
    assert not built.powered
    assert not line.powered
    assert faults.counts == {"power-cut": 1}
    assert plc.pages[:2] == [bytes(range(128))] * 2
    assert plc.pages[2:] == pages[2:]
    assert sent(line, ASK) == sent(other, ASK) == write(3) == b""
    built.power_on()
    assert sent(line, ASK) == ANSWER
    # Power goes once.
    assert [write(2), write(3), write(4)] == [frame("500")] * 3


def test_power_cut_forgets_what_was_held_back_and_begun() -> None:
    built = simulation("power-cut=1", "late=1")
    line = built.line()
    sent(line, ASK)
    sent(line, frame("500000" + PAGE_HEX) + ASK[:5])
    built.power_on()
    assert sent(line, ASK[5:]) == b""
    assert sent(line, frame("40", station=9)) == b""


def test_what_line_without_faults_is() -> None:
    built = simulation()
    assert built.faults is None
    assert built.powered
    built.power_on()


def test_parse() -> None:
    plan = parse_faults(["drop=0.5", "echo=1", "power-cut=12"])
    assert plan.probabilities == {"drop": 0.5, "echo": 1.0}
    assert plan.power_cut == 12


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "KIND=P"),
        ("drop", "KIND=P"),
        ("smoke=1", "drop, flip, truncate"),
        ("=1", "KIND=P"),
        ("drop=", "0 to 1"),
        ("drop=often", "0 to 1, got 'often'"),
        ("drop=1.1", "0 to 1"),
        ("drop=-0.1", "0 to 1"),
        ("drop=nan", "0 to 1"),
        ("drop=inf", "0 to 1"),
        ("power-cut=0", "from 1"),
        ("power-cut=0.5", "from 1"),
        ("power-cut=²", "from 1"),
    ],
)
def test_parse_refuses_with_one_line(text: str, message: str) -> None:
    with pytest.raises(UsageError) as refused:
        parse_faults([text])
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("text", ["drop=0.1", "power-cut=1"])
def test_a_fault_is_given_once(text: str) -> None:
    with pytest.raises(UsageError, match="twice"):
        parse_faults([text, text])


def test_an_unknown_kind_names_all_valid_ones() -> None:
    with pytest.raises(UsageError) as refused:
        parse_faults(["smoke=1"])
    assert all(kind in str(refused.value) for kind in FAULT_KINDS)
