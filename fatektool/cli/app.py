"""The commands by job."""

from __future__ import annotations

from typing import Final

import click

from fatektool.cli.shared.lazy_group import LazyGroup, Subcommand
from fatektool.version import __version__

JOBS: Final[dict[str, dict[str, Subcommand]]] = {
    "Programs": {
        "backup": Subcommand("programs.backup", "Read the PLC's program into a file, twice, checked."),
        "verify": Subcommand("programs.verify", "Compare the PLC's program with a backup."),
        "restore": Subcommand("programs.restore", "Write a backup's program into the PLC; can be undone."),
        "inspect": Subcommand("programs.inspect", "Show and check the contents of a backup; no PLC."),
        "listing": Subcommand("programs.listing", "List a program in the vendor's mnemonics; no PLC."),
        "xref": Subcommand("programs.xref", "Show where each element is read and written; no PLC."),
        "monitor": Subcommand("programs.monitor.command", "Show networks live; say why an element is off."),
        "diff": Subcommand("programs.diff", "Compare two backups; no PLC."),
    },
    "The PLC": {
        "status": Subcommand("plc.status", "Show model, mode and state of the PLC."),
        "run": Subcommand("plc.mode", "Put the PLC into RUN."),
        "stop": Subcommand("plc.mode", "Put the PLC into STOP."),
    },
    "Registers": {
        "read": Subcommand("elements.read", "Read elements of any kind."),
        "write": Subcommand("elements.write", "Write elements of any kind, and read them back."),
        "snapshot": Subcommand("elements.snapshot.group", "Save data as JSON or CSV, compare, write back."),
        "watch": Subcommand("elements.watch.command", "Show values live, or as NDJSON."),
        "discrete": Subcommand("elements.discrete", "Enable, disable, set, reset and list discretes."),
    },
    "The line": {
        "doctor": Subcommand("line.doctor", "Diagnose a PLC and its line: faults, what to do."),
        "loopback": Subcommand("line.loopback", "Test the line: error rate, answer times."),
        "scan": Subcommand("line.scan", "Find stations: number, baud rate, format, protocol."),
        "ports": Subcommand("line.ports", "List the serial ports of this computer."),
        "link": Subcommand("line.link.group", "The PLC's own ports; its CLINK and M-BUS tables."),
        "decode": Subcommand("line.decode", "Explain frames, given as hex or from a trace."),
        "encode": Subcommand("line.encode", "Build the frame of a command, in hex; no PLC."),
        "modbus": Subcommand("line.modbus", "Convert elements to Modbus references and back; no PLC."),
    },
    "Many PLCs": {
        "fleet": Subcommand("many.fleet.group", "Run a command for many PLCs of the inventory."),
        "inventory": Subcommand("many.inventory.group", "Check, list and extend the PLCs' file."),
        "history": Subcommand("many.history.group", "Programs as they changed, in a git repository."),
        "check": Subcommand("many.check", "Check a PLC, as a monitoring plugin."),
    },
    "Testing and scripting": {
        "simulate": Subcommand("tools.simulate", "Simulate a PLC on TCP, UDP or a pty."),
        "schema": Subcommand("tools.schema", "Print the JSON Schema of a document."),
        "completion": Subcommand("tools.completion", "Print the shell's completion."),
        "help": Subcommand("tools.about", "Show the help of a command."),
        "version": Subcommand("tools.about", "Print the version."),
    },
}


@click.group(
    cls=LazyGroup,
    sections=JOBS,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Every command has an example: fatektool COMMAND --help. A PLC to try it on: -p sim:",
)
@click.version_option(__version__, message="fatektool %(version)s")
def app() -> None:
    """Back up, verify and restore ladder programs of FATEK/FACON PLCs, and diagnose them."""
