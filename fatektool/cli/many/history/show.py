"""``history show``: a PLC's program at a revision."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

import click

from fatektool.cli.many.history.documents import (
    show_document,
)
from fatektool.cli.many.history.options import history_option, name_and_revision
from fatektool.cli.programs.differences import change_lines
from fatektool.cli.programs.file_view import backup_rows
from fatektool.cli.shared.image_words import warn_of_image
from fatektool.cli.shared.options import completing, voice_options
from fatektool.cli.shared.output import shown_time, table
from fatektool.files.times import utc
from fatektool.history.history import History
from fatektool.project.comparison import compare_programs

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.output import Voice


@click.command("show", epilog="Example: fatektool history show press-3@~1 --history plc-history")
@click.argument("which", shell_complete=completing("complete_history"), metavar="NAME[@REV]")
@history_option
@voice_options
def show_command(which: str, folder: Path, voice: Voice) -> None:
    """Show a recorded backup, and what changed.

    It is the newest one of the PLC NAME, or that of the revision REV.
    """
    history = History(folder)
    found = history.show(*name_and_revision(which))
    before = history.before(found)
    changes = None if before is None else compare_programs(before.program, found.backup.program).networks
    warn_of_image(found.backup.program, voice)
    rows = [
        ("recorded", f"{shown_time(utc(found.commit.time))}: {found.commit.subject}"),
        *backup_rows(found.backup, found.label),
    ]
    voice.show(show_document(found, folder, changes), chain(table(rows), change_lines(changes or ())))
