"""``inspect``: what a backup holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.backup import require_raw_name
from fatektool.cli.documents import inspect_document
from fatektool.cli.image_words import warn_of_image
from fatektool.cli.options import PATH, voice_options
from fatektool.cli.output import Voice, table
from fatektool.cli.pairs import together
from fatektool.program.archive import load_backup
from fatektool.program.files import write_whole

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.program.archive import Backup
    from fatektool.program.headers.header import Sum


@click.command("inspect", epilog="Example: fatektool inspect press.json --raw press.bin")
@click.argument("file", type=PATH)
@click.option("--raw", type=PATH, metavar="FILE.bin", help="Write the bare pages.")
@click.option("--force", is_flag=True, help="Replace FILE.bin if it exists.")
@voice_options
def inspect_command(file: Path, voice: Voice, *, raw: Path | None, force: bool) -> None:
    """Show and check what the backup FILE holds. Needs no PLC."""
    together("force", holds=raw is not None, needs="--raw")
    require_raw_name(raw, file)
    found = load_backup(file)
    warn_of_image(found.program, voice)
    if raw is not None:
        write_whole(raw, found.program.data, overwrite=force)
        voice.say(f"{len(found.program.data)} bytes written to {raw}")
    voice.show(inspect_document(found, file), table(backup_rows(found, str(file))))


def backup_rows(found: Backup, file: str) -> Iterator[tuple[str, object]]:
    """What a backup holds, as rows; ``file`` is what it is called."""
    program, source = found.program, found.source
    used = sum(page != b"\xff" * len(page) for page in program.pages[1:])
    status = found.plc["status"]
    yield "file", f"{file}: whole, hash and header checked"
    yield "created", f"{found.created} by {found.tool}"
    yield (
        "source",
        f"station {source.station} on {source.target}, {source.protocol}, {source.line or 'no line'}",
    )
    yield "PLC then", "RUN" if status.get("running") else "STOP"
    header = program.header
    yield "header", header.text()
    if header.checksum is not None:
        yield "checksum", _sum_words(header.checksum)
    yield "ladder size", f"{program.ladder_words} words, {len(program.pages)} pages, {used} not empty"
    yield "passes", f"{found.passes}, equal" if found.passes > 1 else "1, not compared"
    yield "sha256", program.sha256


def _sum_words(found: Sum) -> str:
    if found.valid:
        return f"{found.stored:04X}, holds"
    computed = "not to be computed" if found.computed is None else f"the code's is {found.computed:04X}"
    return f"{found.stored:04X}, DOES NOT HOLD: {computed}"
