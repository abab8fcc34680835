"""``history export``: write a recorded backup to a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.many.history.documents import (
    export_document,
)
from fatektool.cli.many.history.options import history_option, name_and_revision
from fatektool.cli.shared.options import PATH, completing, is_standard, voice_options
from fatektool.cli.shared.output import shown_time, table
from fatektool.cli.shared.pairs import together
from fatektool.cli.shared.streams import print_bytes
from fatektool.files.atomic import require_place
from fatektool.files.times import utc
from fatektool.history.history import History

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.output import Voice


@click.command(
    "export", epilog="Example: fatektool history export press-3@~1 before.json --history plc-history"
)
@click.argument("which", shell_complete=completing("complete_history"), metavar="NAME[@REV]")
@click.argument("file", type=PATH)
@click.option("--force", is_flag=True, help="Replace FILE if it exists.")
@history_option
@voice_options
def export_command(which: str, file: Path, folder: Path, voice: Voice, *, force: bool) -> None:
    """Write a recorded backup to FILE, for 'restore'.

    It is the newest one of the PLC NAME, or that of the revision REV. - is standard output.
    """
    name, revision = name_and_revision(which)
    history = History(folder)
    together("force", holds=not is_standard(file), needs="a file")
    if is_standard(file):
        print_bytes(history.show(name, revision).data)
        return
    require_place(file, overwrite=force)
    found = history.export(name, revision, file, overwrite=force)
    rows = [
        ("saved", file),
        ("revision", f"{found.label}, recorded {shown_time(utc(found.commit.time))}"),
        ("read", shown_time(found.backup.created)),
        ("sha256", found.backup.program.sha256),
    ]
    voice.show(export_document(found, folder, file), table(rows))
