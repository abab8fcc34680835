"""``inventory check``: the faults of the inventory and of the files that it names."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.many.inventory.documents import check_document
from fatektool.cli.shared.inventory_file import inventory_option
from fatektool.cli.shared.options import voice_options
from fatektool.counts import counted
from fatektool.errors import FatektoolError
from fatektool.inventory.entries import InventoryFault
from fatektool.inventory.find import inventory_path, no_inventory
from fatektool.inventory.load import load_inventory

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.inventory.entries import Inventory


@click.command("check", epilog="Example: fatektool inventory check --inventory fatek.toml")
@inventory_option
@voice_options
def check_command(inventory: Path | None, voice: Voice) -> int:
    """Check the inventory, and print its faults.

    Exit 0 if there is no fault, 1 if there is one.
    """
    path = inventory_path(inventory)
    if path is None:
        raise no_inventory()
    found = load_inventory(path)
    found.faults += _faults_of_files(found)
    document = check_document(path, found)
    lines = [f"{path}: {fault}" for fault in found.faults]
    voice.show(document, lines or [f"{path}: {counted(len(found.plcs), 'PLC')}, no faults"])
    return 1 if found.faults else 0


def _faults_of_files(found: Inventory) -> Iterator[InventoryFault]:
    """The faults of the files that the inventory names; each file is checked once."""
    from fatektool.jobs.snapshots.spec import load_spec
    from fatektool.project.program_file import load_program

    seen: set[Path] = set()
    for entry in found.plcs.values():
        for key, path in (("spec", entry.spec), ("reference", entry.reference), ("project", entry.project)):
            if path is None or path in seen:
                continue
            seen.add(path)
            try:
                if key == "spec":
                    load_spec(path)
                else:
                    load_program(path)
            except FatektoolError as error:
                yield InventoryFault(None, f"plc.{entry.name}: {key}: {error.message}")
