"""``link``: the PLC's communication ports and the tables of CLINK and M-BUS."""

from __future__ import annotations

import click

from fatektool.cli.shared.lazy_group import LazyGroup, Subcommand, commands


@click.group(
    "link",
    cls=LazyGroup,
    sections=commands(
        ports=Subcommand("line.link.ports", "Show the communication ports 1 to 4 and their settings."),
        table=Subcommand("line.link.table.group", "Show, check, save and write communication tables."),
        result=Subcommand("line.link.result", "Explain the result of the last transaction."),
        modem=Subcommand("line.link.modem", "Show and set the modem of port 1."),
    ),
    epilog="Example: fatektool link ports -p sim:",
)
def link_command() -> None:
    """The PLC's own communication ports, and the tables of CLINK (FUN151) and M-BUS (FUN150).

    These commands are about the PLC as a master of other stations: which requests it sends to which station,
    through which port, and why it gets no answer.
    """
