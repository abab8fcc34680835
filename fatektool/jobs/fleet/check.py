"""Is a PLC as it ought to be? For monitoring: facts with a state each, and the worst of them.

=====================  ==========  ==============================================================
fact                   if not so   what it is
=====================  ==========  ==============================================================
reachable              CRITICAL    it answers; UNKNOWN if another program has the line
running                CRITICAL    in RUN or STOP, as expected
ladder checksum        CRITICAL    that of the PLC's own status
watchdog               CRITICAL    the same
battery                WARNING     the same
emergency stop         WARNING     the same: somebody pressed it, the PLC itself is well
restore                CRITICAL    none into this PLC was left unfinished, as far as this user's records say
program                CRITICAL    word for word that of the reference; UNKNOWN if either cannot be read
backup                 CRITICAL    the last one can be read, and has a program in it
its age                WARNING     not above the limit, not of the future
=====================  ==========  ==============================================================

States are those of monitoring plugins (Monitoring Plugins Development Guidelines, section 2.3). UNKNOWN is
the weakest of the bad ones: what could not be looked at hides nothing of what was found. So the PLC is asked
first, and the reference is opened afterwards.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Final

from fatektool.errors import DataError, FatektoolError, LineError, PortBusy, UsageError
from fatektool.jobs.programs.safekeeping import age_s, require_ladder
from fatektool.jobs.programs.verify import verify_file
from fatektool.jobs.progress import Progress, no_progress
from fatektool.program.archive import load_backup
from fatektool.project.program_file import load_program

if TYPE_CHECKING:
    from collections.abc import Iterable
    from datetime import datetime
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.project.program_file import ProgramFile
    from fatektool.protocol.status import StatusFlags

_AGE: Final = re.compile(r"(\d{1,9}(?:\.\d{1,3})?)([smhd])", re.ASCII)
_UNITS: Final = {"s": 1, "m": 60, "h": 3600, "d": 86400}
_CLOCKS_APART_S: Final = 3600


class State(IntEnum):
    """What a plugin's exit code says."""

    OK = 0
    WARNING = 1
    CRITICAL = 2
    UNKNOWN = 3


_BY_WEIGHT: Final = (State.CRITICAL, State.WARNING, State.UNKNOWN, State.OK)


def worst(states: Iterable[State]) -> State:
    """The one that somebody must look at first; OK if there is none."""
    return min(states, key=_BY_WEIGHT.index, default=State.OK)


@dataclass(frozen=True, slots=True)
class Fact:
    """One thing that was looked at."""

    state: State
    words: str


@dataclass(slots=True)
class Checked:
    """What was found.

    Attributes:
        facts: in the order of the table above.
        figures: performance data by label, as a plugin prints it: ``0.031s``, ``0``, ``1200s;129600``.
        flags: the PLC's status; None if it was not reached.
        differs: True if the program is not the reference; None if it was not compared.
    """

    facts: list[Fact] = field(default_factory=list)
    figures: dict[str, str] = field(default_factory=dict)
    flags: StatusFlags | None = None
    differs: bool | None = None

    @property
    def state(self) -> State:
        """The worst of all facts."""
        return worst(fact.state for fact in self.facts)

    @property
    def words(self) -> str:
        """All facts on one line, the worst first."""
        ordered = sorted(self.facts, key=lambda fact: _BY_WEIGHT.index(fact.state))
        return ", ".join(fact.words for fact in ordered)

    def add(self, bad: State | None, words: str) -> None:
        """Note a fact; ``bad`` is None for one that is as it ought to be."""
        self.facts.append(Fact(State.OK if bad is None else bad, words))

    def fail(self, error: FatektoolError) -> None:
        """Note what kept the PLC from being looked at."""
        dead = isinstance(error, LineError) and not isinstance(error, PortBusy)
        self.add(State.CRITICAL if dead else State.UNKNOWN, error.message)


