"""A program of a thousand networks: how long are reading it, comparing two of them, and a key of a project?

Three comparisons: one contact negated and one network put in; every tenth network changed; nothing in common.
Exit code 1 if a comparison, reading included, takes a second or more.

Usage: python bench/ladder.py
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

sys.path.insert(0, str(Path(__file__).parent.parent))

from figures import figure

from fatektool.ladder.differences import compare_code
from fatektool.ladder.networks import Code
from fatektool.project.file import Project
from tests.project.images import FBS, image_of, much_code
from tests.project.pdw import project

if TYPE_CHECKING:
    from collections.abc import Callable

LIMIT_S = 1.0
RUNS = 5
WORDS = 5000
FULL = 0x4EFF
CONTACT = 0x10
"""The bit that makes a contact a NOT contact."""


def best(work: Callable[[], object]) -> float:
    """The best of several runs, in seconds."""
    times = []
    for _ in range(RUNS):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return min(times)


def changed(words: list[int], networks: list[int]) -> list[int]:
    """The program with the first contact of these networks negated, and a network put in the middle."""
    found = list(words)
    starts = [network.word for network in Code.of(words).networks]
    for number in networks:
        found[starts[number]] ^= CONTACT
    middle = starts[len(starts) // 2]
    return [*found[:middle], 0x0740, 0x07C1, *found[middle:]]


def main() -> int:
    """Measure; exit 1 past the limit."""
    words = much_code(WORDS)
    count = len(Code.of(words).networks)
    others = {
        "one changed, one put in": changed(words, [count // 3]),
        "every tenth changed": changed(words, list(range(0, count, 10))),
        "nothing in common": much_code(WORDS, seed=2),
    }
    slow = False
    print(f"read              {count} networks, {WORDS} words  {best(lambda: Code.of(words).networks):.3f} s")
    for name, other in others.items():
        taken = best(lambda other=other: compare_code(Code.of(words), Code.of(other)))  # type: ignore[misc]
        found = len(compare_code(Code.of(words), Code.of(other)))
        slow |= taken >= LIMIT_S
        figure(f"read and compare, {name}", taken, "s", LIMIT_S)
        print(f"read and compare  {name:<24} {found:>5} differ  {taken:.3f} s  limit {LIMIT_S:.0f}")
    image = image_of(much_code(FULL))
    data = project(image, FBS)
    print(f"project           {FULL} words, full          {best(lambda: Project.parse(data)):.3f} s")
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
