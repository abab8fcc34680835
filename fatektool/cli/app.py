"""The commands by job, each loaded when it is used: asking for one never pays for the others."""

from __future__ import annotations

import importlib
from typing import Final, NamedTuple

import click

from fatektool.version import __version__


class Entry(NamedTuple):
    """Where a command lives, and its line in the help."""

    home: str
    help: str


JOBS: Final[dict[str, dict[str, Entry]]] = {
    "Programs": {
        "backup": Entry("programs.backup", "Read the PLC's program into a file, twice, checked."),
        "verify": Entry("programs.verify", "Compare the PLC's program with a backup."),
        "restore": Entry("programs.restore", "Put a backup's program into the PLC, with a way back."),
        "inspect": Entry("programs.inspect", "Show and check what a backup holds; no PLC."),
        "listing": Entry("programs.listing", "List a program in the vendor's mnemonics; no PLC."),
        "xref": Entry("programs.xref", "Show who reads and who writes each element; no PLC."),
        "diff": Entry("programs.diff", "Compare two backups; no PLC."),
    },
    "The PLC": {
        "status": Entry("plc.status", "Show what the PLC is and how it is."),
        "run": Entry("plc.mode", "Let the PLC RUN."),
        "stop": Entry("plc.mode", "STOP the PLC."),
    },
    "Registers": {
        "read": Entry("elements.read", "Read elements of any kind."),
        "write": Entry("elements.write", "Write elements of any kind, and read them back."),
        "snapshot": Entry("elements.snapshot", "Data to JSON and others; compare, put back."),
        "watch": Entry("elements.watch", "Show values live, or as NDJSON."),
        "discrete": Entry("elements.discrete", "Enable, disable, set, reset and list discretes."),
    },
    "The line": {
        "doctor": Entry("line.doctor", "Examine a PLC and its line; say what is wrong."),
        "loopback": Entry("line.loopback", "Stress the line; count and time what comes back."),
        "scan": Entry("line.scan", "Find who answers: station, baud, format, protocol."),
        "ports": Entry("line.ports", "List the serial ports of this computer."),
        "link": Entry("line.link.group", "The PLC's own ports; its CLINK and M-BUS tables."),
        "decode": Entry("line.decode", "Explain frames, given as hex or from a trace."),
        "encode": Entry("line.encode", "Build the frame of a command, in hex; no PLC."),
        "modbus": Entry("line.modbus", "What Modbus calls the elements, both ways; no PLC."),
    },
    "Many PLCs": {
        "fleet": Entry("many.fleet.group", "The same with every PLC of the inventory, many at once."),
        "inventory": Entry("many.inventory", "Check, list and extend the file that names the PLCs."),
        "history": Entry("many.history", "Programs as they changed, in a git repository."),
        "check": Entry("many.check", "A monitoring plugin: is the PLC as it ought to be?"),
    },
    "Testing and scripting": {
        "simulate": Entry("tools.simulate", "Be a PLC for others: TCP, UDP, pty."),
        "schema": Entry("tools.schema", "Print the JSON Schema of a document."),
        "completion": Entry("tools.completion", "Print the shell's completion."),
    },
}

ENTRIES: Final = {name: entry for entries in JOBS.values() for name, entry in entries.items()}


class App(click.Group):
    """A group whose commands are loaded when they are used."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002  # click's signature
        """All commands, in the order of the help."""
        return list(ENTRIES)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """Load one command."""
        entry = ENTRIES.get(cmd_name)
        if entry is None:
            return None
        module = importlib.import_module(f"fatektool.cli.{entry.home}")
        command = getattr(module, f"{cmd_name}_command")
        return command if isinstance(command, click.Command) else None

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command, and for a wrong name say which are near."""
        name = args[0]
        if name not in ENTRIES and not name.startswith("-"):
            from difflib import get_close_matches

            near = get_close_matches(name, ENTRIES, 3, 0.6)
            meant = f"; did you mean {' or '.join(near)}?" if near else ""
            raise click.UsageError(f"no such command {name!r}{meant}", ctx)
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        """Write the commands by job, without loading them."""
        for job, entries in JOBS.items():
            with formatter.section(job):
                formatter.write_dl([(name, entry.help) for name, entry in entries.items()])


@click.group(
    cls=App,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Every command has an example: fatektool COMMAND --help. A PLC to try it on: -p sim:",
)
@click.version_option(__version__, message="fatektool %(version)s")
def app() -> None:
    """Back up, verify and restore ladder programs of FATEK/FACON PLCs, and diagnose them."""
