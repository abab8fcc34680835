"""How much is tried of what could go on for ever: a share of it in each run, all of it at night.

At night is ``pytest -m slow``, which looks for new cases; see ``conftest``. In Wine, where the system
is new and not the code, few are enough.
"""

from __future__ import annotations

import os
from collections import defaultdict
from typing import TYPE_CHECKING, Any

import pytest

from tests.root import ROOT

if TYPE_CHECKING:
    from collections.abc import Sequence

AT_NIGHT = "FATEKTOOL_TESTS_AT_NIGHT"
"""Set in the environment before a test is imported, where all of it is to be tried."""
FEW = "FATEKTOOL_TESTS_FEW"
"""Set in the environment where the code is not new, but the system under it."""
_SHARE = 4
_LEAST = 10
_FEW = 3
_FOLDERS_OF_FEW = [
    ROOT / "tests" / name
    for name in ("protocol", "planner", "program", "jobs", "exchange", "simulator/slaves")
]
"""The tests in them use nothing of the system, or nothing that differs between the rows of one test."""


def examples(most: int) -> int:
    """How many cases of a property are drawn: a quarter of them, but ten at least; all at night."""
    if os.environ.get(FEW):
        return min(_FEW, most)
    return most if os.environ.get(AT_NIGHT) else max(min(_LEAST, most), most // _SHARE)


def night(*values: Any, name: str | None = None) -> Any:
    """A row that is for the night."""
    return pytest.param(*values, marks=pytest.mark.slow, id=name)


def seeds(by_day: int, at_night: int) -> list[Any]:
    """Seeds from 0: the first few for each run, the rest for the night."""
    if os.environ.get(FEW):
        by_day = min(1, by_day)
    return [*range(by_day), *(night(seed) for seed in range(by_day, at_night))]


def left_out(items: Sequence[pytest.Item]) -> list[pytest.Item]:
    """The rows that are not run where few are enough: all but the first, the middle and the last."""
    rows: dict[str, list[pytest.Item]] = defaultdict(list)
    for item in items:
        if any(item.path.is_relative_to(folder) for folder in _FOLDERS_OF_FEW):
            rows[item.nodeid.partition("[")[0]].append(item)
    kept = {id(row) for found in rows.values() for row in (found[0], found[len(found) // 2], found[-1])}
    return [row for found in rows.values() for row in found if id(row) not in kept]
