"""Every job over every fault of the simulator in both protocols: the right result or exit code, in time."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest

from fatektool.jobs.linetest.scan import scan
from fatektool.jobs.linetest.scan_result import ScanSetting
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.simulator.faults import BIT_ERRORS, FAULT_KINDS, POWER_CUT
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from tests.reliability.story import JOBS
from tests.rigs import Rig

if TYPE_CHECKING:
    from pathlib import Path

NO_CHECKSUM = {"modbus-tcp": {"flip", BIT_ERRORS}}
"""TCP has a checksum of its own, so Modbus/TCP has none: what the simulator spoils there nobody can see."""

MATRIX = [
    pytest.param(name, kind, protocol, id=f"{name}-{kind}-{protocol}")
    for name, job in JOBS.items()
    for kind in FAULT_KINDS
    for protocol in job.protocols
    if (kind != POWER_CUT or name == "restore") and kind not in NO_CHECKSUM.get(protocol, ())
]


def strengths(kind: str) -> list[str]:
    if kind == POWER_CUT:
        return [f"{kind}={write}" for write in (1, 3, 5)]
    shares = (0.0005, 0.002, 0.02) if kind == BIT_ERRORS else (0.05, 0.3, 1.0)
    return [f"{kind}={share}" for share in shares]


def tell(name: str, protocol: str, faults: list[str], seed: int, folder: Path) -> tuple[Rig, int]:
    job = JOBS[name]
    rig = Rig(protocol, faults, seed, stations=job.stations, baud=9600 if seed % 2 else None)
    place = folder / f"{name}-{protocol}-{'-'.join(faults)}-{seed}"
    place.mkdir()
    code = job.told(rig, place)
    assert code in job.codes, (code, faults, seed)
    return rig, code


class Strangers:
    """Behind the right answer to 40 of station 1, and before it: frames of 255, and of 0."""

    def __init__(self) -> None:
        self.asked = 0

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        self.asked += 1
        assert data[3:5] == b"40"
        stranger = b"\x02FF4000254004D\x03" + b"\x020040002540021\x03"
        answer = b"\x020140002540022\x03"
        return [(now, stranger + (answer if data[1:3] == b"01" else b"") + stranger)]


def test_a_station_that_is_in_no_paper_ends_no_scan_and_is_told() -> None:
    setting = ScanSetting(FACON, LineSettings())
    result = scan(MemoryTransport(Strangers()), [setting], [2, 1], timeout_s=0.5)
    assert {station.station for station in result.found} == {1, 255}


@pytest.mark.parametrize(("name", "kind", "protocol"), MATRIX)
def test_every_job_over_every_fault(name: str, kind: str, protocol: str, tmp_path: Path) -> None:
    for seed, fault in enumerate(strengths(kind)):
        tell(name, protocol, [fault], seed, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", JOBS)
def test_more_of_the_same(name: str, tmp_path: Path) -> None:
    for _, kind, protocol in (tuple(case.values) for case in MATRIX if case.values[0] == name):
        for fault in strengths(str(kind)):
            for seed in range(8):
                tell(name, str(protocol), [fault], seed, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", JOBS)
def test_two_faults_at_once(name: str, tmp_path: Path) -> None:
    """Any two but a line that echoes now and then: there the echo of 4E cannot be told from its answer."""
    random = Random(name)  # noqa: S311  # the same pairs each time
    kinds = [kind for kind in FAULT_KINDS if kind not in {POWER_CUT, "echo"}]
    lines = [[random.choice(strengths(kind)[:2]) for kind in random.sample(kinds, 2)] for _ in range(60)]
    lines += [["echo=1", random.choice(strengths(kind)[:2])] for kind in kinds]
    if name == "restore":
        lines += [
            [f"{POWER_CUT}={write}", random.choice(strengths(random.choice(kinds)))] for write in (2, 4, 5)
        ]
    for seed, faults in enumerate(lines):
        checked = [protocol for protocol in JOBS[name].protocols if protocol not in NO_CHECKSUM]
        tell(name, random.choice(checked), faults, seed, tmp_path)
