"""``history log``: the changes, newest first."""

from __future__ import annotations

from contextlib import closing
from itertools import islice
from typing import TYPE_CHECKING

import click

from fatektool.cli.many.history.documents import (
    log_document,
)
from fatektool.cli.many.history.options import history_option
from fatektool.cli.shared.options import completing, voice_options
from fatektool.cli.shared.output import shown_time
from fatektool.files.times import utc
from fatektool.history.history import History
from fatektool.history.revisions import SHORT

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.history.history import LogEntry


@click.command("log", epilog="Example: fatektool history log press-3 --history plc-history -n 10")
@click.argument("name", shell_complete=completing("complete_history"), required=False)
@click.option("-n", "--limit", type=click.IntRange(1), metavar="N", help="Only the newest N changes.")
@history_option
@voice_options
def log_command(name: str | None, folder: Path, voice: Voice, *, limit: int | None) -> None:
    """List the changes, newest first: of the PLC NAME, or of all."""
    with closing(History(folder).log(name)) as changes:
        found = list(islice(changes, limit))
        more = next(changes, None) is not None
    if not found:
        voice.say(f"no program is recorded in {folder} yet")
    voice.show(log_document(found, folder, name, more=more), map(_line, found))


def _line(change: LogEntry) -> str:
    """One change; the PLC's name is put before the subject of a commit that fatektool did not make."""
    subject = change.commit.subject
    named = subject if subject.startswith(f"{change.name}: ") else f"{change.name}: {subject}"
    removed = " (removed)" if change.removed else ""
    return f"{change.commit.revision[:SHORT]}  {shown_time(utc(change.commit.time))}  {named}{removed}"
