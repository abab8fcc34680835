r"""Man pages from the help: python3 packaging/man.py FOLDER writes ``fatektool-restore.1`` and others.

A page has what ``--help`` shows, in the sections of a manual. Source of the format: groff_man(7).
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fatektool.cli.app import app
from fatektool.errors import DataError, LineError, PlcError, RestoreIncomplete, UsageError
from fatektool.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterator

EXIT_CODES = [
    (0, "done"),
    (1, "done, and the answer is no: programs differ, a limit is passed, a check raised"),
    (UsageError.exit_code, "usage: a wrong option, a refused question"),
    (LineError.exit_code, "line: no usable answer, the port is not there or in use"),
    (PlcError.exit_code, "the PLC refused, or is in RUN where STOP is needed"),
    (DataError.exit_code, "data: an invalid file, or a program that does not fit this PLC"),
    (RestoreIncomplete.exit_code, "a restore did not complete: the message has the command to go on"),
    (70, "a fault of fatektool itself"),
    (130, "interrupted"),
]


def commands(
    command: click.Command = app, path: tuple[str, ...] = ("fatektool",), parent: click.Context | None = None
) -> Iterator[click.Context]:
    """The context of each command, groups before what is in them."""
    context = click.Context(command, info_name=path[-1], parent=parent, max_content_width=72)
    yield context
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            found = command.get_command(context, name)
            if found is not None and not found.hidden:
                yield from commands(found, (*path, name), context)


def page(context: click.Context) -> str:
    """One page in roff."""
    command = context.command
    name = context.command_path.replace(" ", "-")
    text = (command.help or command.short_help or "").replace("\b\n", "").strip()
    summary = command.get_short_help_str(300).rstrip(".")
    lines = [
        f'.TH "{name.upper()}" 1 "" "fatektool {__version__}" "User Commands"',
        ".SH NAME",
        f"{escaped(name)} \\- {escaped(summary)}",
        ".SH SYNOPSIS",
        f".B {escaped(context.command_path)}",
        escaped(" ".join(command.collect_usage_pieces(context))),
        ".SH DESCRIPTION",
        *paragraphs(text),
    ]
    records = [found for each in command.get_params(context) if (found := each.get_help_record(context))]
    if records:
        lines += [".SH OPTIONS", *terms(records)]
    if isinstance(command, click.Group):
        inner = [(each.info_name or "", each.command.get_short_help_str(300)) for each in children(context)]
        lines += [".SH COMMANDS", *terms(inner)]
    if command.epilog:
        lines += [".SH EXAMPLE", *paragraphs(command.epilog.removeprefix("Example: "))]
    lines += [".SH EXIT STATUS", *terms((str(code), meaning) for code, meaning in EXIT_CODES)]
    related = [context.parent] if context.parent else []
    related += children(context)
    if related:
        names = (f".BR {escaped(each.command_path.replace(' ', '-'))} (1)" for each in related)
        lines += [".SH SEE ALSO", ",\n".join(names)]
    return "\n".join(lines) + "\n"


def children(context: click.Context) -> list[click.Context]:
    """The commands of a group."""
    return [each for each in commands(context.command, (context.info_name or "",), context.parent)
            if each.parent is not None and each.parent.command is context.command]  # fmt: skip


def paragraphs(text: str) -> Iterator[str]:
    """A text with a request between its paragraphs."""
    for number, part in enumerate(re.split(r"\n\s*\n", text)):
        if number:
            yield ".PP"
        yield escaped(" ".join(part.split()))


def terms(records: object) -> Iterator[str]:
    """Pairs of a term and its meaning."""
    for term, meaning in records:  # type: ignore[attr-defined]
        yield from (".TP", f".B {escaped(term)}", escaped(" ".join(meaning.split())) or "\\&")


def escaped(text: str) -> str:
    """Text without what roff obeys: backslashes, hyphens, a full stop or quote at the beginning of a line."""
    found = text.replace("\\", "\\e").replace("-", "\\-").replace("…", "...")
    return f"\\&{found}" if found[:1] in {".", "'"} else found


def main(folder: str) -> None:
    """Write all pages."""
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    for context in commands():
        name = context.command_path.replace(" ", "-")
        (target / f"{name}.1").write_text(page(context), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
