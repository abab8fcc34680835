"""Each rule of the diagnosis, produced on the simulator."""

from __future__ import annotations

from typing import Any

import pytest

from fatektool.client import Plc
from fatektool.jobs.linetest.diagnosis import diagnose
from fatektool.jobs.linetest.finding import Case, Finding
from fatektool.jobs.linetest.loopback.result import LoopbackPlan
from fatektool.jobs.linetest.loopback.run import run_loopback
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.transport.base import LineSettings
from tests.exchange.peer import Rules, Script, frame, linked, soon
from tests.night import seeds
from tests.rigs import simulated


def findings(plc: Plc, count: int = 240) -> dict[str, Finding]:
    result = run_loopback(plc, LoopbackPlan(count=count))
    case = Case(result, plc.link.line, plc.link.station, plc.link.codec)
    return {finding.rule: finding for finding in diagnose(case)}


RULES: list[tuple[dict[str, Any], set[str], str]] = [
    ({}, set(), ""),
    ({"scan_ms": 3}, set(), ""),
    ({"faults": ["drop=1"]}, {"silence"}, "0 bytes received"),
    ({"faults": ["wrong-line=1"]}, {"wrong-line"}, "no valid frame"),
    ({"faults": ["echo=1"]}, {"echo"}, "bytes received"),
    ({"faults": ["echo=1", "drop=1"]}, {"echo-only"}, "all of them echo"),
    ({"faults": ["bit-errors=0.002"]}, {"errors-grow-with-size"}, "256: "),
    ({"faults": ["flip=0.2"]}, {"damaged-frames"}, "no valid frame"),
    ({"faults": ["drop=0.1"]}, {"lost-frames"}, "nothing was received in their place"),
    ({"faults": ["slow=0.2"]}, {"slow-plc"}, "after --timeout 0.5"),
    ({"scan_ms": 250}, {"slow-plc"}, "250"),
    ({"latency_timer_ms": 16}, {"usb-latency"}, "on these steps"),
    ({"faults": ["twins=0.3"]}, {"two-on-one-station"}, "received twice"),
    ({"faults": ["wrong-station=0.2"]}, {"foreign-station", "lost-frames"}, "answers from station"),
]


@pytest.mark.parametrize(
    ("options", "rules", "evidence"),
    RULES,
    ids=lambda value: "+".join(sorted(value)) if isinstance(value, set) else str(value)[:40],
)
def test_a_rule_finds_what_it_is_for_and_no_other_does(
    options: dict[str, Any], rules: set[str], evidence: str
) -> None:
    found = findings(simulated(baud=9600, **options).plc)
    assert found.keys() <= rules
    assert bool(found) == bool(rules)
    assert not evidence or any(evidence in finding.evidence for finding in found.values())
    for finding in found.values():
        assert finding.finding
        assert finding.advice


@pytest.mark.parametrize("seed", seeds(6, 6))
def test_errors_that_do_not_grow_are_not_said_to(seed: int) -> None:
    found = findings(simulated(baud=9600, faults=["flip=0.15"], seed=seed).plc)
    assert "errors-grow-with-size" not in found


def test_a_line_of_eight_bits_where_the_plc_sends_seven_and_parity() -> None:
    """Even parity in the eighth bit: what a port set to 8N1 reads of a PLC set to 7E1."""

    def with_parity(data: bytes) -> bytes:
        return bytes(byte | (byte.bit_count() % 2) << 7 for byte in data)

    answers = [soon(with_parity(frame("4E" + "a" * size))) for size in range(9)]
    plc = Plc(linked(Script(*answers), line=LineSettings(9600, "8N1")), "peer")
    assert findings(plc, 6).keys() == {"wrong-format"}


def test_a_plc_that_refuses_loopbacks() -> None:
    def refuse(_asked: int) -> list[tuple[float, bytes]]:
        return soon(frame("4E4"))

    rules = Rules(loopback=False)
    plc = Plc(linked(rules), "peer")
    plan = LoopbackPlan(count=6)
    answers = {frame("4E" + "\x00" * size): refuse for size in (0, 1)}
    rules.answers.update(answers)
    result = run_loopback(plc, plan)
    found = diagnose(Case(result, plc.link.line, 1, FACON))
    assert "refused" in {finding.rule for finding in found}


def test_a_network_that_is_faster_than_the_line_named() -> None:
    assert findings(simulated().plc).keys() == {"faster-than-line"}
