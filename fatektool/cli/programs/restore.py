"""``restore``: write a backup's program into a PLC."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.documents import restore_document
from fatektool.cli.shared.addressee import Addressee, ExchangeTime, Origin
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.image_words import warn_of_image
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.output import Voice, table
from fatektool.cli.shared.write_back import Offer, WriteCommand
from fatektool.cli.shared.write_options import Terms, write_options
from fatektool.counts import spent
from fatektool.errors import UsageError
from fatektool.files.atomic import read_bounded
from fatektool.jobs.programs.restore import (
    RestoreOptions,
    RestorePlan,
    RestoreResult,
    carry_out,
    plan_restore,
)
from fatektool.jobs.programs.safety import SafetyBackup, known_before_restore
from fatektool.program.archive import LARGEST_FILE, Backup
from fatektool.program.image import ranges
from fatektool.program.plc_record import model_words
from fatektool.project.records import is_project
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import ProgressBar
    from fatektool.client import Plc


@click.command("restore", epilog="Example: fatektool restore press.json -p sim: --stop --run --yes")
@click.argument("file", type=PATH)
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
    stop: bool,
    run: bool,
    changed_only: bool,
    single_pass: bool,
    any_header: bool,
    terms: Terms,
) -> None:
    """Write the program in FILE into the PLC.

    FILE and PLC are checked, the previous program is saved as a safety backup, all pages are written and read
    back. A restore that was interrupted is completed by the same command.
    """
    backup = _backup_in(file)
    writing = WriteCommand(connection, voice, terms, file)
    options = RestoreOptions(stop, run, changed_only, terms.rollback, any_header, single_pass)
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
        writing.require_answer(changes=bool(plan.pages))
        offer = _offer(writing, plan, here, [("file", file), ("from", origin)], pace)
        result = _nothing_done(plan) if terms.dry_run else _carry_out(plc, plan, file, offer, bar)
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
        )
    voice.show(document, _lines(plan, result, offer, pace))


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


def _offer(
    writing: WriteCommand,
    plan: RestorePlan,
    here: Addressee,
    rows: list[tuple[str, object]],
    pace: ExchangeTime,
) -> Offer:
    """The restore as it is shown; where the program is in the PLC already, the question is about RUN."""
    if not plan.pages:
        question = f"The PLC already has the program of FILE. RUN {here.name}?"
        return Offer(writing, here, rows, [], question, "")
    rows = [*rows, ("time", pace.time_of(len(plan.pages) + len(plan.wanted.pages)))]
    question = f"Write the program into {here.name}?"
    return Offer(writing, here, rows, [*_plan_lines(plan)], question, "program", ("--changed-only",))


def _carry_out(plc: Plc, plan: RestorePlan, file: Path, offer: Offer, bar: ProgressBar) -> RestoreResult:
    """Save the previous program, ask, and restore."""

    def agree(copy: Path | None) -> None:
        offer.agree(copy)
        bar.go_on()

    safety = SafetyBackup(plan.present, plan.wanted, file, offer.writing.folder)
    with offer.carry_out() as mark:
        result = carry_out(plc, plan, safety, agree, progress=bar.update, mark=mark)
    offer.writing.forget()
    return result


def _plan_lines(plan: RestorePlan) -> Iterator[str]:
    differ = plan.comparison.page_numbers
    pages = "page" if len(differ) == 1 else "pages"
    words = "1 word" if plan.comparison.word_count == 1 else f"{plan.comparison.word_count} words"
    yield f"The PLC's program differs in {pages} {ranges(differ)} ({words})."
    if plan.running:
        yield "The PLC is in RUN and will be stopped."
    yield f"{len(plan.pages)} of {len(plan.wanted.pages)} pages will be written, then all read back."
    if plan.options.run:
        yield "Then the PLC will RUN."


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
    if plan.comparison.same:
        yield f"same: the PLC's program is the one in {facts['file']} already; nothing was written"
    elif offer.writing.terms.dry_run:
        yield from offer.dry_run()
    else:
        yield from table(
            [
                ("restored", f"{facts['file']}, read back and verified"),
                ("from", facts["from"]),
                ("PLC", offer.here.name),
                ("model", offer.here.model),
                ("pages", f"{result.pages_written} written, {result.pages_equal} were equal already"),
                ("previous program", f"saved in {kept}" if (kept := result.safety_backup) else "not saved"),
                ("took", spent(pace.passed_s)),
            ]
        )
    if not offer.writing.terms.dry_run:
        yield f"the PLC is in {result.mode_after.upper()}"
