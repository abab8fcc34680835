"""``fleet``: the same with every PLC of the inventory, many at once."""

from __future__ import annotations

import click

from fatektool.cli.shared.lazy_group import LazyGroup, Subcommand, commands


@click.group(
    "fleet",
    cls=LazyGroup,
    sections=commands(
        status=Subcommand("many.fleet.status", "Show how the PLCs are."),
        backup=Subcommand("many.fleet.backup", "Back up the PLCs' programs."),
        verify=Subcommand("many.fleet.verify", "Compare each PLC's program with its reference."),
        snapshot=Subcommand("many.fleet.snapshot", "Read each PLC's data, by its specification."),
        check=Subcommand("many.fleet.check", "Check the PLCs as one monitoring plugin."),
    ),
    epilog="Example: fatektool fleet backup --dir backups --jobs 8 --select night",
)
def fleet_command() -> None:
    """Do one thing with every PLC of the inventory, or with those of --select.

    PLCs on one line (one serial port, one gateway) are asked one after the other, lines side by side. Exit 0
    if all are well, 1 if some are not. With -q only what is not well or changed is told.
    """
