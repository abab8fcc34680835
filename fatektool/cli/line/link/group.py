"""``link``: the PLC's communication ports and the tables of CLINK and M-BUS."""

from __future__ import annotations

import click

from fatektool.cli.shared.lazy_group import LazyGroup, Subcommand, commands


@click.group(
    "link",
    cls=LazyGroup,
    sections=commands(
        ports=Subcommand("line.link.ports", "Show the communication ports 1 to 4 and what is set for them."),
        table=Subcommand("line.link.table.group", "Show, check, save and write communication tables."),
        result=Subcommand("line.link.result", "Explain what an instruction says of its last transaction."),
        modem=Subcommand("line.link.modem", "Show and set the modem of port 1."),
    ),
    epilog="Example: fatektool link ports -p /dev/ttyUSB0",
)
def link_command() -> None:
    """The PLC's communication ports, and the tables of its instructions CLINK (FUN151) and M-BUS (FUN150).

    All of it concerns the PLC as a master of other stations: what it asks of whom, through which port, and
    why it gets no answer.
    """
