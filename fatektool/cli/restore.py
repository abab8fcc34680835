"""``restore``: a backup's program into a PLC."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from fatektool.cli.documents import restore_document
from fatektool.cli.image_words import warn_of_image
from fatektool.cli.options import PATH, Connection, connection_options, yes_option
from fatektool.cli.output import Bar, Voice, can_ask, table
from fatektool.cli.pairs import apart
from fatektool.errors import RestoreIncomplete, UsageError
from fatektool.jobs.restore import (
    RestoreOptions,
    RestorePlan,
    RestoreResult,
    carry_out,
    keep_way_back,
    plan_restore,
)
from fatektool.program.archive import LARGEST_FILE, Backup
from fatektool.program.files import read_bounded, require_folder
from fatektool.program.image import ranges
from fatektool.project.records import is_project
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


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
    folder = None if no_safety_backup else require_folder(safety_dir or file.parent)
    options = RestoreOptions(stop, run, changed_only, rollback, any_header, single_pass)
    with (
        connection.open(voice, needs=(Command.READ_PAGE, Command.WRITE_PAGE), writes=not dry_run) as plc,
        voice.progress() as bar,
    ):
        clock = plc.link.transport.clock
        began = clock()
        plan = plan_restore(plc, backup, options, progress=bar.update)
        warn_of_image(backup.program, voice)
        for warning in plan.warnings:
            voice.warn(warning)
        if dry_run:
            result = _nothing_done(plan)
        else:
            kept = _agree(plan, file, folder, voice, bar, yes=yes)
            try:
                result = carry_out(plc, plan, kept, progress=bar.update)
            except RestoreIncomplete as error:
                command = _go_on(connection)
                error.details["command"] = command
                error.hint = f"mend the cause, then: {command}"
                raise
            for warning in result.warnings[len(plan.warnings) :]:
                voice.warn(warning)
        duration_s = clock() - began
        document = restore_document(
            plc, file, result, dry_run=dry_run, pages_to_write=len(plan.pages), duration_s=duration_s
        )
    voice.show(document, _lines(plan, result, file, dry_run=dry_run, way_back=folder is not None))


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


def _agree(
    plan: RestorePlan, file: Path, folder: Path | None, voice: Voice, bar: Bar, *, yes: bool
) -> str | None:
    """Save the old program, show the plan, ask; give where the old program lies."""
    will_run = plan.options.run and not plan.running
    if not plan.pages and not will_run:
        return None
    bar.pause()  # while it is shown, stderr is rich's, which older versions say is no terminal
    if not yes and not can_ask():
        raise UsageError(
            "a restore needs a confirmation, and there is no terminal to ask on: nothing was written",
            hint="add --yes",
        )
    kept = None
    if plan.pages:
        kept = None if folder is None else str(keep_way_back(plan, file, folder))
        for line in _plan_lines(plan, kept):
            voice.say(line)
        question = "Write the program into the PLC?"
    else:
        question = "The PLC holds the program on file already. RUN?"
    if not voice.confirm(question, yes=yes):
        raise UsageError("not agreed to: the PLC's program is unchanged")
    bar.go_on()
    return kept


def _plan_lines(plan: RestorePlan, kept: str | None) -> Iterator[str]:
    differ = plan.comparison.page_numbers
    yield f"The PLC's program differs in page {ranges(differ)} ({plan.comparison.word_count} words)."
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
    plan: RestorePlan, result: RestoreResult, file: Path, *, dry_run: bool, way_back: bool
) -> Iterator[str]:
    if plan.comparison.same:
        yield f"same: the PLC's program is the one in {file} already; nothing was written"
    elif dry_run:
        yield from _plan_lines(plan, "a safety backup before the first page is written" if way_back else None)
        yield "dry run: nothing was written"
    else:
        rows = [
            ("restored", f"{file}, read back and proven"),
            ("pages", f"{result.pages_written} written, {result.pages_equal} were equal already"),
            ("old program", result.safety_backup or "not saved"),
        ]
        yield from table(rows)
    if not dry_run:
        yield f"the PLC is in {result.mode_after.upper()}"


def _go_on(connection: Connection) -> str:
    """The one command that finishes an unfinished restore: the same again, for the pages that are left."""
    context = click.get_current_context()
    words = [word for word in context.find_root().obj if word != "--changed-only"]
    at = words.index("restore") + 1
    if context.get_parameter_source("port") is ParameterSource.ENVIRONMENT:
        words[at:at] = ["-p", connection.target]
    words[at:at] = ["--changed-only"]
    return shlex.join(["fatektool", *words])
