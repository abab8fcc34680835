"""``help`` and ``version``: the same as ``--help`` and ``--version``, for those who type a command."""

from __future__ import annotations

import click

from fatektool.version import __version__


@click.command("help", epilog="Example: fatektool help backup")
@click.argument("words", metavar="[COMMAND]…", nargs=-1)
@click.pass_context
def help_command(context: click.Context, words: tuple[str, ...]) -> None:
    """Show the help of COMMAND, such as 'snapshot apply'; without COMMAND list all commands."""
    parent = context.find_root()
    for word in words:
        group = parent.command
        if not isinstance(group, click.Group):
            raise click.UsageError(f"{parent.command_path!r} has no commands: got {word!r}", parent)
        name, command, _ = group.resolve_command(parent, [word])
        if name is None or command is None:
            raise click.UsageError(f"no such command {word!r}", parent)
        parent = click.Context(command, parent=parent, info_name=name)
    click.echo(parent.get_help())


@click.command("version", epilog="Example: fatektool version")
def version_command() -> None:
    """Print the version."""
    click.echo(f"fatektool {__version__}")
