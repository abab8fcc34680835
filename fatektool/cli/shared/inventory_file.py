"""The inventory on the command line: which file it is, and names as targets."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.shared.options import PATH, ConnectionOption
from fatektool.errors import FatektoolError
from fatektool.inventory.find import FILE_NAME, VARIABLE, inventory_path, no_inventory, whole_inventory

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from click.shell_completion import CompletionItem

    from fatektool.inventory.entries import Inventory, PlcEntry

F = TypeVar("F", bound="Callable[..., Any]")

inventory_option = click.option(
    "--inventory",
    cls=ConnectionOption,
    type=PATH,
    envvar=VARIABLE,
    metavar="FILE.toml",
    help=f"The file with the names of PLCs.  [default: ./{FILE_NAME}, then your configuration folder]  "
    f"[env: {VARIABLE}]",
)


def open_inventory(named: Path | None) -> Inventory:
    """Read the inventory, which must have no faults.

    Raises:
        UsageError: there is none.
        DataError: it has faults.
    """
    path = inventory_path(named)
    if path is None:
        raise no_inventory()
    return whole_inventory(path)


def complete_target(context: click.Context, _: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Completion: names that begin with this; else files, because a port is a file on most systems."""
    from pathlib import Path

    from click.shell_completion import CompletionItem

    named = context.params.get("inventory") or os.environ.get(VARIABLE)
    names = complete_names(None if named is None else Path(named), incomplete)
    return names or [CompletionItem(incomplete, type="file")]


def complete_names(named: Path | None, incomplete: str) -> list[CompletionItem]:
    """Completion: names that begin with this, with their targets; none if the inventory cannot be read."""
    return _beginning(_names(_plcs(named)), incomplete)


def complete_selection(context: click.Context, _: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """The same of the inventory of a command, and tags with the names of their PLCs."""
    plcs = _plcs(context.params.get("inventory"))
    tags: dict[str, list[str]] = {}
    for entry in plcs:
        for tag in entry.tags:
            tags.setdefault(tag, []).append(entry.name)
    return _beginning({tag: f"tag of {', '.join(of)}" for tag, of in tags.items()} | _names(plcs), incomplete)


select_option = click.option(
    "--select",
    "words",
    multiple=True,
    metavar="NAME|TAG|GLOB",
    shell_complete=complete_selection,
    help="Only these PLCs; repeat for more.  [default: all]",
)
"""For a command of many PLCs; it gets ``words``, for ``fatektool.inventory.select``."""


def _names(plcs: Iterable[PlcEntry]) -> dict[str, str]:
    return {entry.name: f"{entry.address.target}, station {entry.address.station}" for entry in plcs}


def _beginning(words: dict[str, str], incomplete: str) -> list[CompletionItem]:
    from click.shell_completion import CompletionItem

    return [CompletionItem(word, help=said) for word, said in words.items() if word.startswith(incomplete)]


def _plcs(named: Path | None) -> list[PlcEntry]:
    from fatektool.inventory.load import load_inventory

    try:
        path = inventory_path(named)
        return [] if path is None else list(load_inventory(path).plcs.values())
    except FatektoolError:  # completion shows no messages; the command will
        return []
