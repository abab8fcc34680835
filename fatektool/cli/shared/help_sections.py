"""The help of a command in sections: its own options, the connection, the output.

An option that a command takes and that has no effect in it is not shown: the connection's options are the
same on all commands, so that one command line can be made from another.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import click

from fatektool.cli.shared.options import CONNECTION, OUTPUT, section_of

if TYPE_CHECKING:
    from collections.abc import Iterator

_ASKS: Final = {"yes", "broadcast", "dry_run"}
"""A command with one of these writes to the PLC: on others --read-only has no effect."""

_WIDEST: Final = 24
"""A longer option has its own line, so that the meanings of the others have enough columns."""

_OPENS: Final = "trace"
"""A command with this opens a line."""


def write_options(command: click.Command, ctx: click.Context, formatter: click.HelpFormatter) -> None:
    """Write the options of a command by section."""
    sections: dict[str, list[tuple[str, str]]] = {"Options": [], CONNECTION: [], OUTPUT: []}
    for option in _shown(command, ctx):
        record = option.get_help_record(ctx)
        if record is not None:
            sections[section_of(option)].append(record)
    for heading, records in sections.items():
        if records:
            with formatter.section(heading):
                formatter.write_dl(records, col_max=_WIDEST)


def _shown(command: click.Command, ctx: click.Context) -> Iterator[click.Parameter]:
    parameters = command.get_params(ctx)
    names = {parameter.name for parameter in parameters}
    only_reads = _OPENS in names and not names & _ASKS
    for parameter in parameters:
        if isinstance(parameter, click.Option) and not (only_reads and parameter.name == "read_only"):
            yield parameter
