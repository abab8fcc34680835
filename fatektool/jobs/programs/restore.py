"""Restore: put a backup's program into a PLC, with a way back at every step.

The order, and what an end at each step leaves in the PLC::

    1. the file is read and checked                            the old program
    2. status: ladder size, ROM pack, RUN                      the old program
    3. the PLC's program is read; equal: done                  the old program
    4. it is on disk as a safety backup                        the old program
    5. the plan is shown and agreed to                         the old program
    6. still the same PLC? STOP; pages are written, 0 to N     part old, part new: the same command goes on
    7. all is read back and compared                           the new program, not yet proven
    8. RUN, if asked                                           the new program

``plan_restore`` does 2 and 3, ``carry_out`` 6 to 8; ``restore`` does all with 4 in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.errors import (
    DataError,
    FatektoolError,
    LineError,
    PlcError,
    PlcNotReady,
    RestoreIncomplete,
    UsageError,
)
from fatektool.jobs.programs.backup import backup_of
from fatektool.jobs.programs.fit import model_warning, require_kin, require_size
from fatektool.jobs.programs.reading import ProgramReading, read_program, read_program_twice
from fatektool.jobs.programs.rewrite import Rewrite
from fatektool.jobs.programs.safety import way_back
from fatektool.jobs.progress import Progress, no_progress
from fatektool.program.compare import Comparison, compare_images
from fatektool.program.image import ranges

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.jobs.programs.unfinished import Mark
    from fatektool.program.archive import Backup
    from fatektool.program.image import Program


@dataclass(frozen=True, slots=True)
class RestoreOptions:
    """What a restore may do.

    Attributes:
        stop: stop a running PLC; without it a running PLC is refused.
        run: let it run again when all is read back.
        changed_only: write only the pages that differ.
        rollback: put the old program back if writing or reading back fails for good.
        any_header: restore a file whose header does not hold and that says so.
        single_pass: read the old program once, not twice.
    """

    stop: bool = False
    run: bool = False
    changed_only: bool = False
    rollback: bool = False
    any_header: bool = False
    single_pass: bool = False


@dataclass(frozen=True, slots=True)
class RestorePlan:
    """What a restore will do.

    Attributes:
        wanted: the program on file.
        present: the program in the PLC, as a backup.
        comparison: ``wanted`` (a) against ``present`` (b).
        pages: the pages that will be written, in order.
        running: True if the PLC runs now.
        warnings: what the user should know before agreeing.
        options: what was asked.
    """

    wanted: Program
    present: Backup
    comparison: Comparison
    pages: tuple[int, ...]
    running: bool
    warnings: tuple[str, ...]
    options: RestoreOptions


@dataclass(frozen=True, slots=True)
class RestoreResult:
    """What a restore did.

    Attributes:
        pages_written: how many pages were written.
        pages_equal: how many pages were equal already.
        verified: True: the whole program was read and equals the file.
        safety_backup: where the old program lies; None if it was not asked for or nothing was written.
        mode_before: ``run`` or ``stop``.
        mode_after: ``run`` or ``stop``.
        warnings: what the user should know.
    """

    pages_written: int
    pages_equal: int
    verified: bool
    safety_backup: str | None
    mode_before: str
    mode_after: str
    warnings: tuple[str, ...]


def plan_restore(
    plc: Plc, backup: Backup, options: RestoreOptions, *, progress: Progress = no_progress
) -> RestorePlan:
    """Check that a backup fits this PLC and find what differs. Changes nothing.

    Raises:
        DataError: another ladder size; a header that does not hold.
        PlcNotReady: a ROM pack is fitted, or the PLC runs and may not be stopped.
        LineError: no answer.
        PlcRefused: the PLC does not give its program away.
    """
    if not options.any_header:
        backup.program.require_header(
            "restore another backup; or --any-header, if the PLC had this very header when it was backed up"
        )
    status = plc.detailed_status()
    require_size(backup.program, status.system.ladder_words)
    if status.flags.rom_pack:
        raise PlcNotReady(
            "a ROM pack is fitted: the PLC takes no program over the link",
            hint="switch the PLC off, take the ROM pack out, switch it on and run this again",
        )
    if status.flags.running and not options.stop:
        raise PlcNotReady(
            "the PLC is in RUN: expected STOP before its program is written",
            hint="make the machine safe, then add --stop",
        )
    reading = _read_present(plc, options, progress)
    present = reading.program
    require_size(backup.program, present.ladder_words)  # it may be another PLC by now
    require_kin(backup.program, present, any_header=options.any_header)
    count = len(backup.program.pages)
    comparison = compare_images(
        backup.program,
        present.ladder_words,
        present.pages[:count],
        b_has_more=len(present.pages) > count,
    )
    every = range(count)
    pages = tuple(comparison.page_numbers if options.changed_only else every) if comparison.pages else ()
    warnings = []
    if status.flags.id_set:
        warnings.append("the PLC has an ID set: a program with another ID loads, but will not RUN (error 6)")
    other_model = model_warning(backup.plc["system"], reading.status.system.document())
    if other_model is not None:
        warnings.append(other_model)
    if comparison.b_has_more:
        left = ranges(range(count, len(present.pages)))
        warnings.append(f"the PLC has more pages than the file, {left}: they stay as they are")
    return RestorePlan(
        backup.program,
        backup_of(plc, reading),
        comparison,
        pages,
        status.flags.running,
        tuple(warnings),
        options,
    )


def _read_present(plc: Plc, options: RestoreOptions, progress: Progress) -> ProgramReading:
    phase = "old program"
    if options.single_pass:
        return read_program(plc, phase, progress)
    return read_program_twice(plc, progress, phase=phase)


def carry_out(
    plc: Plc,
    plan: RestorePlan,
    safety_backup: str | None,
    *,
    progress: Progress = no_progress,
    mark: Mark | None = None,
) -> RestoreResult:
    """Do what was planned: STOP, write, read back, RUN.

    Args:
        plc: the PLC.
        plan: of this PLC, just now.
        safety_backup: where the old program lies, for messages.
        progress: told of each page.
        mark: takes note that pages are being written.

    Raises:
        RestoreIncomplete: the PLC's program is neither old nor new; ``details`` say which pages are.
        DataError: this is not the PLC that the plan was made of; nothing was written.
        PlcError: nothing was written; or all was, and RUN is refused; or it was rolled back.
        LineError: the same, for want of an answer.
    """
    running = plan.running
    warnings = plan.warnings
    if plan.pages:
        _require_as_planned(plc, plan)
        if running:
            plc.stop()
            running = False
        warnings += _write(plc, plan, safety_backup, progress, mark)
    if plan.options.run and not running:
        try:
            plc.run()
        except (LineError, PlcError) as error:
            silent = isinstance(error, LineError)
            doubt = "whether it runs is not known" if silent else "the PLC does not RUN"
            raise (LineError if silent else PlcError)(
                f"the program on file is in the PLC, read back and proven, but {doubt}: {error.message}",
                hint=error.hint,
                **error.details,
            ) from error
        running = True
    return RestoreResult(
        pages_written=len(plan.pages),
        pages_equal=len(plan.wanted.pages) - len(plan.comparison.pages),
        verified=True,
        safety_backup=safety_backup,
        mode_before="run" if plan.running else "stop",
        mode_after="run" if running else "stop",
        warnings=warnings,
    )


def _write(
    plc: Plc, plan: RestorePlan, safety_backup: str | None, progress: Progress, mark: Mark | None
) -> tuple[str, ...]:
    """Write the pages and read all back; give what the user should know."""
    rewrite = Rewrite(plc, plan.wanted, plan.present.program, safety_backup, progress)
    if mark is not None:
        mark.begin()
    try:
        rewrite.write(plan.pages, rollback=plan.options.rollback)
    except RestoreIncomplete:
        raise
    except FatektoolError:  # nothing was changed, or it is rolled back
        if mark is not None:
            mark.end(proven=False)
        raise
    if mark is not None:
        mark.end(proven=True)
    return rewrite.warnings


def _require_as_planned(plc: Plc, plan: RestorePlan) -> None:
    """Look once more before the first page: a question may have waited for its answer for a long time."""
    status = plc.detailed_status()
    before, now = plan.present.plc["system"], status.system.document()
    if now != before:
        changed = ", ".join(
            f"{name} {before[name]}, now {now[name]}" for name in now if now[name] != before[name]
        )
        raise DataError(
            f"this is not the PLC whose program was read ({changed}): nothing was written",
            hint="was it exchanged meanwhile? run the restore again",
        )
    if status.flags.rom_pack or (status.flags.running and not plan.running):
        what = "got a ROM pack" if status.flags.rom_pack else "went to RUN"
        raise PlcNotReady(
            f"the PLC {what} since its program was read: nothing was written",
            hint="was it exchanged meanwhile? run the restore again",
        )


def restore(
    plc: Plc,
    backup: Backup,
    file: Path,
    *,
    confirm: Callable[[RestorePlan, Path | None], bool],
    options: RestoreOptions = RestoreOptions(),
    safety_folder: Path | None = None,
    progress: Progress = no_progress,
) -> RestoreResult:
    """Restore a program: plan, safety backup, question, write, read back.

    Args:
        plc: the PLC.
        backup: what to restore.
        file: where it came from; the safety backup is named after it.
        confirm: is shown the plan and where the old program lies, and says whether to go on.
        options: what the restore may do.
        safety_folder: where the safety backup goes; None for none.
        progress: told of each page.

    Raises:
        UsageError: ``confirm`` said no.
        RestoreIncomplete: the PLC's program is neither old nor new.
        DataError: see ``plan_restore``.
        PlcError: see ``plan_restore`` and ``carry_out``.
        LineError: see ``plan_restore`` and ``carry_out``.
    """
    plan = plan_restore(plc, backup, options, progress=progress)
    with way_back(plan.present, plan.wanted, file, safety_folder if plan.pages else None) as kept:
        if plan.pages and not confirm(plan, kept.path):
            raise UsageError("not agreed to: the PLC's program is unchanged")
        return carry_out(plc, plan, kept.name, progress=progress, mark=kept)
