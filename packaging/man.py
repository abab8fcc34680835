r"""Man pages from the help: python3 packaging/man.py [FOLDER] writes ``fatektool-restore.1`` and others.

A page has what ``--help`` shows, in the sections of a manual. Source of the format: groff_man(7). A Python
without fatektool makes a folder with it first.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from inspect import cleandoc
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

if __name__ == "__main__" and (find_spec("click") is None or find_spec("fatektool") is None):
    from bundle import make_bundle

    with tempfile.TemporaryDirectory() as work:
        make_bundle(Path(work) / "bundle")
        environment = os.environ | {"PYTHONPATH": str(Path(work) / "bundle")}
        sys.exit(subprocess.run([sys.executable, *sys.argv], env=environment, check=False).returncode)

import click

from fatektool.cli.app import app
from fatektool.cli.shared.options import section_of
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
    summary = command.get_short_help_str(300).rstrip(".")
    lines = [
        f'.TH "{name.upper()}" 1 "" "fatektool {__version__}" "User Commands"',
        ".nh",  # a hyphen at the end of a line would be taken for one of an option
        ".ad l",
        ".SH NAME",
        f"{escaped(name)} \\- {escaped(summary)}",
        ".SH SYNOPSIS",
        f".B {escaped(context.command_path)}",
        escaped(" ".join(command.collect_usage_pieces(context))),
        ".SH DESCRIPTION",
        *paragraphs(command.help or command.short_help or ""),
        *options(context),
    ]
    if isinstance(command, click.Group):
        inner = [(each.info_name or "", each.command.get_short_help_str(300)) for each in children(context)]
        lines += [".SH COMMANDS", *terms(inner)]
    examples = re.split(r";  +", re.sub("^Examples?: ", "", command.epilog or ""))
    if command.epilog:
        lines += [".SH EXAMPLES" if len(examples) > 1 else ".SH EXAMPLE", *as_they_are(examples)]
    lines += [".SH EXIT STATUS", *terms((str(code), meaning) for code, meaning in EXIT_CODES)]
    related = [context.parent] if context.parent else []
    related += children(context)
    if related:
        names = (f".BR {escaped(each.command_path.replace(' ', '-'))} (1)" for each in related)
        lines += [".SH SEE ALSO", ",\n".join(names)]
    return "\n".join(lines) + "\n"


def options(context: click.Context) -> Iterator[str]:
    """The options in the sections of the help, those of the command first."""
    records = [
        (section_of(each), found)
        for each in context.command.get_params(context)
        if (found := each.get_help_record(context)) and not isinstance(each, click.Argument)
    ]
    records.sort(key=lambda record: record[0] != "Options")
    for section, of_section in groupby(records, key=lambda record: record[0]):
        yield ".SH OPTIONS" if section == "Options" else f".SH {section.upper()} OPTIONS"
        yield from terms(record for _, record in of_section)


def children(context: click.Context) -> list[click.Context]:
    """The commands of a group."""
    return [each for each in commands(context.command, (context.info_name or "",), context.parent)
            if each.parent is not None and each.parent.command is context.command]  # fmt: skip


def paragraphs(text: str) -> Iterator[str]:
    """A text with a request between its paragraphs; those after click's mark are kept as they are."""
    for number, part in enumerate(re.split(r"\n\s*\n", cleandoc(text))):
        if number:
            yield ".PP"
        if part.startswith("\b\n"):
            yield from as_they_are(part.split("\n")[1:])
        else:
            yield escaped(" ".join(part.split()))


def as_they_are(lines: list[str]) -> Iterator[str]:
    """Lines that are not joined, such as those of a table."""
    yield from (".nf", *map(escaped, lines), ".fi")


def terms(records: object) -> Iterator[str]:
    """Pairs of a term and its meaning."""
    for term, meaning in records:  # type: ignore[attr-defined]
        yield from (".TP", f".B {escaped(term)}", escaped(" ".join(meaning.split())) or "\\&")


def escaped(text: str) -> str:
    """Text without what roff obeys: backslashes, hyphens, a full stop or quote at the beginning of a line.

    A long line may be broken after each ``|`` of a choice.
    """
    found = text.replace("\\", "\\e").replace("-", "\\-").replace("…", "...").replace("|", "|\\:")
    return f"\\&{found}" if found[:1] in {".", "'"} else found


def main(folder: str = "dist/man") -> None:
    """Write all pages."""
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    for context in commands():
        name = context.command_path.replace(" ", "-")
        (target / f"{name}.1").write_text(page(context), encoding="utf-8")
    print(target)


if __name__ == "__main__":
    main(*sys.argv[1:])
