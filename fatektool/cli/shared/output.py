"""Where words go: data to stdout, everything else to stderr, a progress bar only on a terminal."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TextIO

import click

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sized
    from types import TracebackType
    from typing import Self, TextIO

    from rich.progress import TaskID

    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress


_FEW: Final = 200
"""So many elements take no more than a second or two."""

_CONTROLS: Final = (*range(0x09), *range(0x0B, 0x20), *range(0x7F, 0xA0))
_DIRECTIONS: Final = (0x61C, 0x200E, 0x200F, *range(0x202A, 0x202F), *range(0x2066, 0x206A))
_OBEYED: Final = {code: ascii(chr(code))[1:-1] for code in (*_CONTROLS, *_DIRECTIONS)}
"""What a terminal obeys, each with its code: control characters but for tab and new line, and those of
direction."""


def visible(text: str) -> str:
    """Text from a file, a PLC or a name: what a terminal would obey is shown as a code."""
    return text.translate(_OBEYED)


def written(text: str, stream: TextIO) -> str:
    """A text as it is written to a stream, in colour where it has some."""
    if type(text) is str:
        return visible(text)
    from fatektool.cli.shared.colour import rendered

    return rendered(text, stream, visible)


def print_line(text: str) -> None:
    """Print a line of data on stdout."""
    click.echo(written(text, sys.stdout), color=True)


def with_prefix(prefix: str, text: str, *, bad: bool = False) -> str:
    """A message for stderr that begins with a word in colour: an error (``bad``) or a warning."""
    from fatektool.cli.shared.colour import Style, coloured, joined

    return joined(coloured(prefix, Style.BAD if bad else Style.NOTICE), f" {text}")


def passed(plc: Plc, seconds: float) -> str:
    """How long a job took, in words; nobody waited for a line that is simulated in this process."""
    from fatektool.counts import spent

    return f"{spent(seconds)} of simulated time" if plc.target.startswith("sim:") else spent(seconds)


def shown_time(created: str, stream: TextIO | None = None) -> str:
    """A time in UTC as it is printed: that of this computer's clock on a terminal, as it is elsewhere.

    Args:
        created: RFC 3339.
        stream: where it is printed; None for stdout.
    """
    if not (sys.stdout if stream is None else stream).isatty():
        return created
    from fatektool.files.times import local

    return local(created)


class Held:
    """Lines for stderr while a screen is drawn, which they would break: shown on it, and printed after it.

    Where stderr goes elsewhere, they go there at once.

    Attributes:
        on_news: is called for each line; from any thread.
    """

    def __init__(self) -> None:
        self.on_news: Callable[[], object] = lambda: None
        self._lines: dict[str, None] = {}
        self._new = self._shown = ""
        self._since: object = None
        self._until = 0.0

    def __enter__(self) -> Self:
        _HELD.append(self)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        _HELD.remove(self)
        for line in self._lines:
            print_stderr(line)

    def take(self, text: str) -> None:
        """Keep a line, each once, the first few."""
        self._new = text
        if len(self._lines) < _MOST_HELD:
            self._lines[text] = None
        self.on_news()

    def over(self, message: str, now: object) -> str:
        """What the screen says: the newest line, until it was read and a later round came.

        Args:
            message: what it says otherwise.
            now: the last round.
        """
        if self._new:
            self._shown, self._since, self._new = self._new, now, ""
            self._until = time.perf_counter() + _READ_S
        if self._shown and (now is self._since or time.perf_counter() < self._until):
            return self._shown
        shown, self._shown = self._shown, ""
        return "" if message == shown else message


_HELD: Final[list[Held]] = []
_MOST_HELD: Final = 100
_READ_S: Final = 3.0


def print_stderr(text: str) -> None:
    """Print a line on stderr."""
    if _HELD and sys.stderr.isatty():
        _HELD[-1].take(text)
        return
    click.echo(written(text, sys.stderr), err=True, color=True)


def print_json(document: dict[str, Any]) -> None:
    """Print one document on stdout."""
    from fatektool.files.indented_json import indented_json

    click.echo(indented_json(document, 2))


class Voice(NamedTuple):
    """Where and how a command prints.

    Attributes:
        json: one JSON document on stdout instead of words.
        quiet: nothing on stderr but errors.
        verbose: more on stderr.
        name: printed before each message about one of many PLCs.
    """

    json: bool = False
    quiet: bool = False
    verbose: bool = False
    name: str = ""

    def say(self, text: str) -> None:
        """Print a message on stderr."""
        if not self.quiet:
            print_stderr(self.name + text)

    def detail(self, text: str) -> None:
        """Print a detail on stderr, with ``-v``."""
        if self.verbose:
            print_stderr(self.name + text)

    def warn(self, text: str) -> None:
        """Warn the user, on stderr, quiet or not."""
        print_stderr(with_prefix("warning:", f"{self.name}{text}"))

    def of(self, name: str) -> Voice:
        """The same voice where many PLCs are talked of: this one's name comes first."""
        return self._replace(name=f"{name}: ")

    def show(self, document: dict[str, Any], lines: Iterable[str]) -> None:
        """Print the document or the lines, on stdout."""
        if self.json:
            print_json(document)
        else:
            for line in lines:
                print_line(line)

    def progress(self, unit: str = "pages") -> ProgressBar:
        """A progress bar for a ``with`` statement; nothing where it would be noise."""
        return ProgressBar(unit, shown=shows_progress(self))


