"""The doctor: faults of the line and the PLC's own complaints, and where else a PLC answers."""

from __future__ import annotations

from typing import Any

import pytest

from fatektool.client import Plc
from fatektool.errors import TransportClosed
from fatektool.exchange.link import Link
from fatektool.jobs.linetest.doctor import Examination, examine
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.line_settings import BAUDS
from fatektool.transport.base import LineSettings
from tests.jobs.linetest.test_scan import Adjustable, Line
from tests.rigs import simulated


def rules(found: Examination) -> set[str]:
    return {finding.rule for finding in found.findings}


def test_a_healthy_plc() -> None:
    found = examine(simulated(baud=9600).plc)
    assert found.healthy
    assert found.findings == []
    assert found.brief is not None
    assert found.loopback.total.ok > 50


@pytest.mark.parametrize(
    ("options", "rule", "healthy"),
    [
        ({"faults": ["drop=1"]}, "silence", False),
        ({"faults": ["wrong-line=1"]}, "wrong-line", False),
        ({"faults": ["echo=1"]}, "echo", True),
        ({"faults": ["echo=1", "drop=1"]}, "echo-only", False),
        ({"faults": ["bit-errors=0.003"]}, "errors-grow-with-size", False),
        ({"faults": ["slow=0.3"]}, "slow-plc", False),
        ({"scan_ms": 200}, "slow-plc", True),
        ({"latency_timer_ms": 16}, "usb-latency", True),
        ({"faults": ["twins=0.4"]}, "two-on-one-station", False),
    ],
)
def test_faults_of_the_line(options: dict[str, Any], rule: str, healthy: bool) -> None:
    found = examine(simulated(baud=9600, **options).plc)
    assert rule in rules(found)
    assert found.healthy == healthy


@pytest.mark.parametrize(
    ("flag", "rule"),
    [
        ("battery_low", "battery-low"),
        ("ladder_checksum_error", "ladder-checksum-error"),
        ("watchdog", "watchdog-timeout"),
        ("emergency_stop", "emergency-stop"),
    ],
)
def test_what_the_plc_complains_of(flag: str, rule: str) -> None:
    bench = simulated(baud=9600)
    setattr(bench.device, flag, True)
    found = examine(bench.plc)
    assert rules(found) == {rule}
    assert not found.healthy


def test_the_high_speed_link_of_an_fbs() -> None:
    bench = simulated(baud=9600, model="fbs-20mc")
    assert examine(bench.plc).findings == []
    bench.plc.write_registers(Element("R", 4058), [5, 0x0A11])
    (finding,) = examine(bench.plc).findings
    assert (finding.rule, finding.fault) == ("high-speed-link", True)
    assert finding.finding == "station 5 of the high-speed link (port 2, MD3) is abnormal"
    assert finding.evidence == (
        "R4058 = 5, R4059 = 0A11H (17 abnormal answers, the last: no answer from the slave)"
    )
    assert "clear both with 'fatektool write R4058=0 R4059=0', again until they stay 0" in finding.advice
    bench.plc.write_registers(Element("R", 4058), [0, 3])
    (finding,) = examine(bench.plc).findings
    assert (finding.rule, finding.fault) == ("high-speed-link", False)


def test_what_other_plcs_hold_there_is_no_finding() -> None:
    bench = simulated(baud=9600)
    bench.plc.write_registers(Element("R", 4058), [5, 0x0A11])
    assert examine(bench.plc).findings == []


def doctored(line: Line, station: int) -> Plc:
    transport = Adjustable(line)
    transport.serial_settings = "9600 7E1"
    line.set_to = 9600
    return Plc(Link(transport, FACON, station, LineSettings()), "line")


class StatusOnly(Line):
    """Answers nothing but 40, which is all that another setting is asked."""

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        return super().receive(data, now) if data[3:5] == b"40" else []


def test_a_plc_at_another_speed_is_found() -> None:
    line = StatusOnly({3}, baud=38400)
    plc = doctored(line, 3)
    steps: list[str] = []
    found = examine(plc, lambda step, _done, _total: steps.append(step))
    assert rules(found) == {"silence", "answers-elsewhere"}
    advice = found.findings[-1].advice
    assert advice == "use: fatektool status -p line -s 3 --baud 38400 --line 7E1"
    assert set(steps) == {"loopback", "stations 1-3"}
    assert line.set_to == 9600


def test_a_plc_at_the_factory_station_is_found() -> None:
    found = examine(doctored(StatusOnly({1}), 3))
    assert "-s 1 --baud 9600" in found.findings[-1].advice


def test_another_station_at_another_speed_is_found() -> None:
    found = examine(doctored(StatusOnly({5}, baud=19200), 3))
    assert found.findings[-1].advice == "use: fatektool status -p line -s 5 --baud 19200 --line 7E1"
    assert found.findings[-1].finding == "station 5 answers at 19200 7E1"


def test_another_station_is_found_over_a_network() -> None:
    line = StatusOnly({4})
    plc = doctored(line, 3)
    plc.link.transport.serial_settings = None
    plc.link.transport.name = "tcp://192.168.2.3:500"
    found = examine(plc)
    assert found.findings[-1].advice == "use: fatektool status -p line -s 4"
    assert found.findings[-1].finding == "station 4 answers"
    assert not [each for each in found.findings if "A and B" in each.advice]


def test_nobody_anywhere() -> None:
    assert rules(examine(doctored(StatusOnly(set()), 3))) == {"silence"}


def test_a_line_that_is_gone_is_an_error() -> None:
    plc = simulated().plc
    plc.link.transport.close()
    with pytest.raises(TransportClosed):
        examine(plc)


@pytest.mark.parametrize("delay_ms", [550, 700, 900, 1100, 1500, 1900, 3000])
def test_the_time_out_that_is_recommended_is_proven_by_a_try(delay_ms: int) -> None:
    bench = simulated(baud=9600, scan_ms=delay_ms)
    found = examine(bench.plc)
    assert found.enough is not None
    assert found.enough.proven
    assert 1.3 * delay_ms / 1000 < found.enough.timeout_s <= 2 * delay_ms / 1000
    (late,) = found.findings
    assert (late.rule, late.fault, found.brief is not None) == ("slow-plc", True, True)
    assert late.advice == f"give --timeout {found.enough.timeout_s:g} with every command"
    assert "4 of 4 were answered, the slowest after" in late.evidence
    again = simulated(baud=9600, scan_ms=delay_ms, timeout_s=found.enough.timeout_s)
    assert all(not finding.fault for finding in examine(again.plc).findings)


def test_a_plc_that_is_late_is_not_looked_for_elsewhere() -> None:
    bench = simulated(baud=9600, scan_ms=900)
    bench.plc.link.transport.serial_settings = "9600 7E1"
    assert examine(bench.plc).searched is None


@pytest.mark.parametrize("baud", BAUDS[1:])
def test_a_plc_is_found_at_every_speed_that_fatek_has(baud: int) -> None:
    found = examine(doctored(StatusOnly({1}, baud=baud), 1))
    assert f"--baud {baud} --line 7E1" in found.findings[-1].advice


def test_the_search_ends_and_says_what_was_tried() -> None:
    found = examine(doctored(StatusOnly(set()), 1))
    assert found.searched is not None
    assert {setting.line.baud for setting in found.searched.tried} == set(BAUDS)
    assert {setting.line.format for setting in found.searched.tried} == {"7E1", "8E1", "8N1"}
    assert found.searched.duration_s < 122
    assert not found.searched.out_of_time
    assert found.searched.stations == list(range(1, 9))
