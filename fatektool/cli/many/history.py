"""``history``: each version of the programs of many PLCs, in a git repository."""

from __future__ import annotations

from contextlib import closing
from functools import wraps
from itertools import chain, islice
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.many.history_documents import (
    check_document,
    check_lines,
    export_document,
    log_document,
    log_line,
    record_document,
    record_rows,
    show_document,
)
from fatektool.cli.programs.differences import change_lines, show_differences
from fatektool.cli.programs.file_view import backup_rows
from fatektool.cli.shared.file_path import is_standard
from fatektool.cli.shared.image_words import warn_of_image
from fatektool.cli.shared.options import PATH, Seconds, voice_options
from fatektool.cli.shared.output import table
from fatektool.cli.shared.pairs import together
from fatektool.cli.shared.report import report_option
from fatektool.cli.shared.streams import print_bytes
from fatektool.errors import PushFailed, UsageError
from fatektool.files.atomic import require_place
from fatektool.files.times import utc
from fatektool.history.checking import check
from fatektool.history.history import History
from fatektool.program.archive import load_backup
from fatektool.project.comparison import compare_programs

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.cli.shared.output import Voice

F = TypeVar("F", bound="Callable[..., Any]")


def history_option(function: F) -> F:
    """``--history DIR``; the command gets ``history``."""

    @click.option(
        "--history",
        "folder",
        type=PATH,
        metavar="DIR",
        envvar="FATEKTOOL_HISTORY",
        help="The git repository.  [env: FATEKTOOL_HISTORY]",
    )
    @wraps(function)
    def with_history(*args: Any, folder: Path | None, **rest: Any) -> Any:
        if folder is None:
            raise UsageError("no history is given", hint="give --history DIR or set FATEKTOOL_HISTORY")
        return function(*args, folder=folder, **rest)

    return with_history  # type: ignore[return-value]  # click's decorators hand back what they get


@click.group("history", epilog="Example: fatektool history log press-3 --history plc-history")
def history_command() -> None:
    """Keep each version of the programs in a git repository: a file for each PLC, a commit for each change.

    'fleet backup --history DIR' and 'history record' write it. Any git can read it: 'git log -p'.

    A revision REV is a hash (a1b2c3d), HEAD~2, a date or time in UTC (2026-11-22: the last commit of that day
    or before), or ~1: the program of this PLC before its last change; ~2: the one before that.
    """


@history_command.command(
    "record", epilog="Example: fatektool history record press-3 press.json --history plc-history"
)
@click.argument("name")
@click.argument("file", type=PATH)
@click.option(
    "--push",
    "remote",
    metavar="REMOTE",
    help="Then push to REMOTE: a folder, ssh://, https://, host:path, a git remote.",
)
@click.option(
    "--lock-wait",
    type=Seconds(0, 86400),
    default=60.0,
    show_default=True,
    metavar="S",
    help="How long to wait for another process that writes the history.",
)
@history_option
@voice_options
def record_command(
    name: str, file: Path, folder: Path, voice: Voice, *, remote: str | None, lock_wait: float
) -> None:
    """Record the backup FILE for the PLC NAME, if the program changed. DIR is created if it is missing."""
    backup = load_backup(file)
    found = History(folder, wait_s=lock_wait, waiting=voice.say).record(name, backup)
    for warning in found.warnings:
        voice.warn(warning)
    pushed = None
    if remote is not None:
        from fatektool.history.push import push

        try:
            pushed = push(folder, remote)
        except PushFailed as error:
            error.details["recorded"] = found.revision
            if not voice.json:
                voice.show({}, table(record_rows(found, folder, None)))
            raise
    voice.show(record_document(found, backup, folder, pushed), table(record_rows(found, folder, pushed)))


