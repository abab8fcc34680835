"""``backup``: a PLC's program into a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.data_view import data_rows, warn_of_data
from fatektool.cli.programs.documents import saved_document
from fatektool.cli.programs.raw_file import require_raw_name
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.image_words import warn_of_image
from fatektool.cli.shared.options import PATH, is_standard
from fatektool.cli.shared.output import Voice, passed, table
from fatektool.cli.shared.pairs import apart, together
from fatektool.cli.shared.streams import print_bytes
from fatektool.counts import counted
from fatektool.errors import FatektoolError, PlcError
from fatektool.files.atomic import require_place, write_whole
from fatektool.files.times import stamp, utc
from fatektool.jobs.programs.backup import read_backup
from fatektool.jobs.programs.known import first_known, known_in
from fatektool.program.archive import Backup, save_backup
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from fatektool.cli.shared.connection import Connection


@click.command("backup", epilog="Example: fatektool backup press-3.json -p sim: -s 3")
@click.argument("file", required=False, type=PATH)
@click.option(
    "--data",
    is_flag=True,
    help="Save registers, relays, disabled discretes, ports too.",
)
@click.option("--force", is_flag=True, help="Replace FILE if it exists.")
@click.option("--single-pass", is_flag=True, help="Read once instead of twice; nothing is compared.")
@click.option(
    "--known",
    type=PATH,
    metavar="FILE",
    help="A backup of this PLC: equal pages are read once.  [default: the FILE that --force replaces]",
)
@click.option("--any-header", is_flag=True, help="Keep an image with an invalid header, and mark it.")
@click.option("--raw", type=PATH, metavar="FILE.bin", help="Also write the pages, as binary.")
@connection_options
def backup_command(
    connection: Connection,
    voice: Voice,
    *,
    file: Path | None,
    data: bool,
    force: bool,
    single_pass: bool,
    known: Path | None,
    any_header: bool,
    raw: Path | None,
) -> int:
    """Read the PLC's program into FILE, with --data also its data.

    Every page is read twice and compared, or once if it is as on file; the header is checked. FILE is written
    completely or not at all; its default name has station and time; - is standard output. The PLC can be in
    RUN.
    """
    path = file or Path(f"fatek-st{connection.address.station:02}-{stamp(utc())}.json")
    together("force", holds=not is_standard(path) or raw is not None, needs="a file")
    require_raw_name(raw, path)
    for place in (path, raw):
        if place is not None and not is_standard(place):
            require_place(place, overwrite=force)
    apart("known", "single_pass")
    former = None if is_standard(path) else path
    reference = None if connection.entry is None else connection.entry.reference
    pages = first_known((former, reference), voice.detail) if known is None else known_in(known)
    with connection.open(voice, needs=(Command.READ_PAGE,)) as plc, voice.progress() as bar:
        result = read_backup(
            plc, single_pass=single_pass, any_header=any_header, known=pages, data=data, progress=bar.update
        )
        counters = plc.link.counters
    found = result.backup
    voice.detail(f"line: {counters}")
    warn_of_image(found.program, voice)
    code = 0
    if found.data is not None and found.data.errors:
        warn_of_data(found.data, voice)
        code = PlcError.exit_code
    if not is_standard(path):
        save_backup(found, path, overwrite=force)
    if raw is not None:
        _write_raw(raw, found, path, overwrite=force)
    if is_standard(path):
        print_bytes(found.to_bytes())
        return code
    program = found.program
    size = f"{counted(program.ladder_words, 'word')}, {counted(len(program.pages), 'page')}"
    rows: list[tuple[str, object]] = [
        ("saved", path),
        ("program", f"{program.header.text()}, {size}"),
        ("pages", found.proof_words),
        ("sha256", program.sha256),
        *data_rows(found.data),
        ("took", passed(plc, result.duration_s)),
    ]
    voice.show(saved_document(result, path), table(rows))
    return code


def _write_raw(raw: Path, found: Backup, path: Path, *, overwrite: bool) -> None:
    """Write the bare pages, after the backup: what fails here takes nothing from that."""
    try:
        write_whole(raw, found.program.data, overwrite=overwrite)
    except FatektoolError as error:
        if not is_standard(path):
            error.message = f"{path} is saved, but its binary pages are not: {error.message}"
        raise
