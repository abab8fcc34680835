"""Where files go: a file that is there is kept unless ``--force`` replaces it, a missing folder is made.

Exceptions are files that are there to be replaced each time (``--prometheus``, ``fleet backup --dir``), lines
at the end of one (``--append``) and dated names in a folder.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.files.atomic import exists_already, make_folder, require_folder, require_place

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.cli.shared.output import Voice

F = TypeVar("F", bound="Callable[..., Any]")

_META = "fatektool.force"


def force_option(function: F) -> F:
    """``--force`` for a command whose files are those of other shared options; ``replaces`` has it."""

    def keep(context: click.Context, _: click.Parameter, value: bool) -> None:  # click's call
        context.meta[_META] = value

    return click.option(
        "--force", is_flag=True, expose_value=False, callback=keep, help="Replace existing files."
    )(function)


def replaces() -> bool:
    """True if the user said ``--force``."""
    context = click.get_current_context()
    return bool(context.meta.get(_META) or context.params.get("force"))


def require_free(path: Path) -> None:
    """Check, before the PLC is asked, that a file can be written here.

    Raises:
        FileExists: it is there, and is kept.
        UsageError: the place cannot be written.
    """
    if not replaces() and path.is_file():
        has_force = any(option.name == "force" for option in click.get_current_context().command.params)
        raise exists_already(path, None if has_force else "name another file, or remove it")
    require_place(path, overwrite=True)


def require_folder_for(path: Path, voice: Voice) -> Path:
    """The folder that is named for files, made if it is missing, with a word.

    Raises:
        UsageError: it cannot be made, is no folder, or is not writable.
    """
    if make_folder(path):
        voice.say(f"created the folder {path}")
    return path


def safety_folder(named: Path | None, file: Path | None, voice: Voice, *, dry_run: bool) -> Path:
    """Where the state before a write is saved: as named, else beside FILE.

    Args:
        named: ``--safety-dir``; made if it is missing, but for a dry run, which saves nothing.
        file: what is written into the PLC; for a pipe or standard input it is the working folder.
        voice: reports a folder that was made.
        dry_run: nothing will be saved.

    Raises:
        UsageError: it is no folder, or not writable.
    """
    if named is None:
        return require_folder(file.parent if file is not None and file.is_file() else _here())
    if dry_run and not named.exists():
        return named
    return require_folder_for(named, voice)


def _here() -> Path:
    from pathlib import Path

    return Path()
