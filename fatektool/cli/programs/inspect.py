"""``inspect``: the contents of a backup or a project."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.documents import inspect_document
from fatektool.cli.programs.file_view import backup_rows, project_rows
from fatektool.cli.programs.program_files import (
    encoding_option,
    program_file,
    require_comments,
    warn_of_program,
)
from fatektool.cli.programs.raw_file import require_raw_name
from fatektool.cli.shared.options import PATH, voice_options
from fatektool.cli.shared.output import Voice, table
from fatektool.cli.shared.pairs import together
from fatektool.counts import counted
from fatektool.files.atomic import write_whole

if TYPE_CHECKING:
    from pathlib import Path


@click.command("inspect", epilog="Example: fatektool inspect press.json --raw press.bin")
@click.argument("file", type=PATH)
@click.option("--raw", type=PATH, metavar="FILE.bin", help="Write the pages, as binary.")
@click.option("--force", is_flag=True, help="Replace FILE.bin if it exists.")
@encoding_option
@voice_options
def inspect_command(file: Path, voice: Voice, *, raw: Path | None, force: bool, encoding: str | None) -> None:
    """Show and check the contents of FILE, a backup or a WinProladder project. Needs no PLC."""
    together("force", holds=raw is not None, needs="--raw")
    require_raw_name(raw, file)
    on_file = program_file(file, voice, encoding)
    require_comments(None, on_file)
    found = on_file.backup
    warn_of_program(on_file, voice)
    data = on_file.program.data if on_file.project is None else on_file.project.memory.image
    if raw is not None:
        write_whole(raw, data, overwrite=force)
        voice.say(f"{counted(len(data), 'byte')} written to {raw}")
    rows = project_rows(on_file) if found is None else backup_rows(found, str(file))
    voice.show(inspect_document(on_file), table(rows))
