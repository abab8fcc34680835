"""What a person reads of a restore that did not complete, at the width of a terminal."""

from __future__ import annotations

from fatektool.cli.shared.incomplete import restore_lines
from fatektool.errors import RestoreIncomplete


def told(**pages: list[int]) -> list[str]:
    """The lines of facts: name and value, between the headline and the way on."""
    states = ("pages_written", "pages_unread", "pages_uncertain", "pages_old")
    details: dict[str, list[int]] = {state: [] for state in states}
    error = RestoreIncomplete("x", cause="the line is cut", safety_backup="s.json")
    error.details |= details | pages
    return restore_lines(error, "station 1 on tcp://plc", "fatektool restore x.json")[1:-2]


def test_pages_in_a_row_are_the_name() -> None:
    assert told(pages_written=[0, 1, 2], pages_uncertain=[3], pages_old=[4, 5]) == [
        "  PLC          station 1 on tcp://plc, in STOP; it must not RUN",
        "  cause        the line is cut",
        "  page 0-2     the new program",
        "  page 3       uncertain",
        "  page 4-5     the old program",
        "  old program  s.json",
    ]


def test_scattered_pages_push_no_other_fact_aside() -> None:
    """A column as wide as the longest list of pages broke each line at 80 columns."""
    odd, even = list(range(1, 200, 2)), list(range(0, 200, 2))
    lines = told(pages_written=even, pages_old=odd)
    assert lines[0] == "  PLC              station 1 on tcp://plc, in STOP; it must not RUN"
    assert lines[2].startswith("  the new program  page 0, 2, 4, ")
    assert lines[3].startswith("  the old program  page 1, 3, 5, ")
    assert lines[4] == "  old program      s.json"
