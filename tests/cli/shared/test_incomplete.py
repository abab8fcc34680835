"""What a person reads of a write that ended half way, at the width of a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.cli.shared.incomplete import incomplete_lines
from fatektool.errors import RestoreIncomplete

if TYPE_CHECKING:
    from collections.abc import Sequence


def told(states: Sequence[tuple[str, str]], mode: str = "", saved: str | None = "s.json") -> list[str]:
    error = RestoreIncomplete("x", cause="the line is\ncut")
    error.headline, error.mode, error.states, error.saved = "it did not complete", mode, states, saved
    return incomplete_lines(error, "station 1 on tcp://plc", "program", "fatektool restore x.json")


def test_pages_in_a_row_are_the_name() -> None:
    states = [
        ("page 0-2", "the new program"),
        ("page 3", "uncertain"),
        ("page 4-5", "the previous program"),
    ]
    assert told(states, "STOP: do not switch it to RUN") == [
        "it did not complete",
        "  PLC               station 1 on tcp://plc",
        "  mode              STOP: do not switch it to RUN",
        "  cause             the line is cut",
        "  page 0-2          the new program",
        "  page 3            uncertain",
        "  page 4-5          the previous program",
        "  previous program  saved in s.json",
        "fix the cause, then run:",
        "fatektool restore x.json",
    ]


def test_scattered_pages_push_no_other_fact_aside() -> None:
    """A column as wide as the longest list of pages broke each line at 80 columns."""
    odd, even = (", ".join(map(str, range(start, 200, 2))) for start in (1, 0))
    lines = told([(f"page {even}", "the new program"), (f"page {odd}", "the previous program")], saved=None)
    assert lines[1] == "  PLC                   station 1 on tcp://plc"
    assert lines[3].startswith("  the new program       page 0, 2, 4, ")
    assert lines[4].startswith("  the previous program  page 1, 3, 5, ")
    assert lines[5] == "  previous program      not saved"
