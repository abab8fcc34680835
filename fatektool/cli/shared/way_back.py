"""A command that writes registers: safety snapshot, question, and how to go on if it fails on the way."""

from __future__ import annotations

import os
import shlex
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from fatektool.cli.shared.addressee import agree
from fatektool.cli.shared.incomplete import write_lines
from fatektool.errors import LineError, RestoreIncomplete
from fatektool.files.atomic import STANDARD, write_new
from fatektool.files.times import stamp
from fatektool.jobs.snapshots.formats import as_json

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from fatektool.cli.shared.addressee import Addressee
    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.elements.writes import NotTaken
    from fatektool.jobs.snapshots.snapshot import Snapshot


@dataclass(frozen=True, slots=True)
class RegisterWrite:
    """A write of registers that is about to be agreed to.

    Attributes:
        here: the PLC.
        present: the values as they are now.
        name: what the safety snapshot's name begins with.
        folder: where that goes; None for none.
        rows: what is written, where that came from, how long it will take.
        lines: what will change.
        count: how many values.
        again: the command line that finishes it.
        what: what is said if the line fails on the way.
    """

    here: Addressee
    present: Snapshot
    name: str
    folder: Path | None
    rows: Iterable[tuple[str, object]]
    lines: Iterable[str]
    count: int
    again: str
    what: str

    def carry_out(
        self, voice: Voice, write: Callable[[str | None], list[NotTaken]], *, yes: bool
    ) -> tuple[str | None, list[NotTaken]]:
        """Save the values before, ask, write; give where those lie, and what did not take.

        Args:
            voice: shows and asks.
            write: writes; is given where the values before lie.
            yes: do not ask.

        Raises:
            UsageError: not agreed to, or nobody to ask: nothing was written, and no safety snapshot is left.
            LineError: no answer, the same.
            RestoreIncomplete: the line failed on the way.
        """
        voice.require_answer(yes=yes, unchanged="nothing was written")
        path = None if self.folder is None else save_safety(self.present, self.name, self.folder)
        safety = None if path is None else str(path)
        saved = f"The values before are saved in {safety}" if safety else "The values before are NOT saved."
        values = f"{self.count} value{'' if self.count == 1 else 's'}"
        rows = [*self.here.rows(), *self.rows]
        try:
            agree(voice, rows, [*self.lines, saved], f"Write {values} into {self.here.name}?", yes=yes)
        except BaseException:  # Ctrl-C too
            _remove(path)
            raise
        try:
            return safety, write(safety)
        except LineError:  # before the first write: after it, it is the next error
            _remove(path)
            raise
        except RestoreIncomplete as error:
            headline = f"{self.what}: some of {values} may be written"
            error.details["command"] = self.again
            error.hint = f"the values before: {safety or 'not saved'}; mend the cause, then: {self.again}"
            error.lines = write_lines(error, headline, self.here.name, self.again)
            raise


def _remove(path: Path | None) -> None:
    """Remove a safety snapshot that is the way back of nothing."""
    if path is not None:
        with suppress(OSError):
            path.unlink()


def save_safety(present: Snapshot, name: str, folder: Path) -> Path:
    """Write a safety snapshot under a new name; it is on disk when this returns.

    Args:
        present: the values as they are now.
        name: what the file's name begins with; the first 150 bytes of it, as 255 is all that a name may have.
        folder: where to.

    Raises:
        UsageError: the folder cannot be written.
        DataError: the disk is full or broken.
    """
    if name == STANDARD:  # read from standard input; a name that begins with - is an option to others
        name = "stdin"
    start = os.fsencode(name)[:150].decode(errors="ignore")
    stem = f"{start}.safety-st{present.station:02}-{stamp(present.time)}"
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
        words[at:at] = ["-p", connection.address.target]
    return shlex.join(["fatektool", *words])
