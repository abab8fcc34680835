"""Elements in a message: neighbours as a range, each range in the order of its first."""

from __future__ import annotations

from fatektool.jobs.elements.spans import spans_of
from fatektool.protocol.elements import Element
from tests.rows import each


@each(
    ("names", "spans"),
    [
        ("", ""),
        ("R5", "R5"),
        ("R5 R6", "R5-R6"),
        ("R6 R5 R7", "R5-R7"),
        ("R5 R7", "R5 R7"),
        ("R1 R2 R5 R6 R7 R9", "R1-R2 R5-R7 R9"),
        ("M2 R1 M1 R2", "M1-M2 R1-R2"),
        ("DR0 DR2 DR4", "DR0-DR4"),  # one has two registers
        ("DR0 DR1", "DR0 DR1"),
        ("R0 D1", "D1 R0"),
    ],
)
def test_spans(names: str, spans: str) -> None:
    assert spans_of(map(Element.parse, names.split())) == spans.split()
