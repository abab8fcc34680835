"""A line for each PLC as it ends; on a terminal a table of the running ones below.

With ``--news`` only PLCs that failed, differ or have changed have a line: cron mails nothing else.
"""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any, Final

from fatektool.cli.many.fleet.words import line_of
from fatektool.cli.shared.output import print_line, shows_progress, written

if TYPE_CHECKING:
    from types import TracebackType
    from typing import Self

    from rich.text import Text

    from fatektool.cli.many.outcome import Outcome
    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.fleet.rounds import Fleet, Turn

_LONGEST_NAME: Final = 24
_REFRESH_S: Final = 0.2


class View:
    """The output while a fleet command runs, for a ``with`` statement.

    Args:
        job: what is done.
        names: of all PLCs.
        voice: prints.
        lines: False for no lines.
        news: no line for a PLC whose job is done and that is unchanged.
    """

    def __init__(self, job: str, names: list[str], voice: Voice, *, lines: bool, news: bool) -> None:
        self._job = job
        self._width = min(_LONGEST_NAME, max(map(len, names), default=0))
        self._total = len(names)
        self._ended = self._not_well = 0
        self._lines = lines and not voice.json
        self._news = news
        self._refreshed = 0.0
        self.live = shows_progress(voice)

    def __enter__(self) -> Self:
        if self.live:
            from rich.live import Live

            from fatektool.cli.shared.colour import stderr_console

            self._rich = Live(
                console=stderr_console(), auto_refresh=False, transient=True, redirect_stdout=False
            )
            self._rich.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.live:
            self._rich.stop()

    def line(self, outcome: Outcome) -> None:
        """One PLC has ended."""
        result = outcome.result
        self._ended += 1
        self._not_well += result.exit_code != 0
        if not self._lines or (self._news and result.exit_code == 0 and not result.changed):
            return
        text = line_of(self._job, f"{outcome.name:<{self._width}}", result)
        if self.live and sys.stdout.isatty():
            from rich.text import Text

            self._rich.console.print(Text.from_ansi(written(text, sys.stderr)), soft_wrap=True)
        else:
            print_line(text)
            sys.stdout.flush()

    def refresh(self, fleet: Fleet[Any]) -> None:
        """Show the running ones, a few times a second."""
        now = time.perf_counter()
        if not self.live or now - self._refreshed < _REFRESH_S:
            return
        self._refreshed = now
        self._rich.update(self._table(fleet.running(), self._rich.console.height, now), refresh=True)

    def _table(self, running: list[Turn[Any]], height: int, now: float) -> Text:
        from rich.text import Text

        space = max(1, height - 3)
        rows = [self._row(turn, now) for turn in running[:space]]
        if len(running) > space:
            rows.append(f"… {len(running) - space} more")
        not_well = f", {self._not_well} failed or differ" if self._not_well else ""
        rows.append(f"{self._job}: {self._ended} of {self._total} ended{not_well}")
        return Text("\n".join(rows), no_wrap=True, overflow="ellipsis")

    def _row(self, turn: Turn[Any], now: float) -> str:
        pages = f"  {turn.done}/{turn.total}" if turn.total else ""
        return f"{turn.task.name:<{self._width}}  {turn.phase}{pages}  {now - turn.began:.0f} s"