def check_plc(
    plc: Plc,
    found: Checked,
    *,
    expect: str,
    reference: Path | None,
    progress: Progress = no_progress,
) -> None:
    """Look at a PLC.

    Args:
        plc: the PLC.
        found: takes the facts.
        expect: ``run``, ``stop`` or ``any``.
        reference: the backup or project whose program ought to be in it; None for none.
        progress: told of each page.

    Raises:
        LineError: no answer, or none any more.
        PlcError: the PLC refuses.
    """
    clock = plc.link.transport.clock
    began = clock()
    found.flags = flags = plc.brief_status().flags
    found.figures["response"] = f"{clock() - began:.4f}s;;;0"
    mode = "RUN" if flags.running else "STOP"
    wrong = expect != "any" and mode.lower() != expect
    found.add(State.CRITICAL if wrong else None, f"in {mode}, expected {expect.upper()}" if wrong else mode)
    found.add(
        State.CRITICAL if flags.ladder_checksum_error else None,
        "ladder checksum ERROR" if flags.ladder_checksum_error else "ladder checksum ok",
    )
    if flags.watchdog_timeout:
        found.add(State.CRITICAL, "watchdog TIMED OUT")
    found.add(
        State.WARNING if flags.battery_low else None, "battery LOW" if flags.battery_low else "battery ok"
    )
    if flags.emergency_stop:
        found.add(State.WARNING, "emergency stop ACTIVE")
    for label in ("running", "battery_low"):
        found.figures[label] = str(int(getattr(flags, label)))
    if reference is None:
        return
    try:
        program = load_program(reference)
    except (DataError, UsageError) as error:
        found.add(State.UNKNOWN, f"program NOT COMPARED: {error.message}")
        return
    _compare(plc, found, str(reference), program, progress)


def _compare(plc: Plc, found: Checked, name: str, program: ProgramFile, progress: Progress) -> None:
    compared = verify_file(plc, program, progress=progress)
    different = compared.pages
    found.differs = not different.same
    words = "1 word" if different.word_count == 1 else f"{different.word_count} words"
    pages = "1 page" if len(different.pages) == 1 else f"{len(different.pages)} pages"
    found.figures["words_differ"] = str(different.word_count)
    networks = "" if compared.networks_summary is None else f"{compared.networks_summary}, "
    if different.same:
        found.add(None, f"program as in {name}")
    elif different.a_ladder_words != different.b_ladder_words:
        found.add(State.CRITICAL, f"program DIFFERS from {name}: another ladder size")
    else:
        found.add(
            State.CRITICAL,
            f"program DIFFERS from {name}: {networks}{words} in {pages}",
        )


def check_backup(path: Path, found: Checked, *, max_age_s: float | None, now: datetime) -> None:
    """Look at the last backup: one that cannot be read, or has lost its program, is none.

    Args:
        path: the file.
        found: takes the facts.
        max_age_s: how old it may be; None for any age.
        now: the present.
    """
    try:
        backup = load_backup(path)
        require_ladder(backup.program)
    except (DataError, UsageError) as error:
        found.add(State.CRITICAL, f"NO GOOD BACKUP: {error.message}")
        return
    age = age_s(backup, now)
    limit = "" if max_age_s is None else f"{max_age_s:.0f}"
    found.figures["backup_age"] = f"{max(0.0, age):.0f}s;{limit};;0"
    if age < -_CLOCKS_APART_S:
        found.add(State.WARNING, f"backup of the FUTURE, {backup.created}: a clock is wrong")
    elif max_age_s is not None and age > max_age_s:
        found.add(State.WARNING, f"backup {age_words(age)} OLD, expected at most {age_words(max_age_s)}")
    else:
        found.add(None, f"backup {age_words(max(0.0, age))} old")


def parse_age(text: str) -> float:
    """Read ``36h``, ``90m``, ``7d`` or ``3600s``.

    Raises:
        UsageError: it is none.
    """
    match = _AGE.fullmatch(text.strip())
    if match is None:
        raise UsageError(f"--max-age {text!r}: expected a number and s, m, h or d, such as 36h")
    return float(match[1]) * _UNITS[match[2]]


def age_words(seconds: float) -> str:
    """An age in its largest whole unit: ``3 h``, ``2 d``."""
    for unit, size in reversed(_UNITS.items()):
        if seconds >= 2 * size or unit == "s":
            return f"{seconds / size:.0f} {unit}"
    raise AssertionError  # seconds fit always
