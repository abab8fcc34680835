"""Does planning pay? Its time beside the line time that it saves, and its plans beside the best there are.

Saved is against two plain clients: one request an element, and runs that go on over gaps of 16. A plan that
is no better than the plain one saves nothing; then there is no ratio.

The best there are, in the bytes that each codec gives, with turnarounds of none to 1000 bytes: for 1000
random sets of up to 11 elements of mixed kinds and widths, or 24 side by side, by trying everything
(tests/planner/exhaustive.py); for large sets of registers of one kind by a table (tests/planner/one_kind.py).
Exit code 1 if a plan costs more than 1 % above.

Usage: python bench/planner.py [BAUD …]
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from random import Random
from statistics import mean
from typing import TYPE_CHECKING, Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parent.parent))

from figures import figure

from fatektool.planner import plan_reads, plan_writes, turnaround_bytes
from fatektool.protocol.elements import Element
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.fatek.mseries.codec import MSERIES
from fatektool.protocol.modbus.ascii import ASCII
from fatektool.protocol.modbus.rtu import RTU
from fatektool.protocol.modbus.tcp import TCP
from tests.planner.exhaustive import READ_CAPS, WRITE_CAPS, Caps, least_read, least_write, wire_bytes
from tests.planner.one_kind import least_of_registers
from tests.planner.plain import merged, one_each
from tests.planner.sets import TURNAROUNDS, apart, named, sayable, scattered, side_by_side, small_set

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Request

LIMIT = 0.1
TURNAROUND_S = 0.010
BITS_PER_CHARACTER = 10
RUNS = 5
MOST_GAP = 0.01
SETS = 1000
LARGE_SETS = 40
SCATTERED = 0.7


class Protocol(NamedTuple):
    """A codec, and what its requests hold."""

    codec: Codec
    read: Caps
    write: Caps


_MODBUS_READ, _MODBUS_WRITE = Caps(2000, 125, 0, packs=True), Caps(1968, 123, 0, packs=True)
PROTOCOLS = (
    Protocol(FACON, READ_CAPS, WRITE_CAPS),
    Protocol(MSERIES, READ_CAPS, WRITE_CAPS),
    Protocol(RTU, _MODBUS_READ, _MODBUS_WRITE),
    Protocol(ASCII, _MODBUS_READ, _MODBUS_WRITE),
    Protocol(TCP, _MODBUS_READ, _MODBUS_WRITE),
)


def sets() -> dict[str, list[Element]]:
    """What people read."""
    random = Random(1)  # noqa: S311  # the same sets each time
    mixture = [("M", 2000, 60), ("R", 3840, 60), ("D", 3072, 40), ("X", 256, 20), ("Y", 256, 20)]
    return {
        "R0-R3839": named("R0-R3839"),
        "M0-M1999": named("M0-M1999"),
        "40 registers of 3840": scattered(random, "R", 3840, 40),
        "400 registers of 3840": scattered(random, "R", 3840, 400),
        "2000 registers of 3840": scattered(random, "R", 3840, 2000),
        "100 discretes of 2000": scattered(random, "M", 2000, 100),
        "800 discretes of 2000": scattered(random, "M", 2000, 800),
        "200 of five kinds": [one for each in mixture for one in scattered(random, *each)],
    }


def planned(elements: list[Element], turnaround: float) -> tuple[list[Request[Any]], float]:
    """The plan, and the least time that it took to make."""
    plan: list[Request[Any]] = []
    took = []
    for _ in range(RUNS):
        began = time.perf_counter()
        plan = plan_reads(elements, FACON, turnaround=turnaround)
        took.append(time.perf_counter() - began)
    return plan, min(took)


def row(name: str, elements: list[Element], baud: int) -> str:
    """One line: requests, line times, and planning as a part of what it saves."""
    byte_s = BITS_PER_CHARACTER / baud
    turnaround = turnaround_bytes(TURNAROUND_S, byte_s)
    plan, took = planned(elements, turnaround)
    line_s = wire_bytes(plan, FACON, turnaround) * byte_s
    text = f"{name:<23} {len(plan):3} requests {line_s:8.3f} s  planning {took * 1000:6.1f} ms"
    for rule, word in ((one_each, "one each"), (merged, "gaps of 16")):
        plain = rule(elements)
        plain_s = wire_bytes(plain, FACON, turnaround) * byte_s
        saved = plain_s - line_s
        ratio = f"{took / saved:7.4f}" if saved > byte_s else "      -"
        text += f"  {word} {len(plain):4} requests {plain_s:8.3f} s ratio {ratio}"
    return text


class Gaps:
    """How much more than the least some plans cost, each as a part of the least."""

    def __init__(self) -> None:
        self._found: list[float] = []

    def add(self, cost: float, least: float) -> None:
        """Keep one."""
        self._found.append(cost / least - 1)

    @property
    def most(self) -> float:
        """The largest."""
        return max(self._found)

    def __str__(self) -> str:
        return f"{mean(self._found):.2%} on average, {self.most:.2%} at most"


class Against(NamedTuple):
    """A protocol's gaps to the best plans: of reads, of writes, and of the rule of gaps of 16 in reads."""

    reads: Gaps
    writes: Gaps
    plain: Gaps

    def show(self, name: str) -> bool:
        """Print a line; False if a plan costs too much."""
        print(f"{name:<34} reads {self.reads}; writes {self.writes}; gaps of 16 {self.plain}")
        figure(f"{name}: cost over the best", max(self.reads.most, self.writes.most), limit=MOST_GAP)
        return max(self.reads.most, self.writes.most) <= MOST_GAP


