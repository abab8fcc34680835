"""Rounds: what is asked for, in how few bytes, and what the PLC refuses."""

from __future__ import annotations

import re

import pytest

from fatektool.errors import NoAnswer
from fatektool.jobs.monitor.rounds import ElementRounds
from fatektool.protocol.elements import Element
from tests.jobs.monitor.bench import Monitored
from tests.root import DOCS

STATUS = b"40"
FRAME = 6
"""Bytes of a request beside its command and data: STX, station, LRC, ETX."""


def a_round(bench: Monitored) -> list[bytes]:
    """What a round asks for, once the plan is made and the program is compared."""
    bench.monitor.read()
    bench.monitor.read()
    bench.wire.bodies()
    bench.monitor.read()
    return bench.wire.bodies()


@pytest.mark.parametrize(
    ("networks", "request_", "asked", "answered"),
    [
        ([1], b"4803M0421X0000Y0004", 33, 27),
        ([2], b"4805M0000R00008RT0030T0030X0001", 45, 35),
        ([5], b"4803WM0000WT0200Y0002", 35, 33),  # M0, M3 and T200 to T206 in a word each
        ([0, 1], b"4803M0421WX0000WY0000", 35, 33),
        (None, b"480DDWM0400WM0000M0300R00006R00008R00100RC0000RT0030S0003T0030WT0200WX0000WY0000", 94, 71),
    ],
)
def test_the_bytes_of_a_round(networks: list[int] | None, request_: bytes, asked: int, answered: int) -> None:
    """The mode, and in one request the elements of the chosen networks and no others."""
    bench = Monitored(networks)
    assert a_round(bench) == [STATUS, request_]
    assert asked == sum(FRAME + len(body) for body in (STATUS, request_))
    bench.monitor.read()
    assert bench.wire.answered == answered


@pytest.mark.parametrize("networks", [[1], [2], [5], [7], None])
def test_a_round_takes_no_more_bytes_than_a_request_an_element(networks: list[int] | None) -> None:
    bench = Monitored(networks)
    a_round(bench)
    bench.monitor.read()
    together = sum(map(len, bench.wire.asked)) + bench.wire.answered
    bench.wire.bodies()
    bench.plc.brief_status()
    for name in {each.name for network in bench.networks for each in network.shown}:
        element = Element.parse(name)
        if element.kind.bits == 1:
            bench.plc.read_discretes(element, 1)
        else:
            bench.plc.read_registers(element, 1)
    assert together < sum(map(len, bench.wire.asked)) + bench.wire.answered


def test_the_seconds_of_a_round_are_those_of_the_documents() -> None:
    """At 9600 baud, over a line and a PLC that take no more than the bytes do."""
    (said,) = re.findall(r"a round of one network of three contacts and coils takes ([\d.]+) s,", _docs())
    (all_,) = re.findall(r"one of the twelve networks of all kinds that the tests have ([\d.]+) s", _docs())
    for networks, expected in (([1], said), (None, all_)):
        bench = Monitored(networks, baud=9600)
        a_round(bench)
        assert f"{bench.monitor.read().duration_s:.2f}" == expected


def _docs() -> str:
    return " ".join((DOCS / "programs.md").read_text(encoding="utf-8").split())


def test_other_networks_are_another_plan() -> None:
    bench = Monitored([1])
    a_round(bench)
    bench.monitor.networks = Monitored([5]).networks
    bench.monitor.read()
    bench.wire.bodies()
    found = bench.monitor.read()
    assert bench.wire.bodies() == [STATUS, b"4803WM0000WT0200Y0002"]
    assert {*found.values} == {"M0", "T200", "T201", "M3", "T204", "T203", "T206", "Y2"}


def test_values_are_those_of_the_plc_each_round() -> None:
    bench = Monitored([2])
    for number in range(4):
        bench.device.memory.registers["R"][8] = 0xFFFF - number
        bench.device.set_input(1, number % 2)
        bench.device.running = number % 2 == 0
        found = bench.monitor.read()
        assert (found.values["R8"], found.values["X1"]) == (0xFFFF - number, number % 2)
        assert found.running is (number % 2 == 0)


def test_what_is_refused_is_asked_once() -> None:
    bench = Monitored([1])
    bench.device.memory._sizes["M"] = 400
    first = bench.monitor.read()
    assert (first.values, [*first.errors]) == ({"X0": 0, "Y4": 0}, ["M421"])
    assert a_round(bench) == [STATUS, b"4802X0000Y0004"]
    assert [*bench.monitor.read().errors] == ["M421"]


def test_what_is_refused_later_on_is_found_out() -> None:
    """A PLC that another one took the place of."""
    bench = Monitored([1])
    a_round(bench)
    bench.device.memory._sizes["M"] = 400
    found = bench.monitor.read()
    assert (found.values, [*found.errors]) == ({"X0": 0, "Y4": 0}, ["M421"])


def test_elements_that_the_protocol_does_not_have() -> None:
    bench = Monitored([1], protocol="modbus-rtu")
    rounds = ElementRounds(bench.plc)
    rounds.choose(["X0", "RT30", "RC0", "Y0"])
    found = rounds.read()
    assert found.running is None
    assert {*found.values} | {*found.errors} == {"X0", "RT30", "RC0", "Y0"}
    assert found.values["X0"] == 0


def test_a_round_without_an_answer_gives_nothing() -> None:
    """No half of a round is taken for a round."""
    bench = Monitored([1], retries=0)
    a_round(bench)
    bench.wire.silent_to = lambda frame: frame[3:5] == b"48"
    with pytest.raises(NoAnswer):
        bench.monitor.read()
    bench.wire.silent_to = lambda _: False
    assert bench.monitor.read().values == {"X0": 0, "M421": 0, "Y4": 0}


def test_no_elements_at_all() -> None:
    bench = Monitored([])
    assert a_round(bench) == [STATUS]
    assert bench.monitor.read().values == {}
