"""A group of commands that are loaded when they are used: asking for one never pays for the others."""

from __future__ import annotations

import importlib
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple

import click

if TYPE_CHECKING:
    from collections.abc import Mapping

    from click.shell_completion import CompletionItem


class Subcommand(NamedTuple):
    """Where a command is, and its line in the help.

    Attributes:
        module: below ``fatektool.cli``; it has the command NAME as ``NAME_command``.
        help: one line.
    """

    module: str
    help: str


class LazyGroup(click.Group):
    """A group that knows its commands by name, and loads the one that is asked for.

    Args:
        sections: the commands by name, in the order of the help, under the heading of their section.
        attrs: as for ``click.Group``.
    """

    def __init__(self, *, sections: Mapping[str, Mapping[str, Subcommand]], **attrs: Any) -> None:
        super().__init__(**attrs)
        self.sections = sections
        self.subcommands = dict(chain.from_iterable(section.items() for section in sections.values()))

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002  # click's signature
        """All commands, in the order of the help."""
        return list(self.subcommands)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """Load one command."""
        found = self.subcommands.get(cmd_name)
        if found is None:
            return None
        module = importlib.import_module(f"fatektool.cli.{found.module}")
        command = getattr(module, f"{cmd_name}_command")
        return _with_sections(command) if isinstance(command, click.Command) else None

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command, and for a wrong name say which are near."""
        name = args[0]
        if name not in self.subcommands and not name.startswith("-"):
            from difflib import get_close_matches

            near = get_close_matches(name, self.subcommands, 3, 0.6)
            meant = f"; did you mean {' or '.join(near)}?" if near else ""
            raise click.UsageError(f"no such command {name!r}{meant}", ctx)
        return super().resolve_command(ctx, args)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """The commands with their whole lines of help, without loading them, and the options."""
        from click.shell_completion import CompletionItem

        found = [
            CompletionItem(name, help=each.help)
            for name, each in self.subcommands.items()
            if name.startswith(incomplete)
        ]
        return found + click.Command.shell_complete(self, ctx, incomplete)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        """Write the commands by section, without loading them."""
        for heading, section in self.sections.items():
            with formatter.section(heading):
                formatter.write_dl([(name, each.help) for name, each in section.items()])


def _with_sections(command: click.Command) -> click.Command:
    """A command whose help has its options in sections; those of a group of a file too."""
    if isinstance(command, click.Group):
        for each in command.commands.values():
            _with_sections(each)
    else:
        command.format_options = partial(_write_options, command)  # type: ignore[method-assign]
    return command


def _write_options(command: click.Command, ctx: click.Context, formatter: click.HelpFormatter) -> None:
    from fatektool.cli.shared.help_sections import write_options  # for who asks for help

    write_options(command, ctx, formatter)


def commands(**named: Subcommand) -> Mapping[str, Mapping[str, Subcommand]]:
    """The commands of a group that has one section."""
    return {"Commands": named}
