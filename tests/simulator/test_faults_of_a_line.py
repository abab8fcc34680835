"""Faults of the line that a diagnosis tells apart: a wrong setting, twins, bit errors."""

from __future__ import annotations

import pytest

from fatektool.errors import UsageError
from fatektool.simulator.build import Simulation, build_simulation
from fatektool.simulator.faults import parse_faults
from tests.simulator.slaves import mseries_wire
from tests.simulator.wire import frame, sent

LOOPBACK = frame("4E" + "x" * 200)
PROTOCOLS = {
    "facon": (frame("4601R00007"), frame("4600000"), b"\x03"),
    "mseries": (mseries_wire.request("4601'R'0007"), mseries_wire.reply("46000000"), b"\xaa"),
}


@pytest.fixture(params=PROTOCOLS)
def protocol(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def story(protocol: str, *faults: str, seed: int = 0, count: int = 400) -> list[bytes]:
    line = build_simulation(protocol=protocol, faults=faults, seed=seed).line()
    return [sent(line, PROTOCOLS[protocol][0]) for _ in range(count)]


def strikes(built: Simulation, kind: str) -> int:
    assert built.faults is not None
    return built.faults.counts[kind]


# A wrong baud rate or format ---------------------------------------------------------------------


def test_on_a_wrong_line_noise_comes_that_no_frame_ends(protocol: str) -> None:
    asked, answered, end = PROTOCOLS[protocol]
    heard = story(protocol, "wrong-line=1", count=2000)
    noise = b"".join(heard)
    assert answered not in noise
    assert set(noise) == set(range(256)) - {end[0]}
    assert {len(each) for each in heard} == set(range(len(asked) * 3 // 4, len(asked) * 5 // 4 + 1))


def test_on_a_wrong_line_nothing_is_understood() -> None:
    built = build_simulation(faults=["wrong-line=1"])
    line = built.line()
    for request in ("4701R000000001", "411", "500000" + "00" * 128):
        assert sent(line, frame(request)) != b""
        assert sent(line, frame(request, station=0)) == b""
    assert built.plcs[1].revision == 0
    assert strikes(built, "wrong-line") == 6
    assert sent(line, frame("40", station=9)) == b""
    assert strikes(built, "wrong-line") == 6


def test_a_line_that_is_wrong_at_times() -> None:
    heard = story("facon", "wrong-line=0.25")
    assert 270 <= heard.count(PROTOCOLS["facon"][1]) <= 330
    assert heard == story("facon", "wrong-line=0.25")
    assert heard != story("facon", "wrong-line=0.25", seed=1)


def test_what_a_wrong_line_makes_of_an_answer_is_hit_by_nothing_else() -> None:
    others = (
        "flip",
        "truncate",
        "noise",
        "duplicate",
        "twins",
        "drop",
        "wrong-station",
        "late",
        "bit-errors",
    )
    assert story("facon", "wrong-line=1", *[f"{kind}=1" for kind in others]) == story("facon", "wrong-line=1")


def test_a_late_answer_does_not_come_for_a_request_that_was_not_understood() -> None:
    built = build_simulation(faults=["late=1", "wrong-line=0"])
    line = built.line()
    asked, answered, _ = PROTOCOLS["facon"]
    assert sent(line, asked) == b""
    assert sent(line, asked) == answered
    assert built.faults is not None
    built.faults.plan = parse_faults(["late=1", "wrong-line=1"])
    assert answered not in sent(line, asked)


# Two PLCs at one station -------------------------------------------------------------------------


def test_twins_answer_behind_each_other_or_over_each_other(protocol: str) -> None:
    answered = PROTOCOLS[protocol][1]
    over = bytes(a & b for a, b in zip(answered + b"\xff", b"\xff" + answered, strict=True))
    heard = story(protocol, "twins=1")
    assert set(heard) == {answered * 2, over}
    assert 150 <= heard.count(over) <= 250
    # A collision begins and ends as an answer does, and is one byte longer.
    assert over[:1] == answered[:1]
    assert over[-1:] == answered[-1:]
    assert over not in {answered, answered * 2}


def test_twins_in_step_look_like_one() -> None:
    heard = story("facon", "twins=0.5")
    assert 150 <= heard.count(PROTOCOLS["facon"][1]) <= 250
    assert heard == story("facon", "twins=0.5")
    assert set(story("facon", "twins=0")) == {PROTOCOLS["facon"][1]}


# Errors that grow with size ----------------------------------------------------------------------


def test_bit_errors_hit_every_byte_at_certainty(protocol: str) -> None:
    answered = PROTOCOLS[protocol][1]
    for heard in story(protocol, "bit-errors=1"):
        assert {a ^ b for a, b in zip(heard, answered, strict=True)} <= {1, 2, 4, 8, 16, 32, 64}
    assert set(story(protocol, "bit-errors=0")) == {answered}


def test_bit_errors_are_of_bytes_so_that_long_answers_suffer_more() -> None:
    built = build_simulation(faults=["bit-errors=0.002"], seed=3)
    line = built.line()
    short = [sent(line, frame("40")) for _ in range(1000)]
    bits = strikes(built, "bit-errors")
    assert 15 <= bits <= 50  # 30 of 15 000 bytes are to be expected
    long = [sent(line, LOOPBACK) for _ in range(1000)]
    assert 350 <= strikes(built, "bit-errors") - bits <= 480  # 416 of 208 000
    assert sum(each != short[0] for each in short) <= 60
    assert 280 <= sum(each != LOOPBACK for each in long) <= 400  # 1 - 0.998 ** 208 is 34 %
    assert all(len(each) == len(LOOPBACK) for each in long)


def test_bit_errors_repeat_and_leave_the_others_where_they_were() -> None:
    assert story("facon", "bit-errors=0.05") == story("facon", "bit-errors=0.05")
    assert story("facon", "bit-errors=0.05") != story("facon", "bit-errors=0.05", seed=1)
    alone = [each == b"" for each in story("facon", "drop=0.3")]
    assert alone == [each == b"" for each in story("facon", "drop=0.3", "bit-errors=0.5", "twins=0.5")]


@pytest.mark.parametrize("kind", ["wrong-line", "twins", "bit-errors"])
@pytest.mark.parametrize("value", ["", "often", "1.5", "-1", "nan"])
def test_what_is_no_probability(kind: str, value: str) -> None:
    with pytest.raises(UsageError, match=f"fault {kind}: expected a probability from 0 to 1, got"):
        parse_faults([f"{kind}={value}"])
