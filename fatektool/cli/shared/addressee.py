"""The PLC that a write goes to, as every question before it and every result after it name it.

::

    PLC    station 1 on /dev/ttyUSB0
    model  MC, 28 points, OS 3.1
    mode   STOP
    file   press.json
    from   station 1 on /dev/ttyUSB0, 2026-11-22T03:15:00Z
    time   about 4 min

A target may come from the environment, and be another machine's: so what is written, and into which PLC, is
shown before it is agreed to.
"""

from __future__ import annotations

import sys
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fatektool.cli.shared.colour import word
from fatektool.cli.shared.output import passed, shown_time, table
from fatektool.cli.shared.questions import confirm, require_answer
from fatektool.cli.shared.unfinished import line_name
from fatektool.counts import spent
from fatektool.errors import LineError, UsageError
from fatektool.jobs.status import brief_or_none

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc
    from fatektool.protocol.status import BriefStatus


@dataclass(frozen=True, slots=True)
class Addressee:
    """The PLC that is written to.

    Attributes:
        target: as the user named it.
        station: 1 to 254.
        model: in words; None if not known.
        running: None if not known.
    """

    target: str
    station: int
    model: str | None = None
    running: bool | None = None

    @property
    def name(self) -> str:
        """Station and target."""
        return f"station {self.station} on {self.target}"

    @property
    def mode(self) -> str | None:
        """``RUN`` or ``STOP``; None if not known."""
        return None if self.running is None else "RUN" if self.running else "STOP"

    @property
    def line(self) -> str:
        """All of it on one line, for a result: ``station 1 on /dev/ttyUSB0 (FBE, 13K steps, STOP)``."""
        known = ", ".join(text for text in (self.model, self.mode) if text is not None)
        return f"{self.name} ({known})" if known else self.name

    def rows(self) -> Iterator[tuple[str, object]]:
        """What is known of it."""
        yield "PLC", self.name
        if self.model is not None:
            yield "model", self.model
        if self.mode is not None:
            yield "mode", word(self.mode)

    def document(self) -> dict[str, Any]:
        """The same for JSON, beside target and station."""
        return {"model": self.model, "mode": None if self.mode is None else self.mode.lower()}


@dataclass(frozen=True, slots=True)
class Origin:
    """Where the data in a file came from.

    Attributes:
        target: as the user named it then.
        station: 1 to 254.
        time: when, UTC.
    """

    target: str
    station: int
    time: str

    def warn_unless_from(self, addressee: Addressee, file: object, voice: Voice) -> None:
        """Say that a file came from another PLC than the one that is written to."""
        if self.station != addressee.station or not _same_line(self.target, addressee.target):
            voice.warn(f"{file} is from station {self.station} on {self.target}, not from this PLC")

    def __str__(self) -> str:
        return f"station {self.station} on {self.target}, {shown_time(self.time, sys.stderr)}"

    def document(self) -> dict[str, Any]:
        """The origin as JSON has it."""
        return {"target": self.target, "station": self.station, "time": self.time}


def _same_line(one: str, other: str) -> bool:
    try:
        return line_name(one) == line_name(other)
    except UsageError:  # a file's may be anything
        return one == other


class ExchangeTime:
    """How long an exchange takes on this line, measured while a plan is made."""

    def __init__(self, plc: Plc) -> None:
        self._plc, self._link = plc, plc.link
        self._began = self._link.transport.clock()
        self._before = self._link.counters.exchanges

    @property
    def passed_s(self) -> float:
        """Seconds since it began."""
        return self._link.transport.clock() - self._began

    @contextmanager
    def stopped(self) -> Iterator[None]:
        """Do not count what happens within, as a question waits for a person."""
        began = self._link.transport.clock()
        try:
            yield
        finally:
            self._began += self._link.transport.clock() - began

    @property
    def passed(self) -> str:
        """The same in words."""
        return passed(self._plc, self.passed_s)

    def time_of(self, exchanges: int) -> str:
        """How long this number of further exchanges will take, in words."""
        done = self._link.counters.exchanges - self._before
        seconds = self.passed_s / max(1, done) * exchanges
        return spent(seconds) if seconds < 1 else f"about {spent(seconds)}"


def look(plc: Plc) -> Addressee:
    """Read model and mode of a PLC (40), if its protocol has that; what is not known is None."""
    try:
        return with_status(plc, brief_or_none(plc))
    except LineError:
        return with_status(plc, None)


def with_status(plc: Plc, brief: BriefStatus | None) -> Addressee:
    """The PLC with its answer to 40; None for no answer."""
    if brief is None:
        return Addressee(plc.target, plc.link.station)
    model = brief.model
    if model is None and not brief.m_series:
        model = f"code {brief.status2:02X}"
    return Addressee(plc.target, plc.link.station, model, brief.flags.running)


def agree(
    voice: Voice,
    rows: Iterable[tuple[str, object]],
    lines: Iterable[str],
    question: str,
    *,
    yes: bool,
    unchanged: str = "nothing was written",
) -> None:
    """Show what will be written, and into which PLC; ask.

    Args:
        voice: shows and asks.
        rows: the PLC's, and more of that kind.
        lines: what will be done.
        question: names the PLC too.
        yes: do not ask.
        unchanged: what is said if the answer is no.

    Raises:
        UsageError: the user does not agree, or there is no terminal to ask on.
        KeyboardInterrupt: Ctrl-C at the question; has ``unchanged``.
    """
    require_answer(yes=yes)
    for line in (*table(rows), *lines):
        voice.say(line)
    try:
        agreed = confirm(question, yes=yes)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(unchanged) from None
    if not agreed:
        raise UsageError(f"Aborted. {unchanged[:1].upper()}{unchanged[1:]}.")
