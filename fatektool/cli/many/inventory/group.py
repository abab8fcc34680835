"""``inventory``: the file with the names and settings of the PLCs."""

from __future__ import annotations

import click

from fatektool.cli.shared.lazy_group import LazyGroup, Subcommand, commands


@click.group(
    "inventory",
    cls=LazyGroup,
    sections=commands(
        check=Subcommand("many.inventory.check", "Check the inventory, and print its faults."),
        list=Subcommand("many.inventory.list", "List the PLCs and their settings."),
        add=Subcommand("many.inventory.add", "Add a PLC, or all that a scan found."),
    ),
    epilog="Example: fatektool inventory add press -p tcp://192.168.2.3 --tag night",
)
def inventory_command() -> None:
    """Check, list and extend the inventory: the TOML file that names your PLCs.

    All commands take a name of the inventory as a target: 'fatektool status -p NAME'.
    """
