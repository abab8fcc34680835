"""The figures of a bench, each with its limit: on their way to the table of ``run.py``.

A bench prints for people; beside that it notes its figures, a line of JSON each, in the file that the
environment names. Run alone, it notes nothing.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import NamedTuple

FILE = "FATEKTOOL_FIGURES"


class Figure(NamedTuple):
    """One figure.

    Attributes:
        name: what was measured.
        value: the figure.
        unit: of the figure; ``ratio`` to what could work at all.
        limit: the greatest value that is good enough; None for none.
    """

    name: str
    value: float
    unit: str = "ratio"
    limit: float | None = None

    @property
    def kept(self) -> bool:
        """False if it is over its limit."""
        return self.limit is None or self.value <= self.limit


def figure(name: str, value: float, unit: str = "ratio", limit: float | None = None) -> None:
    """Note a figure for the table."""
    place = os.environ.get(FILE)
    if place:
        with Path(place).open("a", encoding="utf-8") as file:
            file.write(json.dumps(Figure(name, value, unit, limit)) + "\n")


def noted(place: Path) -> list[Figure]:
    """The figures in a file."""
    if not place.exists():
        return []
    return [Figure(*json.loads(line)) for line in place.read_text(encoding="utf-8").splitlines()]
