"""``history record``: record a backup."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.many.history.documents import (
    record_document,
)
from fatektool.cli.many.history.options import history_option
from fatektool.cli.shared.options import PATH, SecondsType, completing, voice_options
from fatektool.cli.shared.output import table
from fatektool.errors import PushFailed
from fatektool.history.history import History
from fatektool.program.archive import load_backup

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.history.history import RecordResult
    from fatektool.history.push import Pushed


@click.command("record", epilog="Example: fatektool history record press-3 press.json --history plc-history")
@click.argument("name", shell_complete=completing("complete_history"))
@click.argument("file", type=PATH)
@click.option(
    "--push",
    "remote",
    metavar="REMOTE",
    help="Then push to REMOTE: a folder, ssh://, https://, host:path, a git remote.",
)
@click.option(
    "--lock-wait",
    type=SecondsType(0, 86400),
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
    """Record a backup, if the program changed.

    FILE is the backup, NAME the PLC. DIR is created if it does not exist.
    """
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
                voice.show({}, table(_rows(found, folder, None)))
            raise
    voice.show(record_document(found, backup, folder, pushed), table(_rows(found, folder, pushed)))


def _rows(found: RecordResult, folder: Path, pushed: Pushed | None) -> Iterator[tuple[str, object]]:
    """The result of a recording."""
    if found.revision is None:
        yield "unchanged", f"{found.name}: the newest program in {folder} is the same"
    else:
        yield "recorded", found.subject
        yield "revision", found.revision
    if pushed is not None:
        yield "pushed", pushed.remote if pushed.sent else f"{pushed.remote} is up to date"
