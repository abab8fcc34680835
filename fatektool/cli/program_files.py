"""Files with a program, as arguments: read, and what is odd about them said."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.options import PATH
from fatektool.project.program_file import load_program

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from fatektool.cli.output import Voice
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
        help="Code page of a project's comments: cp1250, cp1252, cp932, cp936, cp950, cp1254.",
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
    """Read a backup or a project, and say what is odd about its comments."""
    found = load_program(path, encoding=encoding)
    warn_of_code_page(found, voice)
    return found


def warn_of_code_page(found: ProgramFile, voice: Voice) -> None:
    """Say so if no code page decodes all comments."""
    if not found.comments.sure:
        voice.warn(
            f"{found.name}: no code page decodes all comments; they are shown in latin-1: name theirs with "
            "--encoding"
        )


def comments_from(path: Path | None, voice: Voice, encoding: str | None = None) -> Comments | None:
    """The comments of the project that a user named; None if none is named.

    Raises:
        DataError: it is no project, or does not hold.
    """
    if path is None:
        return None
    from fatektool.errors import DataError

    found = program_file(path, voice, encoding)
    if found.project is None:
        raise DataError(
            f"{path}: a backup has no comments, expected a WinProladder project (.pdw)", file=str(path)
        )
    return found.comments


def warn_of_unknown(found: ProgramFile, voice: Voice) -> None:
    """Say how much of the code is not understood."""
    code = found.require_code()
    unknown = code.unknown_words
    if unknown:
        voice.warn(
            f"{found.name}: {unknown} of {len(code.words)} words of code are not understood and shown as "
            "they are (??); behind them reading went on at the next word that begins a network"
        )


def beside(elements: tuple[str, ...], comments: Mapping[str, str]) -> str:
    """The comments of an instruction's elements, as they are shown beside it."""
    known = [(element, comments[element]) for element in elements if element in comments]
    if len(elements) == 1:
        return known[0][1] if known else ""
    return ", ".join(f"{element}: {comment}" for element, comment in known)
