"""``read``: elements of any kind."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

from fatektool.cli.elements.documents import read_document
from fatektool.cli.elements.values import SELECTION, value_lines, warn_of
from fatektool.cli.programs.program_files import comments_for, comments_options
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.modbus_map import modbus_map_option
from fatektool.cli.shared.options import completing
from fatektool.cli.shared.output import elements_bar
from fatektool.errors import PlcError
from fatektool.jobs.elements.items import comments_of, read_items
from fatektool.jobs.elements.selection import parse_items

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.elements.items import ItemValues


@click.command(
    "read", epilog="Example: fatektool read R12:3 WM8 DR2 Y0-Y7 X16 D4:f32 -p sim:", help=(
        "Read elements of any kind. On a terminal neighbours are shown together: R0-R99 as a grid, X0-X31 as "
        f"bits.\n\n{SELECTION}"
    ),
)  # fmt: skip
@click.argument("elements", nargs=-1, shell_complete=completing("complete_elements"), required=True)
@comments_options
@connection_options
@modbus_map_option
def read_command(
    elements: tuple[str, ...],
    connection: Connection,
    voice: Voice,
    *,
    comments: Path | None,
    encoding: str | None,
) -> int:
    """Read elements of any kind."""
    items = parse_items(elements)
    texts = comments_of(items, comments_for(connection, comments, voice, encoding))
    with connection.open(voice) as plc, elements_bar(voice, items) as bar:
        found = read_items(plc, items, bar.update)
        document = read_document(plc, found, texts)
    voice.show(document, _lines(found, texts))
    warn_of(found.errors, voice, found.not_asked)
    return PlcError.exit_code if found.errors else 0


def _lines(found: ItemValues, texts: Mapping[str, str]) -> Iterator[str]:
    """Neighbours together on a terminal, else a value on each line."""
    if not sys.stdout.isatty():
        return value_lines(found.values, texts)
    from shutil import get_terminal_size

    from fatektool.cli.elements.grid import terminal_lines

    return terminal_lines(found, texts, get_terminal_size().columns)
