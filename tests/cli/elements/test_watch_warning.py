"""``watch`` on a terminal while a warning comes: the table stays whole, and the warning is not lost."""

from __future__ import annotations

import io
import os
import sys
from typing import TYPE_CHECKING

import pyte

from fatektool.cli import run
from fatektool.simulator.line import SimulatedLine
from tests.cli.running import served
from tests.platforms import posix

if TYPE_CHECKING:
    from collections.abc import Callable

    import pytest
    from _typeshed import ReadableBuffer

pytestmark = posix("keys of a POSIX terminal")

COLUMNS, LINES = 60, 16
WARNING = "warning: answers are late"
HEADER = "element   value trend"
KEYS = "q end"


class Screen(io.RawIOBase):
    """The screen of a terminal.

    Args:
        look: gets its lines, each time that something was drawn.
    """

    def __init__(self, look: Callable[[list[str]], object]) -> None:
        self._look = look
        self._screen = pyte.Screen(COLUMNS, LINES)
        self._screen.set_mode(pyte.modes.LNM)
        self._stream = pyte.ByteStream(self._screen)

    def isatty(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def write(self, data: ReadableBuffer) -> int:
        self._stream.feed(bytes(data))
        self._look(self.lines)
        return len(bytes(data))

    @property
    def lines(self) -> list[str]:
        return [line.rstrip() for line in self._screen.display if line.strip()]


class LateOnce:
    """A PLC that gives one answer together with the next, when the client no longer waits for it."""

    def __init__(self) -> None:
        self._receive = SimulatedLine.receive
        self._kept: list[tuple[float, bytes]] = []
        self.is_due = False

    def receive(self) -> Callable[[SimulatedLine, bytes, float], list[tuple[float, bytes]]]:
        """For ``SimulatedLine.receive``."""

        def received(line: SimulatedLine, data: bytes, now: float) -> list[tuple[float, bytes]]:
            pieces = self._receive(line, data, now)
            if self.is_due:
                self.is_due, self._kept = False, pieces
                return []
            late, self._kept = self._kept, []
            return [(now, piece) for _, piece in late] + pieces

        return received


def test_a_warning_is_shown_below_the_table_and_printed_behind_it(monkeypatch: pytest.MonkeyPatch) -> None:
    plc = LateOnce()
    drawn: list[list[str]] = []
    keys, stdin = os.openpty()

    def look(lines: list[str]) -> None:
        if HEADER not in lines:
            return
        if not drawn:
            plc.is_due = True
        if any(line.startswith(WARNING) for line in lines):
            os.write(keys, b"q")
        drawn.append(lines)

    screen = Screen(look)
    monkeypatch.setenv("COLUMNS", str(COLUMNS))
    monkeypatch.setenv("LINES", str(LINES))
    monkeypatch.setattr(SimulatedLine, "receive", plc.receive())
    with served() as door, os.fdopen(stdin) as terminal:
        both = io.TextIOWrapper(io.BufferedWriter(screen), "utf-8")
        for name, stream in (("stdin", terminal), ("stdout", both), ("stderr", both)):
            monkeypatch.setattr(sys, name, stream)
        code = run(["watch", "R0", "R1", "--interval", "0", "-p", door.target])
    os.close(keys)
    assert code == 0
    feet = []
    for title, header, first, second, *foot in drawn:  # each is whole, and in the place of the one before
        assert title.endswith(f"STOP  station 1 on {door.target}")
        assert (header, first[:3], second[:3]) == (HEADER, "R0 ", "R1 ")
        feet.append("".join(foot))
    shown = [number for number, foot in enumerate(feet) if foot.startswith(WARNING)]
    assert all(foot.startswith(KEYS) for foot in feet[: shown[0]])
    assert feet[-1].startswith("warning: answers are late: after ")  # behind the table, which has no foot now
    assert "use --timeout" in feet[-1]
