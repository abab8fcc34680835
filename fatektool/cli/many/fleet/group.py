"""``fleet``: the same with every PLC of the inventory, many at once."""

from __future__ import annotations

from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.many.alarms import Alarms, alarm_options
from fatektool.cli.many.fleet.check import check_command
from fatektool.cli.many.fleet.jobs import backup_work, snapshot_work, status_work, verify_work
from fatektool.cli.many.fleet.run import Orders, ended, fleet_options, news_option, run_fleet
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.places import require_folder_for
from fatektool.errors import FatektoolError, UsageError
from fatektool.jobs.snapshots.store import Keep

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.history.history import History


@click.group("fleet", epilog="Example: fatektool fleet backup --dir backups --jobs 8 --select night")
def fleet_command() -> None:
    """Do one thing with every PLC of the inventory, or with those of --select.

    PLCs on one line (one serial port, one gateway) are asked one after the other, lines side by side. Exit 0
    if all are well, 1 if some are not. With -q only what is not well or changed is told.
    """


@fleet_command.command("status", epilog="Example: fatektool fleet status --select hall-1")
@click.option("--brief", is_flag=True, help="The brief status (40) alone.")
@alarm_options(changes=False)
@news_option
@fleet_options
def status_command(orders: Orders, alarms: Alarms, voice: Voice, *, brief: bool) -> int:
    """Show how the PLCs are."""
    document, interrupted = run_fleet("status", orders, alarms, voice, status_work(voice, brief=brief))
    return ended("status", document, voice, alarms, interrupted=interrupted)


@fleet_command.command(
    "backup", epilog="Example: fatektool fleet backup --dir backups --on-failure send-alarm"
)
@click.option("--dir", "folder", type=PATH, help="Write DIR/NAME.json for each, in place of the one before.")
@click.option(
    "--history",
    type=PATH,
    metavar="DIR",
    envvar="FATEKTOOL_HISTORY",
    help="Keep what changed in a git repository.  [env: FATEKTOOL_HISTORY]",
)
@click.option("--push", "remote", metavar="REMOTE", help="Then push the history: a folder, ssh://, https://.")
@click.option("--single-pass", is_flag=True, help="Read once instead of twice; nothing is compared.")
@click.option("--any-header", is_flag=True, help="Keep images whose header does not hold, marked as such.")
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
    single_pass: bool,
    any_header: bool,
) -> int:
    """Back up the PLCs' programs.

    Each file is written whole or not at all: a backup that fails leaves the one before as it is. An image
    that has lost its program, one byte all over, is a failure. 'fatektool history' shows what --history
    keeps. A push that fails is warned of, and exit 1.
    """
    if folder is None and history is None:
        raise UsageError("no place for the backups", hint="give --dir DIR or --history DIR, or both")
    if remote is not None and history is None:
        raise UsageError("--push goes with --history DIR")
    if folder is not None:
        require_folder_for(folder, voice)
    with nullcontext() if history is None else _opened(history, voice) as kept:
        work = backup_work(voice, folder, kept, single_pass=single_pass, any_header=any_header)
        document, interrupted = run_fleet("backup", orders, alarms, voice, work)
    if history is not None and remote is not None and not interrupted:
        document["push"] = _push(history, remote, voice)
    code = ended("backup", document, voice, alarms, interrupted=interrupted)
    return code or int("error" in document.get("push", {}))


def _opened(folder: Path, voice: Voice) -> History:
    from fatektool.history.history import History

    return History(folder, waiting=voice.say)


def _push(history: Path, remote: str, voice: Voice) -> dict[str, Any]:
    """Push, and tell what became of it: the backups are kept here in any case."""
    from fatektool.history.push import push

    if not history.exists():  # no PLC has given its program yet
        return {"remote": remote, "revision": None, "sent": False}
    try:
        pushed = push(history, remote)
    except FatektoolError as error:
        voice.warn(f"the history is not pushed: {error}")
        return {"remote": remote, "revision": None, "sent": False, "error": error.message}
    return {"remote": pushed.remote, "revision": pushed.revision, "sent": pushed.sent}


@fleet_command.command("verify", epilog="Example: fatektool fleet verify --on-change 'mail-alarm the-team'")
@alarm_options(changes=True)
@news_option
@fleet_options
def verify_command(orders: Orders, alarms: Alarms, voice: Voice) -> int:
    """Compare each PLC's program with its reference, the backup that the inventory names."""
    document, interrupted = run_fleet("verify", orders, alarms, voice, verify_work(voice))
    return ended("verify", document, voice, alarms, interrupted=interrupted)


@fleet_command.command("snapshot", epilog="Example: fatektool fleet snapshot --dir snapshots --keep 30d")
@click.option("--dir", "folder", type=PATH, required=True, help="Write a dated file for each, in DIR/NAME/.")
@click.option("--keep", metavar="N|DAYSd", help="Keep N snapshots of each, or those of so many days.")
@alarm_options(changes=False)
@news_option
@fleet_options
def snapshot_command(orders: Orders, alarms: Alarms, voice: Voice, *, folder: Path, keep: str | None) -> int:
    """Read each PLC's data, as the specification says that the inventory names."""
    require_folder_for(folder, voice)
    kept = None if keep is None else Keep.parse(keep)
    document, interrupted = run_fleet("snapshot", orders, alarms, voice, snapshot_work(voice, folder, kept))
    return ended("snapshot", document, voice, alarms, interrupted=interrupted)


fleet_command.add_command(check_command)
