"""``fleet``: a command for many PLCs of the inventory."""

from __future__ import annotations

import click

from fatektool.cli.shared.lazy_group import LazyGroup, Subcommand, commands


@click.group(
    "fleet",
    cls=LazyGroup,
    sections=commands(
        status=Subcommand("many.fleet.status", "Show mode and state of the PLCs."),
        backup=Subcommand("many.fleet.backup", "Back up the PLCs' programs."),
        verify=Subcommand("many.fleet.verify", "Compare each PLC's program with its reference."),
        snapshot=Subcommand("many.fleet.snapshot", "Read each PLC's data, by its specification."),
        check=Subcommand("many.fleet.check", "Check the PLCs as one monitoring plugin."),
    ),
    epilog="Example: fatektool fleet backup --dir backups --jobs 8 --select hall",
)
def fleet_command() -> None:
    """Run a command for every PLC of the inventory, or for those of --select.

    PLCs on one line (one serial port, one gateway) are asked one after the other, several lines at the same
    time. Exit 0 if all are done, 1 if some failed or differ. --news prints only those, and those that
    have changed.
    """
