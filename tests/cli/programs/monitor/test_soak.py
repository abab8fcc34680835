"""An hour of rounds over a bad line, on the line's clock: what is drawn as fresh is never wrong.

The machine changes between two rounds and not within one, so that an answer to an earlier round, half of one
or another station's shows as a wrong state. Now and then the PLC is away for a while. Faults that a checksum
of 8 bits may let through (several wrong bits in one answer) are left out: ``docs/reliability.md`` has them.
"""

from __future__ import annotations

import gc
import re
import tracemalloc
from random import Random
from typing import TYPE_CHECKING

import pytest

from fatektool.cli.programs.monitor.frame import Frames
from fatektool.cli.programs.monitor.screen import news_of
from fatektool.cli.programs.monitor.view import View
from fatektool.cli.shared.reading import Reading
from fatektool.cli.shared.rounds import RoundTimes
from fatektool.ladder.drawing.text.letters import Letters
from fatektool.ladder.drawing.text.live import LivePen
from tests.cli.programs.monitor.test_view import COMMENTS
from tests.jobs.monitor.bench import Monitored
from tests.night import night

if TYPE_CHECKING:
    from fatektool.cli.programs.monitor.frame import News

FAULTS = (
    *("drop=0.01", "flip=0.08", "truncate=0.01", "noise=0.01", "duplicate=0.01", "late=0.01", "slow=0.005"),
    "wrong-station=0.01",
)
INTERVAL_S = 0.25
AWAY_EACH_S = 45.0
AWAY_FROM_S, AWAY_TO_S = 20.0, 28.0
STATE = re.compile(r"\b(RT30|T30|T\d+|X\d+|Y\d+|M\d+|S\d+)=(-?\d+|\?)")
MORE_BYTES = 64 * 1024


class Machine:
    """Draws every screen of a monitor, and holds what is on it against what the PLC has."""

    def __init__(self, seconds: float, seed: int) -> None:
        self.bench = Monitored(faults=FAULTS, seed=seed, baud=9600, scan_ms=5, slow_s=0.8)
        self.random = Random(seed)  # noqa: S311
        self.seconds = seconds
        self.view = View(self.bench.file.require_code(), self.bench.networks)
        self.frames = Frames("press.json", "station 1 on sim:", COMMENTS, LivePen(Letters("utf-8")))
        self.reading = Reading(
            self.bench.plc,
            self.bench.monitor.read,
            RoundTimes(INTERVAL_S),
            self.draw,
            clock=self.bench.transport.clock,
            wait=self.wait,
        )
        self.fresh = self.states = self.was_away = self.is_back = 0
        self.wrong: list[str] = []
        self.away = self.bench.simulation.plcs
        self.here = dict(self.away)
        self.memory: list[int] = []

    @property
    def now(self) -> float:
        return self.bench.transport.clock()

    def run(self) -> None:
        self.bench.monitor.networks = self.view.visible
        self.change()
        self.reading.run()

    def wait(self, seconds: float) -> bool:
        """Let time go by: the machine changes, keys are pressed, the PLC comes and goes."""
        self.bench.transport._now += seconds
        self.change()
        if self.random.random() < 0.05:
            self.view.press(self.random.choice(["up", "down", "pgup", "pgdn", "home", "end"]))
        is_away = AWAY_FROM_S < self.now % AWAY_EACH_S < AWAY_TO_S
        self.away.clear()
        self.away.update({} if is_away else self.here)
        if self.now > self.seconds:
            self.reading.stop()
            return True
        return False

    def change(self) -> None:
        self.bench.wire.bodies()
        plc = self.here[1]
        for symbol, count in (("X", 8), ("Y", 8), ("M", 500), ("S", 8), ("T", 256)):
            plc.memory.status[symbol][:count] = [self.random.randrange(2) for _ in range(count)]
        for number in (6, 8, 100):
            plc.memory.registers["R"][number] = self.random.randrange(1 << 16)
        plc.running = self.random.random() < 0.9

    def draw(self) -> None:
        """What is drawn after a round, or a round that failed."""
        if self.reading.is_over:
            return
        news = news_of(self.reading, self.bench.monitor.program)
        rows = self.frames.frame(self.view, news, 100, 40)
        self.bench.monitor.networks = self.view.visible
        text = "\n".join("".join(piece.text for piece in row) for row in rows)
        found = STATE.findall(text)
        if news.round is None:
            assert "LINE LOST since" in text
            assert {state for _, state in found} <= {"?"}
            self.was_away = self.is_back + (not self.away)
        else:
            assert "LINE LOST" not in text
            self.fresh += 1
            self.is_back = self.was_away
            self.hold(news, text, found)
        if self.now > self.seconds * (len(self.memory) + 1) / 4:
            gc.collect()
            self.memory.append(tracemalloc.get_traced_memory()[0])

    def hold(self, news: News, text: str, found: list[tuple[str, str]]) -> None:
        assert news.round is not None
        memory = self.here[1].memory
        if ("RUN" if self.here[1].running else "STOP") not in text.splitlines()[0]:
            self.wrong.append(text.splitlines()[0])
        for name, state in found:
            symbol, number = name[0], int(name.lstrip("RXYMSTC"))
            if state == "?" or (symbol == "T" and not state.isdigit()):
                continue
            if symbol == "T" and number == 30:
                continue  # its value and its contact have one name
            self.states += 1
            if memory.status[symbol][number] != int(state):
                self.wrong.append(f"{self.now:.2f} {name}={state}")


@pytest.mark.timeout(1800)
@pytest.mark.parametrize("seconds", [45.0, night(3600.0)])
def test_what_is_drawn_as_fresh_is_what_the_plc_has(seconds: float) -> None:
    """Rounds go on behind every absence of the PLC; at night also: no memory is taken that stays."""
    machine = Machine(seconds, seed=1)
    if seconds > AWAY_EACH_S:
        tracemalloc.start()
    try:
        machine.run()
    finally:
        tracemalloc.stop()
    assert machine.reading.error is None
    assert machine.wrong == []
    assert machine.fresh > seconds / 2
    assert machine.states > 5 * machine.fresh
    assert machine.is_back == machine.was_away == seconds // AWAY_EACH_S
    first, *_, last = machine.memory
    assert last < first + MORE_BYTES, machine.memory