def random_set(random: Random) -> list[Element]:
    """Elements that all that is possible can be tried for: scattered, of mixed widths, or side by side."""
    return small_set(random, 11) if random.random() < SCATTERED else side_by_side(random, 24)


def against_everything(protocol: Protocol) -> Against:
    """Small sets of any kinds, beside the least of all that is possible."""
    random = Random(2)  # noqa: S311
    found = Against(Gaps(), Gaps(), Gaps())
    codec = protocol.codec
    for _ in range(SETS):
        elements: list[Element] = []
        while not elements:
            elements = sayable(random_set(random), codec)
        turnaround = random.choice(TURNAROUNDS)
        least = least_read(elements, codec, turnaround, caps=protocol.read)
        found.reads.add(cost_of_reads(elements, codec, turnaround), least)
        found.plain.add(wire_bytes(merged(elements), codec, turnaround), least)
        written = apart(sayable(elements, codec, writes=True))
        if written:
            least = least_write(written, codec, turnaround, caps=protocol.write)
            found.writes.add(cost_of_writes(written, codec, turnaround), least)
    return found


def against_table(protocol: Protocol) -> Against:
    """Large sets of registers of one kind, beside the least that they can cost."""
    random = Random(3)  # noqa: S311
    found = Against(Gaps(), Gaps(), Gaps())
    codec = protocol.codec
    for _ in range(LARGE_SETS):
        count = random.randint(20, 120)
        addresses = set(random.sample(range(random.choice((count, 2 * count, 600, 3800))), count))
        elements = [Element("R", address) for address in addresses]
        turnaround = random.choice(TURNAROUNDS)
        least = least_of_registers("R", addresses, codec, turnaround, protocol.read)
        found.reads.add(cost_of_reads(elements, codec, turnaround), least)
        found.plain.add(wire_bytes(merged(elements), codec, turnaround), least)
        least = least_of_registers("R", addresses, codec, turnaround, protocol.write, writes=True)
        found.writes.add(cost_of_writes(elements, codec, turnaround), least)
    return found


def cost_of_reads(elements: list[Element], codec: Codec, turnaround: float) -> float:
    """What the planner's reads cost."""
    return wire_bytes(plan_reads(elements, codec, turnaround=turnaround), codec, turnaround)


def cost_of_writes(elements: list[Element], codec: Codec, turnaround: float) -> float:
    """What the planner's writes cost."""
    plan = plan_writes([(element, 0) for element in elements], codec, turnaround=turnaround)
    return wire_bytes(plan, codec, turnaround)


def main() -> int:
    """Print a row a set and baud rate, and the gaps; 1 if one is too large."""
    for baud in [int(word) for word in sys.argv[1:]] or [9600, 921600]:
        print(f"{baud} baud, limit of the ratio to one each {LIMIT}")
        for name, elements in sets().items():
            print(row(name, elements, baud))
    print(f"cost over that of the best plan, limit {MOST_GAP:.0%}")
    kept = True
    for protocol in PROTOCOLS:
        name = protocol.codec.name
        kept &= against_everything(protocol).show(f"{name}, {SETS} sets")
        kept &= against_table(protocol).show(f"{name}, {LARGE_SETS} large sets of R")
    print("within it" if kept else "NOT within it")
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
