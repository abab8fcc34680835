"""``restore``: a backup's program into a PLC."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from fatektool.cli.programs.documents import restore_document
from fatektool.cli.shared.addressee import Addressee, Origin, Pace, agree, spent
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.image_words import warn_of_image
from fatektool.cli.shared.incomplete import restore_lines
from fatektool.cli.shared.options import PATH, yes_option
from fatektool.cli.shared.output import ProgressBar, Voice, table
from fatektool.cli.shared.pairs import apart
from fatektool.cli.shared.places import safety_folder
from fatektool.cli.shared.unfinished import RestoreMark, forget
from fatektool.errors import RestoreIncomplete, UsageError
from fatektool.files.atomic import read_bounded
from fatektool.files.times import utc
from fatektool.jobs.programs.restore import (
    RestoreOptions,
    RestorePlan,
    RestoreResult,
    carry_out,
    plan_restore,
)
from fatektool.jobs.programs.safety import way_back
from fatektool.jobs.programs.unfinished import Unfinished
from fatektool.program.archive import LARGEST_FILE, Backup
from fatektool.program.image import ranges
from fatektool.program.plc_record import model_words
from fatektool.project.records import is_project
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.client import Plc


@click.command("restore", epilog="Example: fatektool restore press.json -p /dev/ttyUSB0 --stop --run")
@click.argument("file", type=PATH)
@click.option("--stop", is_flag=True, help="Stop a running PLC. Make the machine safe first.")
@click.option("--run", is_flag=True, help="Let it RUN again when the program is read back and proven.")
@click.option("--changed-only", is_flag=True, help="Write only the pages that differ.")
@click.option("--dry-run", is_flag=True, help="Check and compare, show what would be done, write nothing.")
@click.option("--rollback", is_flag=True, help="Put the old program back if writing fails for good.")
@click.option(
    "--safety-dir", type=PATH, metavar="DIR", help="Where the old program is saved; by default beside FILE."
)
@click.option("--no-safety-backup", is_flag=True, help="Do not save the old program: no way back.")
@click.option("--single-pass", is_flag=True, help="Read the old program once instead of twice.")
@click.option("--any-header", is_flag=True, help="Restore an image that was kept with --any-header.")
@yes_option
@connection_options
def restore_command(
    connection: Connection,
    voice: Voice,
    *,
    file: Path,
    stop: bool,
    run: bool,
    changed_only: bool,
    dry_run: bool,
    rollback: bool,
    safety_dir: Path | None,
    no_safety_backup: bool,
    single_pass: bool,
    any_header: bool,
    yes: bool,
) -> None:
    """Put the program in FILE into the PLC.

    FILE and PLC are checked, the old program is saved as a safety backup, all pages are written and read
    back. A restore that was interrupted is finished by the same command.
    """
    apart("no_safety_backup", "rollback", "safety_dir")
    backup = _backup_in(file)
    folder = None if no_safety_backup else safety_folder(safety_dir, file, voice, dry_run=dry_run)
    options = RestoreOptions(stop, run, changed_only, rollback, any_header, single_pass)
    with (
        connection.open(
            voice, needs=(Command.READ_PAGE, Command.WRITE_PAGE), writes=not dry_run, finishes=True
        ) as plc,
        voice.progress() as bar,
    ):
        pace = Pace(plc)
        plan = plan_restore(plc, backup, options, progress=bar.update)
        bar.pause()  # while it is shown, stderr is rich's, which older versions say is no terminal
        here = Addressee(
            plc.target, plc.link.station, model_words(plan.present.plc["system"]), running=plan.running
        )
        origin = Origin(backup.source.target, backup.source.station, backup.created)
        warn_of_image(backup.program, voice)
        for warning in plan.warnings:
            voice.warn(warning)
        origin.warn_unless_from(here, file, voice)
        rows: list[tuple[str, object]] = [*here.rows(), ("file", file), ("from", origin)]
        if plan.pages:
            rows.append(("time", pace.time_of(len(plan.pages) + len(plan.wanted.pages))))
        if dry_run:
            result = _nothing_done(plan)
        else:
            ask = _Question(plan, rows, here.name, voice, bar, yes=yes)
            commands = _go_on(connection), _go_on(connection, file, safety_dir)
            result = _carry_out(plc, ask, file, folder, commands)
            for warning in result.warnings[len(plan.warnings) :]:
                voice.warn(warning)
        document = restore_document(
            plc,
            file,
            result,
            dry_run=dry_run,
            pages_to_write=len(plan.pages),
            duration_s=pace.passed_s,
            model=here.model,
            source=origin.document(),
        )
    voice.show(document, _lines(plan, result, rows, pace, dry_run=dry_run, saves=folder is not None))


def _backup_in(file: Path) -> Backup:
    """The backup to restore.

    Raises:
        UsageError: it is a project of the vendor's program.
    """
    data = read_bounded(file, LARGEST_FILE)
    if is_project(data):
        raise UsageError(
            f"{file} is a WinProladder project, and restore takes backups alone: what WinProladder changes "
            "when it loads a project into a PLC is not known",
            hint="load it with WinProladder; 'fatektool verify' and 'diff' compare a project",
            file=str(file),
        )
    return Backup.parse(data, str(file))


@dataclass(frozen=True, slots=True)
class _Question:
    """What is agreed to before anything is written."""

    plan: RestorePlan
    rows: list[tuple[str, object]]
    plc: str
    voice: Voice
    bar: ProgressBar
    yes: bool

    def ask(self, kept: str | None) -> None:
        """Show the plan and ask, if anything is to be done; ``kept`` is where the old program lies."""
        if self.plan.pages:
            lines, question = [*_plan_lines(self.plan, kept)], f"Write the program into {self.plc}?"
        elif self.plan.options.run and not self.plan.running:
            lines, question = [], f"The PLC holds the program on file already. RUN {self.plc}?"
        else:
            return
        agree(
            self.voice,
            self.rows,
            lines,
            question,
            yes=self.yes,
            unchanged="the PLC's program is unchanged",
        )
        self.bar.go_on()


def _carry_out(
    plc: Plc, question: _Question, file: Path, folder: Path | None, commands: tuple[str, str]
) -> RestoreResult:
    """Save the old program, ask, and restore.

    Args:
        plc: the PLC.
        question: what is agreed to.
        file: what is restored.
        folder: where the old program is saved.
        commands: what finishes it, given here, and given in another folder.
    """
    command, elsewhere = commands
    plan, voice = question.plan, question.voice
    if plan.pages:
        voice.require_answer(yes=question.yes, unchanged="nothing was written")
    with way_back(plan.present, plan.wanted, file, folder if plan.pages else None) as kept:
        question.ask(kept.name)
        safety = None if kept.path is None else str(kept.path.absolute())
        record = Unfinished(plc.target, plc.link.station, utc(), str(file.absolute()), safety, elsewhere)
        try:
            result = carry_out(
                plc,
                plan,
                kept.name,
                progress=question.bar.update,
                mark=RestoreMark(record, voice, kept),
            )
        except RestoreIncomplete as error:
            error.details["command"] = command
            error.hint = f"mend the cause, then: {command}"
            error.lines = restore_lines(error, question.plc, command)
            raise
    forget(plc.target, plc.link.station, voice)
    return result


def _plan_lines(plan: RestorePlan, kept: str | None) -> Iterator[str]:
    differ = plan.comparison.page_numbers
    pages = "page" if len(differ) == 1 else "pages"
    words = "1 word" if plan.comparison.word_count == 1 else f"{plan.comparison.word_count} words"
    yield f"The PLC's program differs in {pages} {ranges(differ)} ({words})."
    if kept is not None:
        yield f"The old program is saved in {kept}"
    else:
        yield "The old program is NOT saved: there is no way back."
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


def _lines(
    plan: RestorePlan,
    result: RestoreResult,
    rows: list[tuple[str, object]],
    pace: Pace,
    *,
    dry_run: bool,
    saves: bool,
) -> Iterator[str]:
    facts = dict(rows)
    if plan.comparison.same:
        yield f"same: the PLC's program is the one in {facts['file']} already; nothing was written"
    elif dry_run:
        yield from table(rows)
        yield from _plan_lines(plan, "a safety backup before the first page is written" if saves else None)
        yield "dry run: nothing was written"
    else:
        yield from table(
            [
                ("restored", f"{facts['file']}, read back and proven"),
                ("from", facts["from"]),
                ("PLC", facts["PLC"]),
                ("model", facts["model"]),
                ("pages", f"{result.pages_written} written, {result.pages_equal} were equal already"),
                ("old program", result.safety_backup or "not saved"),
                ("took", spent(pace.passed_s)),
            ]
        )
    if not dry_run:
        yield f"the PLC is in {result.mode_after.upper()}"


def _go_on(connection: Connection, *places: Path | None) -> str:
    """The one command that finishes an unfinished restore: the same again, for the pages that are left.

    Args:
        connection: the target.
        places: paths that are made whole, for a command that may be given in another folder.
    """
    context = click.get_current_context()
    whole = {str(place): str(place.absolute()) for place in places if place is not None}
    words = [whole.get(word, word) for word in context.find_root().obj if word != "--changed-only"]
    at = words.index("restore") + 1
    if context.get_parameter_source("port") is ParameterSource.ENVIRONMENT:
        words[at:at] = ["-p", connection.address.target]
    words[at:at] = ["--changed-only"]
    return shlex.join(["fatektool", *words])