@history_command.command("log", epilog="Example: fatektool history log press-3 --history plc-history -n 10")
@click.argument("name", required=False)
@click.option("-n", "--limit", type=click.IntRange(1), metavar="N", help="Only the newest N changes.")
@history_option
@voice_options
def log_command(name: str | None, folder: Path, voice: Voice, *, limit: int | None) -> None:
    """List the changes of the PLC NAME, or of all PLCs, newest first."""
    with closing(History(folder).log(name)) as changes:
        found = list(islice(changes, limit))
        more = next(changes, None) is not None
    if not found:
        voice.say(f"no program is recorded in {folder} yet")
    voice.show(log_document(found, folder, name, more=more), map(log_line, found))


@history_command.command(
    "show", epilog="Example: fatektool history show press-3@2026-11-22 --history plc-history"
)
@click.argument("which", metavar="NAME[@REV]")
@history_option
@voice_options
def show_command(which: str, folder: Path, voice: Voice) -> None:
    """Show the newest backup of a PLC, or that of a revision, as 'inspect' does; then what changed."""
    history = History(folder)
    found = history.show(*_parted(which))
    before = history.before(found)
    changes = None if before is None else compare_programs(before.program, found.backup.program).networks
    warn_of_image(found.backup.program, voice)
    rows = [
        ("recorded", f"{utc(found.commit.time)}: {found.commit.subject}"),
        *backup_rows(found.backup, found.label),
    ]
    voice.show(show_document(found, folder, changes), chain(table(rows), change_lines(changes or ())))


@history_command.command(
    "diff", epilog="Example: fatektool history diff press-3 2026-11-01 --history plc-history"
)
@click.argument("name")
@click.argument("a", required=False, default="~1")
@click.argument("b", required=False, default="HEAD")
@report_option
@history_option
@voice_options
def diff_command(name: str, a: str, b: str, folder: Path, voice: Voice, *, report: Path | None) -> int:
    """Compare the program of a PLC at two revisions: exit 0 if it is the same, 1 if not.

    B defaults to the newest revision, A to the one before the last change.
    """
    history = History(folder)
    one, other = history.show(name, a), history.show(name, b)
    old, new = one.backup.program, other.backup.program
    sides = (one.label, old.sha256), (other.label, new.sha256)
    return show_differences(*sides, compare_programs(old, new), voice, report)


@history_command.command("check", epilog="Example: fatektool history check --history plc-history")
@history_option
@voice_options
def check_command(folder: Path, voice: Voice) -> int:
    """Check every object and every backup of the history: exit 0 if none is damaged, 1 if one is."""
    with voice.progress("commits") as bar:
        found = check(folder, bar.update)
    voice.show(check_document(found, folder), check_lines(found))
    return 1 if found.faults else 0


@history_command.command(
    "export", epilog="Example: fatektool history export press-3@~1 before.json --history plc-history"
)
@click.argument("which", metavar="NAME[@REV]")
@click.argument("file", type=PATH)
@click.option("--force", is_flag=True, help="Replace FILE if it exists.")
@history_option
@voice_options
def export_command(which: str, file: Path, folder: Path, voice: Voice, *, force: bool) -> None:
    """Write a backup to FILE for 'restore': the newest of a PLC, or a revision's. - is standard output."""
    name, revision = _parted(which)
    history = History(folder)
    together("force", holds=not is_standard(file), needs="a file")
    if is_standard(file):
        print_bytes(history.show(name, revision).data)
        return
    require_place(file, overwrite=force)
    found = history.export(name, revision, file, overwrite=force)
    rows = [
        ("saved", file),
        ("revision", f"{found.label}, recorded {utc(found.commit.time)}"),
        ("read", found.backup.created),
        ("sha256", found.backup.program.sha256),
    ]
    voice.show(export_document(found, folder, file), table(rows))


def _parted(which: str) -> tuple[str, str]:
    name, at, revision = which.partition("@")
    if at and not revision:
        raise UsageError(f"{which}: expected a revision after the @, such as {name}@~1 or {name}@2026-11-22")
    return name, revision or "HEAD"
