"""Bad lines: what is read is right or refused, and a write that is reported done is done."""

from __future__ import annotations

import pytest

from fatektool.errors import LineError
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.elements.writes import write_elements
from fatektool.protocol.elements import Element
from tests.rigs import Simulated, simulated

KINDS = ["drop", "truncate", "noise", "duplicate", "late", "slow", "wrong-station", "flip"]
PROTOCOLS = ["modbus-rtu", "modbus-ascii", "modbus-tcp"]
SAVED = [0x0103 + place for place in range(250)]  # values that look like frames that begin
ALL = [Element("R", address) for address in range(250)]
ALL += [Element.parse(name) for name in ("DR100", "X3", "M8", "DWY0", "RT5", "WM0", "DRC200", "D7")]
CASES = [
    (protocol, kind)
    for protocol in PROTOCOLS
    for kind in KINDS
    if (protocol, kind) != ("modbus-tcp", "flip")  # it has no checksum: the network's has been checked
]


def plant(protocol: str, *faults: str, seed: int = 0) -> Simulated:
    """A PLC with something in its memory, behind a bad line."""
    made = simulated(protocol=protocol, faults=faults, seed=seed, baud=9600 if seed % 2 else None)
    made.device.write_words("R", 0, SAVED)
    made.device.write_long_counters(0, [2, 1])
    return made


def expected(element: Element) -> int:
    at = element.address
    match element.symbol:
        case "R":
            return SAVED[at]
        case "DR":
            return SAVED[at + 1] << 16 | SAVED[at]
    return 0x1_0002 if element.symbol == "DRC" else 0


@pytest.mark.parametrize(("protocol", "kind"), CASES)
@pytest.mark.parametrize("probability", [0.1, 0.5])
def test_no_read_is_ever_wrong_and_no_write_said_done_is_not(
    protocol: str, kind: str, probability: float
) -> None:
    writes = [(Element.parse(name), value) for name, value in (("R5", 77), ("M9", 1), ("R9", 3), ("R10", 4))]
    done = 0
    for seed in range(3):
        made = plant(protocol, f"{kind}={probability}", *(["echo=1"] if seed == 2 else []), seed=seed)
        try:
            reading = read_elements(made.plc, ALL)
        except LineError:
            continue
        assert not reading.errors
        assert reading.values == {element: expected(element) for element in ALL}
        try:
            assert write_elements(made.plc, writes) == []
        except LineError:
            continue
        done += 1
        assert made.device.read_words("R", 5, 1) + made.device.read_words("R", 9, 2) == [77, 3, 4]
        assert made.device.read_discretes("M", 9, 1) == b"\1"
    assert done or probability > 0.1


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_a_clean_line_costs_few_exchanges(protocol: str) -> None:
    made = plant(protocol)
    reading = read_elements(made.plc, [Element("R", address) for address in range(250)])
    assert reading.requests == 2
    counters = made.plc.link.counters
    fences = 0 if protocol == "modbus-tcp" else 1
    assert (counters.exchanges, counters.trouble, counters.fences) == (2 + fences, 0, fences)
