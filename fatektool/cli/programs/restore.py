"""``restore``: write a backup's program into a PLC."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import click

from fatektool.cli.programs.documents import restore_document
from fatektool.cli.programs.restore_data import data_document, data_plan_lines, data_rows, data_warnings
from fatektool.cli.shared.addressee import Addressee, ExchangeTime, Origin
from fatektool.cli.shared.colour import joined, word
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.image_words import warn_of_image
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.output import Voice, table
from fatektool.cli.shared.pairs import together
from fatektool.cli.shared.unfinished import DATA, forget, record_to_use
from fatektool.cli.shared.write_back import Offer, WriteCommand
from fatektool.cli.shared.write_options import Terms, write_options
from fatektool.counts import counted
from fatektool.errors import PlcError, UsageError
from fatektool.files.atomic import read_bounded
from fatektool.jobs.programs.restore import (
    RestoreOptions,
    RestorePlan,
    RestoreResult,
    carry_out,
    data_of,
    plan_restore,
)
from fatektool.jobs.programs.safety import SafetyBackup, known_before_restore
from fatektool.program.archive import LARGEST_FILE, Backup
from fatektool.program.image import page_ranges
from fatektool.program.plc_record import model_words
from fatektool.project.records import is_project
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import ProgressBar
    from fatektool.client import Plc


_DATA_LEFT: Final = "FILE has data too. They are not written without --data: the PLC keeps its own."


@click.command("restore", epilog="Example: fatektool restore press.json -p sim: --stop --run --yes")
@click.argument("file", type=PATH)
@click.option(
    "--data",
    is_flag=True,
    help="Write the data of FILE too: registers, relays, current values, disabled discretes.",
)
@click.option("--system", is_flag=True, help="With --data: write port and modem settings too.")
@click.option("--stop", is_flag=True, help="STOP a running PLC. Make the machine safe first.")
@click.option("--run", is_flag=True, help="RUN the PLC after the program is read back and verified.")
@click.option("--changed-only", is_flag=True, help="Write only the pages that differ.")
@click.option("--single-pass", is_flag=True, help="Read the previous program once instead of twice.")
@click.option("--any-header", is_flag=True, help="Restore an image that was saved with --any-header.")
@write_options("program", "backup")
@connection_options
def restore_command(
    connection: Connection,
    voice: Voice,
    *,
    file: Path,
    data: bool,
    system: bool,
    stop: bool,
    run: bool,
    changed_only: bool,
    single_pass: bool,
    any_header: bool,
    terms: Terms,
) -> int:
    """Write the program in FILE into the PLC, with --data also the data.

    FILE and PLC are checked, the previous program is saved as a safety backup, all pages are written and read
    back. Data are written after the program is verified. A restore that was interrupted is completed by the
    same command.
    """
    together("system", holds=data, needs="--data")
    backup = _backup_in(file)
    options = RestoreOptions(stop, run, changed_only, terms.rollback, any_header, single_pass, data, system)
    data_of(backup, options)
    writing = WriteCommand(connection, voice, terms, file, *(DATA if data else ()))
    with writing.open(Command.READ_PAGE, Command.WRITE_PAGE) as plc, voice.progress() as bar:
        pace = ExchangeTime(plc)
        known = known_before_restore(backup.program, file, writing.folder, plc.link.station)
        plan = plan_restore(plc, backup, options, known=known, progress=bar.update)
        bar.pause()  # while it is shown, stderr is rich's, which older versions say is no terminal
        here = Addressee(
            plc.target, plc.link.station, model_words(plan.present.plc["system"]), running=plan.running
        )
        origin = Origin(backup.source.target, backup.source.station, backup.created)
        warn_of_image(backup.program, voice)
        for warning in plan.warnings:
            voice.warn(warning)
        origin.warn_unless_from(here, file, voice)
        for warning in () if plan.data is None else data_warnings(plan.data):
            voice.warn(warning)
        writing.require_answer(changes=plan.changes)
        ask = _Question(writing, plan, here, backup, pace)
        offer = ask.offer([("file", file), ("from", origin)], plc)
        result = _nothing_done(plan) if terms.dry_run else _carry_out(plc, plan, file, offer, pace, bar=bar)
        for warning in result.warnings[len(plan.warnings) :]:
            voice.warn(warning)
        document = restore_document(
            plc,
            file,
            result,
            dry_run=terms.dry_run,
            pages_to_write=len(plan.pages),
            duration_s=pace.passed_s,
            model=here.model,
            source=origin.document(),
            data=data_document(plan, result),
        )
    for name, why in result.not_taken.items():
        voice.warn(f"{name}: {why}")
    if result.not_taken and run:
        voice.warn("the PLC stays in STOP, as not all data were taken")
    voice.show(document, _lines(plan, result, offer, pace))
    if backup.data is not None and not data:
        voice.say(_DATA_LEFT)
    return PlcError.exit_code if result.not_taken else 0


def _backup_in(file: Path) -> Backup:
    """The backup to restore.

    Raises:
        UsageError: it is a project of the vendor's program.
    """
    data = read_bounded(file, LARGEST_FILE)
    if is_project(data):
        raise UsageError(
            f"{file} is a WinProladder project, and restore takes only backups: what WinProladder changes "
            "when it loads a project into a PLC is not known",
            hint="load it with WinProladder; 'fatektool verify' and 'diff' compare a project",
            file=str(file),
        )
    return Backup.parse(data, str(file))


class _Question(NamedTuple):
    """What is shown before a restore.

    Attributes:
        writing: the command.
        plan: what will be done.
        here: the PLC.
        backup: what is restored.
        pace: of the exchanges that the plan took.
    """

    writing: WriteCommand
    plan: RestorePlan
    here: Addressee
    backup: Backup
    pace: ExchangeTime

    def offer(self, rows: list[tuple[str, object]], plc: Plc) -> Offer:
        """The restore as it is shown; where nothing differs, the question is about RUN."""
        plan, data = self.plan, self.plan.data
        what = "program" if data is None else "program and data"
        if not plan.changes:
            question = f"The PLC already has the {what} of FILE. RUN {self.here.name}?"
            return Offer(self.writing, self.here, rows, [], question, "")
        exchanges = len(plan.pages) + len(plan.wanted.pages) * bool(plan.pages)
        exchanges += 0 if data is None else data.exchanges(plc)
        rows = [*rows, ("time", self.pace.time_of(exchanges))]
        question = f"Write the {what} into {self.here.name}?"
        return Offer(self.writing, self.here, rows, [*self._lines()], question, what, ("--changed-only",))

    def _lines(self) -> Iterator[str]:
        plan, differ = self.plan, self.plan.comparison.page_numbers
        if plan.pages:
            words = counted(plan.comparison.word_count, "word")
            yield f"The PLC's program differs in {page_ranges(differ)} ({words})."
        else:
            yield "The PLC's program is that of FILE already."
        if plan.running:
            yield "The PLC is in RUN and will be stopped."
        if plan.pages:
            yield from _pages_lines(len(plan.pages), len(differ), len(plan.wanted.pages))
        if plan.data is not None:
            yield from data_plan_lines(plan.data)
        elif self.backup.data is not None:
            yield _DATA_LEFT
        if plan.options.run:
            yield "Then the PLC will RUN."


def _pages_lines(written: int, differ: int, count: int) -> Iterator[str]:
    """How many pages will be written, and why more than differ."""
    if written < count:
        yield f"{written} of {count} pages will be written, then all read back."
        return
    yield f"All {count} pages will be written, then all read back."
    if differ < count:
        those = "page that differs" if differ == 1 else f"{differ} pages that differ"
        yield f"--changed-only writes only the {those}."


def _carry_out(
    plc: Plc, plan: RestorePlan, file: Path, offer: Offer, pace: ExchangeTime, *, bar: ProgressBar
) -> RestoreResult:
    """Save the previous program, ask, and restore."""

    def agree(copy: Path | None) -> None:
        with pace.stopped():
            offer.agree(copy)
        bar.go_on()

    wanted = None if plan.data is None else plan.data.wanted
    writing = offer.writing
    safety = SafetyBackup(plan.present, plan.wanted, file, writing.folder, wanted, writing.earlier_copy)
    with offer.carry_out() as mark:
        result = carry_out(plc, plan, safety, agree, progress=bar.update, mark=mark)
    writing.forget()
    if wanted is not None:  # the program is verified too
        forget(record_to_use(plc.target, plc.link.station), writing.voice)
    return result


def _nothing_done(plan: RestorePlan) -> RestoreResult:
    mode = "run" if plan.running else "stop"
    return RestoreResult(
        pages_written=0,
        pages_equal=len(plan.wanted.pages) - len(plan.comparison.pages),
        verified=plan.comparison.same,
        safety_backup=None,
        mode_before=mode,
        mode_after=mode,
        warnings=plan.warnings,
    )


def _lines(plan: RestorePlan, result: RestoreResult, offer: Offer, pace: ExchangeTime) -> Iterator[str]:
    facts = dict(offer.rows)
    if not plan.changes:
        what = "program is" if plan.data is None else "program and data are"
        one = "the one" if plan.data is None else "those"
        yield f"same: the PLC's {what} {one} in {facts['file']} already; nothing was written"
    elif offer.writing.terms.dry_run:
        yield from offer.dry_run()
    else:
        kept = result.safety_backup
        yield from table(
            [
                ("restored", f"{facts['file']}, read back and verified"),
                ("from", facts["from"]),
                ("PLC", offer.here.name),
                ("model", offer.here.model),
                ("pages", f"{result.pages_written} written, {result.pages_equal} were equal already"),
                *data_rows(plan, result),
                (
                    f"previous {offer.copied}",
                    f"saved in {kept}" if (kept := result.safety_backup) else "not saved",
                ),
                ("took", pace.passed),
            ]
        )
    if not offer.writing.terms.dry_run:
        yield joined("the PLC is in ", word(result.mode_after.upper()))
