"""The check of a PLC for monitoring: each fact with its state.

=====================  ==========  ==============================================================
fact                   if not so   what it is
=====================  ==========  ==============================================================
reachable              CRITICAL    it answers; UNKNOWN if another program has the line
running                CRITICAL    in RUN or STOP, as expected
ladder checksum        CRITICAL    that of the PLC's own status
watchdog               CRITICAL    the same
battery                WARNING     the same
emergency stop         WARNING     the same: it was pressed, the PLC itself is ok
restore                CRITICAL    none into this PLC was left unfinished, as far as this user's records say
write of values        WARNING     the same: some values are the previous ones, others new
program                CRITICAL    word for word that of the reference; UNKNOWN if either cannot be read
backup                 CRITICAL    the last one can be read, and has a program in it
its age                WARNING     not above the limit, not of the future
=====================  ==========  ==============================================================

The PLC is asked first, and the reference is opened afterwards: a fault of the file must not hide a fault of
the PLC.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.callbacks import ignore
from fatektool.counts import counted
from fatektool.errors import DataError, FatektoolError, UsageError
from fatektool.jobs.check.age import age_words
from fatektool.jobs.check.result import CheckResult, State
from fatektool.jobs.programs.safekeeping import age_s, require_ladder
from fatektool.jobs.programs.verify import verify_file
from fatektool.jobs.write_back.record import RESTORE
from fatektool.program.archive import load_backup
from fatektool.project.program_file import load_program

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from datetime import datetime
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress
    from fatektool.jobs.write_back.record import Unfinished
    from fatektool.project.program_file import ProgramFile

_CLOCKS_APART_S: Final = 3600


@dataclass(frozen=True, slots=True)
class CheckPlan:
    """What is checked beside the PLC's status.

    Attributes:
        expect: the mode: ``run``, ``stop`` or ``any``.
        reference: the backup or project with the expected program; None for none.
        backup: the last backup; None for none.
        max_age_s: how old that may be; None for any age.
    """

    expect: str
    reference: Path | None
    backup: Path | None
    max_age_s: float | None


def check_plc(
    plan: CheckPlan,
    connect: Callable[[], Plc],
    *,
    unfinished: Callable[[], Iterable[Unfinished]],
    now: datetime,
    progress: Progress = ignore,
    is_stopped: Callable[[], bool] = lambda: False,
) -> CheckResult:
    """Check one PLC, and its backup whether the PLC answers or not.

    Args:
        plan: what is checked.
        connect: opens the line; what fails there is a fact too.
        unfinished: gives the writes into this PLC that did not complete.
        now: the present.
        progress: called for each page.
        is_stopped: True if the user ended the check: then an error is no fact about the PLC.

    Raises:
        FatektoolError: ``is_stopped``, in the middle of the check.
    """
    found = CheckResult()
    try:
        with connect() as plc:
            _check_plc(plc, found, expect=plan.expect, reference=plan.reference, progress=progress)
    except FatektoolError as error:
        if is_stopped():
            raise
        found.fail(error)
    for write in unfinished():
        words = f"{write.job} UNFINISHED since {write.time}"
        if write.job != RESTORE:
            found.add(State.WARNING, words)
        elif found.differs is not False:  # the reference's program is whole
            found.add(State.CRITICAL, f"{words}: do not switch it to RUN")
    if plan.backup is not None:
        check_backup(plan.backup, found, max_age_s=plan.max_age_s, now=now)
    return found


def _check_plc(
    plc: Plc,
    found: CheckResult,
    *,
    expect: str,
    reference: Path | None,
    progress: Progress = ignore,
) -> None:
    """Check a PLC's status, then its program; ``found`` gets the facts until the line fails."""
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


def _compare(plc: Plc, found: CheckResult, name: str, program: ProgramFile, progress: Progress) -> None:
    compared = verify_file(plc, program, progress=progress)
    different = compared.pages
    found.differs = not different.same
    words, pages = counted(different.word_count, "word"), counted(len(different.pages), "page")
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


def check_backup(path: Path, found: CheckResult, *, max_age_s: float | None, now: datetime) -> None:
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
        found.add(State.WARNING, f"backup DATED IN THE FUTURE, {backup.created}: a clock is wrong")
    elif max_age_s is not None and age > max_age_s:
        found.add(State.WARNING, f"backup {age_words(age)} OLD, expected at most {age_words(max_age_s)}")
    else:
        found.add(None, f"backup {age_words(max(0.0, age))} old")
