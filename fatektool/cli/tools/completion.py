"""``completion``: the shell's completion, to be put where the shell looks for it."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

from fatektool.cli.shared.shells import SHELLS, add_shells


@click.command("completion", epilog='Example: eval "$(fatektool completion bash)"')
@click.argument("shell", type=click.Choice(SHELLS))
@click.pass_context
def completion_command(context: click.Context, shell: str) -> None:
    """Print the completion for bash, zsh, fish or PowerShell.

    Put it where the shell reads it at its start; docs/commands.md has the lines for each.
    """
    add_shells()
    found = get_completion_class(shell)
    root = context.find_root()
    if found is not None:
        click.echo(found(root.command, {}, "fatektool", "_FATEKTOOL_COMPLETE").source())