def elements_bar(voice: Voice, items: Sized, *, whole: bool = False) -> ProgressBar:
    """A progress bar for reading elements, if there are so many of them that it takes a while."""
    return ProgressBar("elements", shown=shows_progress(voice) and (whole or len(items) > _FEW))


def shows_progress(voice: Voice) -> bool:
    """True on a terminal, unless ``-q`` is given."""
    return not voice.quiet and sys.stderr.isatty()


def table(rows: Iterable[tuple[str, object]]) -> Iterator[str]:
    """Rows of name and value, aligned."""
    rows = list(rows)
    width = max((len(name) for name, _ in rows), default=0)
    for name, value in rows:
        start = f"{name:<{width}}  "
        if isinstance(value, str) and type(value) is not str:
            from fatektool.cli.shared.colour import joined

            yield joined(start, value)
        else:
            yield f"{start}{value}".rstrip()


class ProgressBar:
    """What is done, rate and time left, on a terminal; ``update`` is a job's progress callback.

    Args:
        unit: what is counted.
        shown: False for nothing at all.
    """

    def __init__(self, unit: str, *, shown: bool) -> None:
        from fatektool.callbacks import ignore

        self._unit = unit
        self._shown = shown
        self._tasks: dict[str, TaskID] = {}
        self.update: Progress = ignore

    def __enter__(self) -> Self:
        self._begin()
        return self

    def _begin(self) -> None:
        """Draw a bar of its own below what is on the screen."""
        if self._shown:
            from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

            from fatektool.cli.shared.colour import stderr_console

            self._rich = Progress(
                TextColumn("{task.description}"),
                BarColumn(bar_width=None),
                MofNCompleteColumn(),
                TextColumn(f"{self._unit} {{task.fields[rate]}}"),
                TimeRemainingColumn(elapsed_when_finished=True),
                console=stderr_console(),
                expand=True,
                refresh_per_second=5,
                redirect_stdout=False,  # data may go to a file while the bar is on the terminal
            )
            self._rich.start()
            self._tasks.clear()
            self.update = self._update

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._shown:
            self._rich.stop()

    def print(self, text: str) -> None:
        """Print a line of data on stdout, above the bar if both are on one terminal."""
        if self._shown and sys.stdout.isatty():
            from rich.text import Text

            self._rich.console.print(Text.from_ansi(written(text, sys.stderr)), soft_wrap=True)
        else:
            print_line(text)
            sys.stdout.flush()

    def pause(self) -> None:
        """Take the bar off the screen, for a question."""
        if self._shown:
            self._rich.stop()

    def go_on(self) -> None:
        """Draw a bar again, below the question: one that was started twice would erase the line above it."""
        self._begin()

    def _update(self, phase: str, done: int, total: int) -> None:
        task = self._tasks.get(phase)
        if task is None:
            task = self._tasks[phase] = self._rich.add_task(phase, total=total, rate="")
        speed = self._rich.tasks[list(self._tasks).index(phase)].speed
        self._rich.update(task, completed=done, total=total, rate=f"{speed:.1f}/s" if speed else "")
