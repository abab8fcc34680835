"""Does planning pay? Its time beside the line time that it saves, and its plans beside the best there are.

Saved is against two plain clients: one request an element, and runs that go on over gaps of 16. A plan that
is no better than the plain one saves nothing; then there is no ratio.

Usage: python bench/planner.py [BAUD …]
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

sys.path.insert(0, str(Path(__file__).parent.parent))

from fatektool.planner import plan_reads, plan_writes, turnaround_bytes
from fatektool.protocol.facon import FACON
from tests.planner.exhaustive import least_read, least_write, wire_bytes
from tests.planner.plain import merged, one_each
from tests.planner.sets import TURNAROUNDS, apart, named, scattered, small_set

if TYPE_CHECKING:
    from fatektool.protocol.commands import Request
    from fatektool.protocol.elements import Element

LIMIT = 0.1
TURNAROUND_S = 0.010
BITS_PER_CHARACTER = 10
RUNS = 5
SMALL_SETS = 1000


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


def gaps() -> tuple[float, float, float]:
    """The largest gap to the best plan: of reads, of writes, and of the rule of gaps of 16 in reads."""
    random = Random(2)  # noqa: S311
    reads = writes = plain = 0.0
    for _ in range(SMALL_SETS):
        elements = small_set(random)
        turnaround = random.choice(TURNAROUNDS)
        best = least_read(elements, FACON, turnaround)
        cost = wire_bytes(plan_reads(elements, FACON, turnaround=turnaround), FACON, turnaround)
        reads = max(reads, cost / best - 1)
        plain = max(plain, wire_bytes(merged(elements), FACON, turnaround) / best - 1)
        items = [(element, 0) for element in apart(elements)]
        best = least_write([element for element, _ in items], FACON, turnaround)
        cost = wire_bytes(plan_writes(items, FACON, turnaround=turnaround), FACON, turnaround)
        writes = max(writes, cost / best - 1)
    return reads, writes, plain


def main() -> None:
    """Print a row a set and baud rate, and the gaps."""
    for baud in [int(word) for word in sys.argv[1:]] or [9600, 921600]:
        print(f"{baud} baud, limit of the ratio to one each {LIMIT}")
        for name, elements in sets().items():
            print(row(name, elements, baud))
    reads, writes, plain = gaps()
    print(
        f"{SMALL_SETS} small sets: largest gap to the best plan: reads {reads:.4%}, writes {writes:.4%}; "
        f"of gaps of 16 {plain:.0%}; limit 1 %"
    )


if __name__ == "__main__":
    main()
