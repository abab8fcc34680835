"""The command line that was given, for the one who has to give it again, perhaps in another folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import click
from click.core import ParameterSource

from fatektool.cli.shared.options import FilePath, standard
from fatektool.files.atomic import STANDARD
from fatektool.system.shell import own_command_line

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fatektool.cli.shared.connection import Connection

_LEFT_OUT: Final = "trace"
"""Its file is there by now, and would not be replaced."""


def command_again(connection: Connection, *added: str, anywhere: bool = False) -> str:
    """The same command again, to finish what it began.

    Args:
        connection: its target is named, even if it came from the environment.
        added: flags of this command that are to be there.
        anywhere: name files by their whole path, for another folder.
    """
    context = click.get_current_context()
    names = context.command_path.split()[1:]
    port = context.get_parameter_source("port") is ParameterSource.ENVIRONMENT
    words = [*names, *added, *(["-p", connection.address.target] if port else [])]
    given = context.find_root().obj[len(names) :]
    for parameter, prefix, value in _parsed(context.command, given):
        if value in added or (parameter is not None and parameter.name == _LEFT_OUT):
            continue
        whole = anywhere and parameter is not None and isinstance(parameter.type, FilePath)
        text = _whole(value) if whole else value
        words += [f"{prefix}{text}"] if prefix.endswith("=") or not prefix else [prefix, text]
    return own_command_line(*words)


def _parsed(
    command: click.Command, words: Sequence[str]
) -> Iterator[tuple[click.Parameter | None, str, str]]:
    """The words of a command line: parameter, the text before its value, and the value.

    ``--safety-dir=x`` gives ``--safety-dir=`` and ``x``, and ``--safety-dir x`` both words. A flag is a value
    without a parameter.
    """
    options = {
        name: option for option in command.params if isinstance(option, click.Option) for name in option.opts
    }
    arguments = [argument for argument in command.params if isinstance(argument, click.Argument)]
    rest = iter(words)
    only_arguments = False
    for word in rest:
        name, equals, value = word.partition("=") if word.startswith("--") else (word[:2], "", word[2:])
        option = options.get(name)
        if word == "--" and not only_arguments:
            only_arguments = True
            yield None, "", word
        elif only_arguments or not word.startswith("-") or word == STANDARD:
            argument = arguments.pop(0) if len(arguments) > 1 else arguments[0]
            yield argument, "", word
        elif option is None or option.is_flag or option.count:
            yield None, "", word
        elif equals:
            yield option, f"{name}=", value
        elif value:  # -s7: of a short option, none of which is a file
            yield None, "", word
        else:
            yield option, word, next(rest, "")


def _whole(value: str) -> str:
    return value if standard(value) == STANDARD else str(Path(value).absolute())
