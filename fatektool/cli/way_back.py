"""The way back and the way on of a command that writes registers: safety snapshot, the same words again."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from fatektool.jobs.snapshot_formats import as_json
from fatektool.jobs.times import stamp
from fatektool.program.files import write_new

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.options import Connection
    from fatektool.jobs.snapshot import Snapshot


def save_safety(present: Snapshot, name: str, folder: Path) -> Path:
    """Write a safety snapshot under a new name; it is on disk when this returns.

    Args:
        present: the values as they are now.
        name: what the file's name begins with.
        folder: where to.

    Raises:
        UsageError: the folder cannot be written.
        DataError: the disk is full or broken.
    """
    stem = f"{name}.safety-st{present.station:02}-{stamp(present.time)}"
    return write_new(folder, stem, "json", as_json(present).encode())


def same_again(connection: Connection, command: str) -> str:
    """The command line that was given, with the target in it even if it came from the environment.

    Args:
        connection: the target.
        command: the last word of the command's name.
    """
    context = click.get_current_context()
    words = list(context.find_root().obj)
    if context.get_parameter_source("port") is ParameterSource.ENVIRONMENT:
        at = words.index(command) + 1
        words[at:at] = ["-p", connection.target]
    return shlex.join(["fatektool", *words])
