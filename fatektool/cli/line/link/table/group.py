"""``link table``: communication tables."""

from __future__ import annotations

import click

from fatektool.cli.shared.lazy_group import LazyGroup, Subcommand, commands


@click.group(
    "table",
    cls=LazyGroup,
    sections=commands(
        show=Subcommand("line.link.table.show", "Show a table in the PLC, with its faults."),
        check=Subcommand("line.link.table.show", "Check a table in a file; no PLC."),
        save=Subcommand("line.link.table.show", "Save a table of the PLC to a file."),
        write=Subcommand("line.link.table.write", "Write a table from a file into the PLC."),
    ),
    epilog="Example: fatektool link table show R500 --kind md0 -p sim:plc.state",
)
def table_command() -> None:
    """Communication tables: the requests of the instructions CLINK and M-BUS.

    SR is the operand of the instruction: the register where its table begins, such as R5000 or D100.
    """
