"""Files with a program, as arguments: read, with warnings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.pairs import together
from fatektool.errors import DataError, FatektoolError
from fatektool.inventory.find import inventory_path

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.inventory.entries import PlcEntry
    from fatektool.program.archive import Backup
    from fatektool.project.comments import Comments
    from fatektool.project.program_file import ProgramFile

F = TypeVar("F", bound="Callable[..., Any]")


def encoding_option(function: F) -> F:
    """``--encoding PAGE``; the command gets ``encoding``, checked, or None."""

    def checked(_: click.Context, __: click.Parameter, value: str | None) -> str | None:
        if value is None:
            return None
        from fatektool.project.code_page import code_page

        return code_page(value)

    return click.option(
        "--encoding",
        metavar="PAGE",
        callback=checked,
        help="Code page of a project's comments: cp1250 to cp1258, cp874, cp932, cp936, cp949, cp950.",
    )(function)


def comments_options(function: F) -> F:
    """``--comments FILE.pdw`` and ``--encoding``; the command gets ``comments``, a path or None."""
    found: F = click.option(
        "--comments",
        type=PATH,
        metavar="FILE.pdw",
        help="Show the comments of this WinProladder project beside the elements.",
    )(encoding_option(function))
    return found


def program_file(path: Path, voice: Voice, encoding: str | None = None) -> ProgramFile:
    """Read a backup or a project, and warn if its comments cannot be decoded."""
    from fatektool.project.program_file import load_program

    found = load_program(path, encoding=encoding)
    warn_of_code_page(found, voice)
    return found


def require_comments(comments: Path | None, *files: ProgramFile) -> None:
    """Refuse ``--encoding`` where nothing has comments.

    Raises:
        UsageError: no project is named.
    """
    holds = comments is not None or any(file.project is not None for file in files)
    together("encoding", holds=holds, needs="--comments or a project as FILE")


def warn_of_code_page(found: ProgramFile, voice: Voice) -> None:
    """Say so if no code page decodes all comments."""
    if not found.comments.sure:
        voice.warn(
            f"{found.name}: no code page decodes all comments; they are shown in latin-1: give the right one "
            "with --encoding"
        )


def comments_from(path: Path | None, voice: Voice, encoding: str | None = None) -> Comments | None:
    """The comments of the project that a user named; None if none is named.

    Raises:
        DataError: it is no project, or does not hold.
    """
    if path is None:
        return None
    found = program_file(path, voice, encoding)
    if found.project is None:
        raise DataError(
            f"{path}: a backup has no comments, expected a WinProladder project (.pdw)", file=str(path)
        )
    return found.comments


def comments_beside(
    found: ProgramFile, path: Path | None, inventory: Path | None, voice: Voice, encoding: str | None = None
) -> Comments:
    """The comments of a program: of the project that is named, of the file, or of the inventory's project.

    The inventory's is that of the PLC that a backup came from, by its target and station.

    Raises:
        DataError: the project that the user names does not hold.
    """
    project = None
    if path is None and found.backup is not None:
        project = _project_of(found.backup, inventory, voice)
    known = path is not None or found.project is not None or project is not None
    together("encoding", holds=known, needs="--comments or a project")
    named = comments_from(path, voice, encoding)
    if named is None and project is not None:
        try:
            named = comments_from(project, voice, encoding)
        except FatektoolError as error:
            voice.warn(f"no comments: {error.message}")
    return found.comments if named is None else named


def _project_of(backup: Backup, inventory: Path | None, voice: Voice) -> Path | None:
    """The inventory's project for the PLC that a backup came from, if it is the only one there."""
    from fatektool.inventory.load import load_inventory

    path = inventory_path(inventory)
    if path is None:
        return None
    try:
        plcs = load_inventory(path).plcs.values()
    except FatektoolError as error:
        voice.warn(f"no comments: {error.message}")
        return None
    came_from = backup.source.target, backup.source.station
    found = {
        entry.project
        for entry in plcs
        if (entry.address.target, entry.address.station) == came_from and entry.project
    }
    return found.pop() if len(found) == 1 else None


def comments_at(
    found: ProgramFile, connection: Connection, path: Path | None, voice: Voice, encoding: str | None = None
) -> Comments:
    """The comments of a PLC's program: of the project that is named, of the file, or of the inventory's.

    Raises:
        DataError: the project that the user names does not hold.
    """
    project = None if connection.entry is None else connection.entry.project
    known = path is not None or found.project is not None or project is not None
    together("encoding", holds=known, needs="--comments or a project")
    named = comments_from(path, voice, encoding)
    if named is None and found.project is None and project is not None:
        try:
            named = comments_from(project, voice, encoding)
        except FatektoolError as error:
            voice.warn(f"no comments: {error.message}")
    return found.comments if named is None else named


def comments_for(
    connection: Connection, path: Path | None, voice: Voice, encoding: str | None = None
) -> Mapping[str, str]:
    """The comments of a PLC's elements: of the project that the user names, else of the inventory's for it.

    That the inventory's cannot be read is no reason not to look at the PLC: it is a warning.

    Raises:
        DataError: the project that the user names does not hold.
    """
    entry = connection.entry
    known = entry is not None and entry.project is not None
    together("encoding", holds=path is not None or known, needs="--comments, or a project in the inventory")
    named = comments_from(path, voice, encoding)
    if named is not None:
        return named.elements
    return {} if entry is None else comments_of_entry(entry, voice, encoding)


def comments_of_entry(entry: PlcEntry, voice: Voice, encoding: str | None = None) -> Mapping[str, str]:
    """The comments of a PLC's elements from the inventory's ``project``; a warning if that cannot be read."""
    try:
        found = comments_from(entry.project, voice, encoding)
    except FatektoolError as error:
        voice.warn(f"no comments: {error.message}")
        return {}
    return {} if found is None else found.elements


def warn_of_program(found: ProgramFile, voice: Voice) -> None:
    """Warn of what is invalid or unusual in a file's program, if its header is known."""
    from fatektool.cli.shared.image_words import warn_of_image

    if found.project is None or found.header.family is not None:  # an FBE's image has no known header
        warn_of_image(found.program, voice)


def warn_of_code(found: ProgramFile, voice: Voice) -> None:
    """The same before its code is shown, with how much of that is not understood."""
    code = found.require_code()
    warn_of_program(found, voice)
    unknown = code.unknown_words
    if unknown:
        voice.warn(
            f"{found.name}: {unknown} of {len(code.words)} words of code are not known and shown in "
            "hex (??); after them the listing continues at the next word that begins a network"
        )
    if not code.words:
        voice.say(f"{found.name}: the program has no code")
