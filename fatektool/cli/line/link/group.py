"""``link``: the PLC's communication ports and the tables of CLINK and M-BUS."""

from __future__ import annotations

import importlib
from importlib.util import find_spec
from typing import Final, NamedTuple

import click


class Entry(NamedTuple):
    """Where a command lives, and its line in the help."""

    home: str
    help: str


ENTRIES: Final = {
    "ports": Entry("ports", "Show the communication ports 1 to 4 and what is set for them."),
    "table": Entry("table", "Show, check, save and write communication tables."),
    "result": Entry("result", "Explain what an instruction says of its last transaction."),
    "modem": Entry("modem", "Show and set the modem of port 1."),
}


class LinkGroup(click.Group):
    """A group whose commands are loaded when they are used."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002  # click's signature
        """All that there are, in the order of the help."""
        return [name for name, entry in ENTRIES.items() if find_spec(f"fatektool.cli.line.link.{entry.home}")]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Load one command."""
        if cmd_name not in self.list_commands(ctx):
            return None
        module = importlib.import_module(f"fatektool.cli.line.link.{ENTRIES[cmd_name].home}")
        command = getattr(module, f"{cmd_name}_command")
        return command if isinstance(command, click.Command) else None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands without loading them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, ENTRIES[name].help) for name in self.list_commands(ctx)])


@click.group("link", cls=LinkGroup, epilog="Example: fatektool link ports -p /dev/ttyUSB0")
def link_command() -> None:
    """The PLC's communication ports, and the tables of its instructions CLINK (FUN151) and M-BUS (FUN150).

    All of it concerns the PLC as a master of other stations: what it asks of whom, through which port, and
    why it gets no answer.
    """
