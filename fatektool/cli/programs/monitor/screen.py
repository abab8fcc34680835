"""``monitor`` on a terminal: the networks drawn, with what the PLC has now; keys move between them."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from fatektool.cli.programs.monitor.frame import Frames, News
from fatektool.cli.programs.monitor.view import View
from fatektool.cli.programs.monitor.why import say_of_program
from fatektool.cli.programs.monitor.words import program_words
from fatektool.cli.shared.keys import terminal_keys
from fatektool.cli.shared.output import Held
from fatektool.cli.shared.reading import Reading, lost_words
from fatektool.jobs.monitor.live import Monitor
from fatektool.ladder.drawing.text.letters import Letters
from fatektool.ladder.drawing.text.live import LivePen

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rich.text import Text

    from fatektool.cli.shared.keys import Keys
    from fatektool.cli.shared.output import Voice
    from fatektool.cli.shared.rounds import RoundTimes
    from fatektool.client import Plc
    from fatektool.jobs.monitor.live import LiveNetwork
    from fatektool.jobs.monitor.rounds import Round
    from fatektool.jobs.monitor.same_program import SameProgram
    from fatektool.ladder.drawing.text.live import Row
    from fatektool.project.comments import Comments
    from fatektool.project.program_file import ProgramFile


class Screen:
    """The screen, the keys, and the rounds.

    Args:
        plc: the PLC.
        file: the program on file.
        networks: those that may be shown.
        comments: the program's.
        pace: how often a round is read, and how many.
    """

    def __init__(
        self,
        plc: Plc,
        file: ProgramFile,
        networks: Sequence[LiveNetwork],
        comments: Comments,
        pace: RoundTimes,
    ) -> None:
        from rich.console import Console

        self._console = Console()
        self._plc, self._pace = plc, pace
        self._view = View(file.require_code(), networks)
        place = f"station {plc.link.station} on {plc.target}"
        self._frames = Frames(file.name, place, comments, LivePen(Letters(sys.stdout.encoding)))
        self._monitor = Monitor(plc, file, networks[:1])
        self._reading: Reading[Round] | None = None

    def run(self) -> None:
        """Show it all until ``q``, Ctrl-C or the last round.

        Raises:
            LineError: the first round found no answer.
        """
        if self._console.is_dumb_terminal:
            self._run_without_cursor()
            return
        from rich.live import Live

        with Held() as held, Live(console=self._console, screen=True, auto_refresh=False) as live:

            def down() -> Callable[[], object]:
                live.stop()
                return lambda: live.start(refresh=True)

            def show() -> None:
                size = self._console.size
                rows = self._frames.frame(self._view, self._news(), size.width, size.height)
                self._monitor.networks = self._view.visible
                live.update(_text(rows), refresh=True)

            show()  # which networks fit is known before the first round
            with terminal_keys(down) as keys, self._rounds(keys) as reading:
                held.on_news = keys.wake
                while not (self._view.is_over or reading.is_over):
                    for key in keys.read():
                        self._view.press(key)
                    self._view.message = held.over(self._view.message, reading.last)
                    show()
                if reading.error is not None:
                    raise reading.error

    def say_of_program(self, voice: Voice) -> None:
        """What the screen said of the PLC's program, once the screen is gone."""
        if self._reading is not None and self._reading.last is not None:
            say_of_program(self._monitor.program, voice)

    def _run_without_cursor(self) -> None:
        """On a terminal whose cursor cannot be moved: what has changed, one below the other."""
        self._monitor.networks = self._view.networks
        before: list[Row] = []
        with terminal_keys(lambda: lambda: None) as keys, self._rounds(keys) as reading:
            while not (self._view.is_over or reading.is_over):
                for key in keys.read():
                    self._view.press(key)
                news = self._news()
                rows = [*self._frames.rows(self._view.networks, news, self._console.size.width)]
                if rows != before and (news.round is not None or news.lost):
                    head = news.lost or ("" if news.round is None else news.round.time)
                    self._console.print(head, markup=False, highlight=False)
                    self._console.print(_text(rows))
                    before = rows
            if reading.error is not None:
                raise reading.error

    def _rounds(self, keys: Keys) -> Reading[Round]:
        self._reading = Reading(self._plc, self._monitor.read, self._pace, keys.wake)
        return self._reading

    def _news(self) -> News:
        return News(None) if self._reading is None else news_of(self._reading, self._monitor.program)


def news_of(reading: Reading[Round], program: SameProgram) -> News:
    """What the screen shows; of a line that is lost no states."""
    words = "" if program.is_certain or reading.last is None else program_words(program)
    lost = lost_words(reading)
    if lost:
        return News(None, lost=lost, program=words)
    return News(reading.last, reading.rate, program=words)


def _text(rows: Sequence[Row]) -> Text:
    """Rows for rich: what carries, conducts or is on stands out where the terminal can show it."""
    from rich.text import Text

    text = Text(no_wrap=True, overflow="crop")
    for number, row in enumerate(rows):
        if number:
            text.append("\n")
        for piece in row:
            text.append(piece.text, "bold green" if piece.is_lit else "")
    return text
