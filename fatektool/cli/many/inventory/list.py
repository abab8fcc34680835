"""``inventory list``: the PLCs and their settings."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.many.inventory.documents import inventory_document
from fatektool.cli.shared.inventory_file import inventory_option, open_inventory, select_option
from fatektool.cli.shared.options import voice_options
from fatektool.inventory.select import select

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.inventory.entries import PlcEntry


_HEAD = ("name", "target", "station", "protocol", "tags")


@click.command("list", epilog="Example: fatektool inventory list --select hall")
@select_option
@inventory_option
@voice_options
def list_command(inventory: Path | None, words: tuple[str, ...], voice: Voice) -> None:
    """List the PLCs of the inventory with their settings."""
    found = open_inventory(inventory)
    entries = select(found, words)
    document = inventory_document(found, entries)
    voice.show(document, _rows(entries))


def _rows(entries: list[PlcEntry]) -> Iterator[str]:
    rows = [
        (entry.name, entry.address.target, str(entry.address.station), entry.address.protocol)
        for entry in entries
    ]
    lines = [_HEAD, *((*row, ", ".join(entry.tags)) for row, entry in zip(rows, entries, strict=True))]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    for line in lines:
        yield "  ".join(f"{cell:<{width}}" for cell, width in zip(line, widths, strict=True)).rstrip()
