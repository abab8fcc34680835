"""``fleet backup``: the programs of all PLCs, into files and a history."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.many.alarms import Alarms, alarm_options
from fatektool.cli.many.fleet.run import Orders, ended, fleet_options, news_option, opened, run_fleet
from fatektool.cli.many.outcome import JobResult
from fatektool.cli.programs.data_view import warn_of_data
from fatektool.cli.programs.documents import saved_document
from fatektool.cli.shared.image_words import warn_of_image
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.places import require_folder_for
from fatektool.errors import FatektoolError, PlcError, UsageError
from fatektool.jobs.programs.backup import read_backup
from fatektool.jobs.programs.known import KnownPages, first_known
from fatektool.jobs.programs.safekeeping import replace_backup, require_ladder
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.cli.shared.output import Voice
    from fatektool.history.history import History
    from fatektool.inventory.entries import PlcEntry
    from fatektool.jobs.fleet.rounds import Turn
    from fatektool.program.archive import Backup


@click.command("backup", epilog='Example: fatektool fleet backup --dir backups --on-failure "echo failed:"')
@click.option(
    "--dir",
    "folder",
    type=PATH,
    metavar="DIR",
    help="Write DIR/NAME.json for each PLC, in place of the previous one.  [default: 'backups' of the "
    "inventory]",
)
@click.option(
    "--history",
    type=PATH,
    metavar="DIR",
    envvar="FATEKTOOL_HISTORY",
    help="Record changes in a git repository.  [default: 'history' of the inventory]  "
    "[env: FATEKTOOL_HISTORY]",
)
@click.option("--push", "remote", metavar="REMOTE", help="Then push the history: a folder, ssh://, https://.")
@click.option("--data", is_flag=True, help="Save the data of the PLCs too, as 'backup --data' does.")
@click.option("--single-pass", is_flag=True, help="Read once instead of twice; nothing is compared.")
@click.option("--any-header", is_flag=True, help="Keep images with an invalid header, and mark them.")
@alarm_options(changes=True)
@news_option
@fleet_options
def backup_command(
    orders: Orders,
    alarms: Alarms,
    voice: Voice,
    *,
    folder: Path | None,
    history: Path | None,
    remote: str | None,
    data: bool,
    single_pass: bool,
    any_header: bool,
) -> int:
    """Back up the PLCs' programs.

    Each file is written completely or not at all: after a failure the previous backup is still there. An
    image without a program, where all bytes are the same, is a failure. 'fatektool history' shows the records
    of --history. With --data a change of data is one only if they ought to be constant: 'keep' of the
    inventory. A failed push is a warning, and exit 1.
    """
    folder, history = folder or orders.inventory.backups, history or orders.inventory.history
    if folder is None and history is None:
        raise UsageError(
            "no target for the backups",
            hint="give --dir DIR or --history DIR, or both; or 'backups' and 'history' in [defaults] of the "
            "inventory",
        )
    if remote is not None and history is None:
        raise UsageError("--push goes with --history DIR")
    if folder is not None:
        require_folder_for(folder, voice)
    with nullcontext() if history is None else _opened(history, voice) as kept:
        work = _work(voice, folder, kept, data=data, single_pass=single_pass, any_header=any_header)
        document, interrupted = run_fleet("backup", orders, alarms, voice, work)
    if history is not None and remote is not None and not interrupted:
        document["push"] = _push(history, remote, voice)
    code = ended("backup", document, voice, alarms, interrupted=interrupted)
    return code or int("error" in document.get("push", {}))


def _opened(folder: Path, voice: Voice) -> History:
    from fatektool.history.history import History

    return History(folder, waiting=voice.say)


def _push(history: Path, remote: str, voice: Voice) -> dict[str, Any]:
    """Push the history. If it fails, that is a warning: the backups are saved here in any case."""
    from fatektool.history.push import push

    if not history.exists():  # no PLC has given its program yet
        return {"remote": remote, "revision": None, "sent": False}
    try:
        pushed = push(history, remote)
    except FatektoolError as error:
        voice.warn(f"the history is not pushed: {error}")
        return {"remote": remote, "revision": None, "sent": False, "error": error.message}
    return {"remote": pushed.remote, "revision": pushed.revision, "sent": pushed.sent}


def _work(
    voice: Voice,
    folder: Path | None,
    history: History | None,
    *,
    data: bool,
    single_pass: bool,
    any_header: bool,
) -> Callable[[PlcEntry, Turn[JobResult]], JobResult]:
    """``fleet backup``.

    Args:
        voice: prints warnings.
        folder: where NAME.json is written; None for nowhere.
        history: records changes, open until all PLCs are done; None for none.
        data: as for ``backup``.
        single_pass: as for ``backup``.
        any_header: as for ``backup``.
    """
    kept_in = None if history is None else history.folder

    def work(entry: PlcEntry, turn: Turn[JobResult]) -> JobResult:
        own = voice.of(entry.name)
        known = None if single_pass else _known(entry, folder, history, own)
        with opened(entry, turn, voice, Command.READ_PAGE) as plc:
            found = read_backup(
                plc,
                single_pass=single_pass,
                any_header=any_header,
                known=known,
                data=data,
                progress=turn.progress,
            )
        program = found.backup.program
        require_ladder(program)
        warn_of_image(program, own)
        turn.progress("saving", 0, 0)
        changed = None
        path = None if folder is None else folder / f"{entry.name}.json"
        if path is not None:
            replaced = replace_backup(found.backup, path, entry.keep)
            changed = replaced.changed
            if replaced.damaged is not None:
                voice.warn(f"{replaced.damaged}: the file is replaced")
        if history is not None:
            changed = _record(history, entry, found.backup, own)
        document = saved_document(found, path or kept_in or Path())
        said = {None: "first backup", True: "CHANGED", False: "unchanged"}[changed]
        words = f"{said}, {program.header.text()}, {program.ladder_words} words"
        code = 0
        if found.backup.data is not None and found.backup.data.errors:
            warn_of_data(found.backup.data, own)
            code = PlcError.exit_code
        return JobResult(code, document, words, path or kept_in, changed)

    return work


def _known(entry: PlcEntry, folder: Path | None, history: History | None, voice: Voice) -> KnownPages | None:
    """What is on file of a PLC: the history's newest, the backup that is replaced, or the reference."""
    try:
        newest = None if history is None else history.newest(entry.name)
    except FatektoolError as error:
        voice.detail(error.message)  # it is said again when the backup is recorded
        newest = None
    if newest is not None:
        return KnownPages((newest.program,), f"{entry.name}@HEAD")
    former = None if folder is None else folder / f"{entry.name}.json"
    return first_known((former, entry.reference), voice.detail)


def _record(history: History, entry: PlcEntry, backup: Backup, voice: Voice) -> bool | None:
    """Keep a backup in the history; whether it is another than the one there, None for the first."""
    found = history.record(entry.name, backup, entry.keep)
    for warning in found.warnings:
        voice.warn(warning)
    return None if found.changes is None else found.revision is not None
