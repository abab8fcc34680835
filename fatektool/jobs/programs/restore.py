"""Restore: put a backup's program into a PLC, so that the previous one can be written back.

The order, and what an end at each step leaves in the PLC::

    1. the file is read and checked                            the previous program
    2. status: ladder size, ROM pack, RUN                      the previous program
    3. the PLC's program is read; equal: done                  the previous program
    4. it is on disk as a safety backup                        the previous program
    5. the plan is shown and agreed to                         the previous program
    6. still the same PLC? STOP; pages are written, 0 to N     part previous, part new: run the same again
    7. all is read back and compared                           the new program, not yet verified
    8. RUN, if asked                                           the new program

With data there are two parts: the data are read at 3 and saved at 4, and written when 7 has verified the
program; see ``fatektool.jobs.data.rewrite``.

``plan_restore`` does 2 and 3; ``carry_out`` does 4 to 7 by ``write_back``, and 8.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from fatektool.callbacks import ignore
from fatektool.errors import LineError, PlcError, PlcNotReady, UsageError
from fatektool.jobs.data.plan import DataPlan, plan_data, require_data_fits
from fatektool.jobs.data.reading import data_counts, read_data
from fatektool.jobs.data.rewrite import DataRewrite
from fatektool.jobs.programs.backup import backup_of
from fatektool.jobs.programs.fit import model_warning, require_kin, require_size
from fatektool.jobs.programs.proving import read_proven
from fatektool.jobs.programs.reading import read_program
from fatektool.jobs.programs.rewrite import Rewrite
from fatektool.jobs.programs.safety import SafetyBackup, known_before_restore
from fatektool.jobs.write_back.plan import WritePlan
from fatektool.jobs.write_back.record import NO_MARK, WriteMark
from fatektool.jobs.write_back.write import Agree, agreed, write_back
from fatektool.program.compare import Comparison, compare_images
from fatektool.program.image import ranges

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.client import Plc
    from fatektool.jobs.programs.known import KnownPages
    from fatektool.jobs.progress import Progress
    from fatektool.program.archive import Backup
    from fatektool.program.data.part import DataPart
    from fatektool.program.image import Program


@dataclass(frozen=True, slots=True)
class RestoreOptions:
    """What a restore may do.

    Attributes:
        stop: stop a running PLC; without it a running PLC is refused.
        run: let it run again when all is read back.
        changed_only: write only the pages that differ.
        rollback: write the previous program back if writing or reading back finally fails.
        any_header: restore a file whose header is invalid and that is marked so.
        single_pass: read the previous program once, not twice.
        data: write the data on file too.
        system: write settings too, which are special registers; only with ``data``.
    """

    stop: bool = False
    run: bool = False
    changed_only: bool = False
    rollback: bool = False
    any_header: bool = False
    single_pass: bool = False
    data: bool = False
    system: bool = False


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
        data: what will be written of the data; None if the program alone is restored.
    """

    wanted: Program
    present: Backup
    comparison: Comparison
    pages: tuple[int, ...]
    running: bool
    warnings: tuple[str, ...]
    options: RestoreOptions
    data: DataPlan | None = None

    @property
    def changes(self) -> bool:
        """True if anything will be written."""
        return bool(self.pages or (self.data and self.data.changes))


@dataclass(frozen=True, slots=True)
class RestoreResult:
    """What a restore did.

    Attributes:
        pages_written: how many pages were written.
        pages_equal: how many pages were equal already.
        verified: True: the whole program was read and equals the file.
        safety_backup: where the previous program is saved; None if it is not, or nothing was written.
        mode_before: ``run`` or ``stop``.
        mode_after: ``run`` or ``stop``.
        warnings: what the user should know.
        not_taken: values, disabled discretes and settings that did not take, in words, by element.
    """

    pages_written: int
    pages_equal: int
    verified: bool
    safety_backup: str | None
    mode_before: str
    mode_after: str
    warnings: tuple[str, ...]
    not_taken: Mapping[str, str] = field(default_factory=dict)


def plan_restore(
    plc: Plc,
    backup: Backup,
    options: RestoreOptions,
    *,
    known: KnownPages | None = None,
    progress: Progress = ignore,
) -> RestorePlan:
    """Check that a backup fits this PLC and find what differs. Changes nothing.

    Args:
        plc: the PLC.
        backup: what to restore.
        options: what the restore may do.
        known: what is on file of the program now in the PLC; a page that is as on file is read once.
        progress: called for each page.

    Raises:
        DataError: another ladder size, or fewer elements than on file; an invalid header.
        UsageError: the file has no data, and they are to be restored.
        PlcNotReady: a ROM pack is fitted, or the PLC runs and may not be stopped.
        LineError: no answer.
        PlcRefused: the PLC refuses its program.
    """
    if not options.any_header:
        backup.program.require_header(
            "restore another backup; or --any-header, if the PLC had this very header when it was backed up"
        )
    wanted = data_of(backup, options)
    status = plc.detailed_status()
    require_size(backup.program, status.system.ladder_words)
    if status.flags.rom_pack:
        raise PlcNotReady(
            "a ROM pack is fitted: the PLC does not accept a program over the line",
            hint="switch the PLC off, take the ROM pack out, switch it on and run this again",
        )
    if status.flags.running and not options.stop:
        raise PlcNotReady(
            "the PLC is in RUN: expected STOP before its program is written",
            hint="make the machine safe, then add --stop",
        )
    if wanted is not None:
        require_data_fits(wanted, data_counts(plc, status.system))
    reading = (
        read_program(plc, progress=progress) if options.single_pass else read_proven(plc, known, progress)
    )
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
        warnings.append(f"the PLC has more pages than the file, {left}: they are not changed")
    before, data = backup_of(plc, reading), None
    if wanted is not None:
        there = read_data(plc, reading.status, progress)
        before, data = replace(before, data=there), plan_data(wanted, there, settings=options.system)
    return RestorePlan(
        backup.program,
        before,
        comparison,
        pages,
        status.flags.running,
        tuple(warnings),
        options,
        data,
    )


