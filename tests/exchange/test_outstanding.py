"""What is noted of requests without an answer: how long a late answer took."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from fatektool.exchange.outstanding import Outstanding
from fatektool.exchange.sent import Sent
from fatektool.protocol.codec import Frame
from tests.rows import each

FIRST, SECOND = 0x46, 0x47


def noted(first_at: float, second_at: float) -> float:
    """The time of a late answer by these notes.

    Two requests are sent, at 0 and 0.5 seconds, each with 0.5 seconds for its answer. The first is not waited
    for. Their answers come at these times.
    """
    now = 0.0
    state: Any = SimpleNamespace(
        late_s=0.0, wait_s=0.5, byte_time_s=0.0, transport=SimpleNamespace(clock=lambda: now)
    )
    outstanding = Outstanding(state)
    for code, at in ((FIRST, 0.0), (SECOND, 0.5)):
        outstanding.note_sent(Sent(b"", 1, code, 0, 0, None), at)
        outstanding.keep_last(waited_for=code == SECOND)
    for code, at in ((FIRST, first_at), (SECOND, second_at)):
        now = at
        assert outstanding.take_late(Frame(1, code, b"", b""))
    assert outstanding.since is None
    found: float = state.late_s
    return found


@each(
    ("first_at", "second_at", "late_s"),
    [
        (0.25, 1.25, 0.75),  # from when it was sent
        (1.0, 1.75, 0.75),  # from the answer before it, for which the PLC was busy
        (1.0, 1.5, 1.0),  # no more than what was given for it: something else took the time
        (1.0, 1.25, 0.75),
    ],
)
def test_how_long_a_late_answer_took(first_at: float, second_at: float, late_s: float) -> None:
    assert noted(first_at, second_at) == late_s