def data_of(backup: Backup, options: RestoreOptions) -> DataPart | None:
    """The data that are to be restored; None if the program alone is.

    Raises:
        UsageError: the file has none.
    """
    if not options.data:
        return None
    if backup.data is None:
        raise UsageError(
            "the file has no data: it was saved without --data",
            hint="restore the program alone, without --data; 'fatektool snapshot apply' writes a snapshot",
        )
    return backup.data


def carry_out(
    plc: Plc,
    plan: RestorePlan,
    safety: SafetyBackup | None = None,
    agree: Agree = agreed,
    *,
    progress: Progress = ignore,
    mark: WriteMark = NO_MARK,
) -> RestoreResult:
    """Do what was planned: safety backup, question, STOP, write, read back, RUN.

    Args:
        plc: the PLC.
        plan: of this PLC, just now.
        safety: saves the previous program; None for no safety backup.
        agree: gets where that is, and raises an error if the user does not agree; not called if there is
            nothing to do.
        progress: called for each page.
        mark: records that pages are being written.

    Raises:
        RestoreIncomplete: the PLC's program is neither the previous nor the new one.
        UsageError: the safety backup cannot be written, or the user does not agree; nothing was written.
        DataError: this is not the PLC that the plan was made of; nothing was written.
        PlcError, LineError: nothing was changed; or all was, and RUN is refused; or it was rolled back.
    """
    running, warnings = plan.running, plan.warnings
    path, data, written = None, None, len(plan.pages)
    if plan.changes:
        rewrite = Rewrite(plc, plan.wanted, plan.present, plan.pages, running=running)
        data = None if plan.data is None else DataRewrite(plc, plan.data)
        safety = safety or SafetyBackup(plan.present, plan.wanted, Path(), None)
        warnings += safety.doubts
        whole = WritePlan(
            (rewrite,) if data is None else (rewrite, data),
            safety,
            "the restore did not complete",
            rollback=plan.options.rollback,
        )
        path = write_back(plc, whole, agree, mark=mark, progress=progress)
        running = bool(rewrite.running)
        written -= len(rewrite.left)
        warnings += rewrite.warnings
    elif plan.options.run and not running:
        agree(None)
    not_taken = {} if data is None else data.not_taken
    if plan.options.run and not running and not not_taken:  # with half of its data no machine starts
        _run(plc)
        running = True
    return RestoreResult(
        pages_written=written,
        pages_equal=len(plan.wanted.pages) - len(plan.comparison.pages),
        verified=True,
        safety_backup=None if path is None else str(path),
        mode_before="run" if plan.running else "stop",
        mode_after="run" if running else "stop",
        warnings=warnings,
        not_taken=not_taken,
    )


def _run(plc: Plc) -> None:
    try:
        plc.run()
    except (LineError, PlcError) as error:
        silent = isinstance(error, LineError)
        doubt = "whether it runs is not known" if silent else "the PLC does not RUN"
        raise (LineError if silent else PlcError)(
            f"the program of FILE is in the PLC, read back and verified, but {doubt}: {error.message}",
            hint=error.hint,
            **error.details,
        ) from error


def restore(
    plc: Plc,
    backup: Backup,
    file: Path | str,
    *,
    confirm: Callable[[RestorePlan, Path | None], bool],
    options: RestoreOptions = RestoreOptions(),
    safety_folder: Path | str | None = None,
    save_previous: bool = True,
    earlier: Path | str | None = None,
    progress: Progress = ignore,
) -> RestoreResult:
    """Restore a program: plan, safety backup, question, write, read back.

    Args:
        plc: the PLC.
        backup: what to restore.
        file: where it came from; the safety backup is named after it.
        confirm: is shown the plan and where the previous program is saved, and says whether to go on; not
            called if no page is to be written.
        options: what the restore may do.
        safety_folder: where the safety backup goes; None for beside ``file``.
        save_previous: False for no safety backup: the restore cannot be undone.
        earlier: the safety backup of an earlier call that raised ``RestoreIncomplete``, to be used again.
        progress: called for each page.

    Raises:
        UsageError: ``confirm`` said no, or the safety backup cannot be written; nothing was written.
        RestoreIncomplete: the PLC's program is neither the previous nor the new one.
        DataError, PlcError, LineError: see ``plan_restore`` and ``carry_out``.
    """
    file = Path(file)
    folder = Path(safety_folder or file.parent) if save_previous else None
    known = known_before_restore(backup.program, file, folder, plc.link.station)
    plan = plan_restore(plc, backup, options, known=known, progress=progress)

    def agree(kept: Path | None) -> None:
        if plan.changes and not confirm(plan, kept):
            raise UsageError("Aborted. Nothing was written.")

    wanted = None if plan.data is None else plan.data.wanted
    former = None if earlier is None or folder is None else Path(earlier)
    safety = SafetyBackup(plan.present, plan.wanted, file, folder, wanted, former)
    return carry_out(plc, plan, safety, agree, progress=progress)
