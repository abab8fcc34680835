"""The one way in which a command writes what it planned: show, ask, write, and say how to go on.

A command begins with ``WriteCommand``, plans the write and makes an ``Offer`` of it. A dry run ends with
``Offer.dry_run``; else the job is done within ``Offer.carry_out``, which keeps the record, and asks by
``Offer.agree``.
"""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import click

from fatektool.cli.shared.addressee import Addressee, agree
from fatektool.cli.shared.again import command_again
from fatektool.cli.shared.incomplete import incomplete_lines
from fatektool.cli.shared.output import Voice, table
from fatektool.cli.shared.places import safety_folder
from fatektool.cli.shared.questions import require_answer
from fatektool.cli.shared.unfinished import (
    RecordMark,
    forget,
    load,
    record_to_use,
    warn_of_unfinished,
)
from fatektool.errors import RestoreIncomplete
from fatektool.files.times import utc
from fatektool.jobs.write_back.record import RESTORE, Unfinished

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.write_options import Terms
    from fatektool.client import Plc
    from fatektool.protocol.commands import Command


class WriteCommand:
    """A command that writes, from its options to the record of what it writes.

    Args:
        connection: the PLC's.
        voice: shows, asks and warns.
        terms: what the options say.
        file: what is written; None if it is no file.
        about: what else distinguishes this write from others of this command.

    Raises:
        UsageError: the safety copy cannot go where it should.
    """

    def __init__(
        self, connection: Connection, voice: Voice, terms: Terms, file: Path | None, *about: str
    ) -> None:
        self.connection = connection
        self.voice = voice
        self.terms = terms
        self.job = " ".join(click.get_current_context().command_path.split()[1:])
        self.file = file
        self.folder = (
            safety_folder(terms.safety_dir, file, voice, dry_run=terms.dry_run) if terms.saves else None
        )
        which = about if self.job == RESTORE else (self.job, self._file or "", *about)
        self.record = record_to_use(connection.address.target, connection.address.station, *which)

    def open(self, *needs: Command) -> Plc:
        """Open the line; warn of other writes that did not complete. The errors are ``Connection.open``'s."""
        line = self.connection
        plc = line.open(self.voice, needs=needs, writes=not self.terms.dry_run, finishes=True)
        warn_of_unfinished(line.address.target, line.address.station, self.voice, but=self.record)
        return plc

    @property
    def _file(self) -> str | None:
        return None if self.file is None else str(self.file.absolute())

    @property
    def earlier_copy(self) -> Path | None:
        """The safety copy of an earlier run of this write that did not complete; None if there is none."""
        from pathlib import Path

        found = load(self.record)
        return None if found is None or found.safety_backup is None else Path(found.safety_backup)

    def require_answer(self, *, changes: bool) -> None:
        """Refuse to go on if something differs and nobody can be asked, before anything is saved or shown.

        Raises:
            UsageError: there is no terminal to ask on.
        """
        if changes and not self.terms.dry_run:
            require_answer(yes=self.terms.yes, unchanged="nothing was written")

    def mark(self, command: str) -> RecordMark:
        """Keeps the record while this is written.

        Args:
            command: what finishes it, given in any folder.
        """
        line = self.connection
        begun = Unfinished(
            line.address.target, line.address.station, utc(), self._file, None, command, self.job
        )
        return RecordMark(self.record, begun, self.voice)

    def forget(self) -> None:
        """The PLC has all that was to be written: remove the record, if an earlier run left one."""
        forget(self.record, self.voice)


@dataclass(frozen=True, slots=True)
class Offer:
    """A planned write, and what is shown of it.

    Attributes:
        writing: the command.
        here: the PLC.
        rows: what is written, where that came from, how long it will take.
        lines: what will change.
        question: names the PLC too.
        copied: what the safety copy is of; empty if none is needed.
        again: flags that the command gets when it is to be given again.
    """

    writing: WriteCommand
    here: Addressee
    rows: Sequence[tuple[str, object]]
    lines: Sequence[str]
    question: str
    copied: str
    again: tuple[str, ...] = ()

    def dry_run(self, *details: str) -> Iterator[str]:
        """What a dry run prints."""
        yield from table([*self.here.rows(), *self.rows])
        yield from (*self.lines, *details)
        saves = self.writing.terms.saves
        yield f"Previous {self.copied} {'will be saved first' if saves else _NOT_SAVED}."
        yield "dry run: nothing was written"

    def agree(self, copy: Path | None) -> None:
        """Show it, and ask.

        Args:
            copy: where the safety copy is.

        Raises:
            UsageError: the user does not agree.
        """
        saved = f"{_NOT_SAVED}." if copy is None else f"saved in {copy}"
        lines = [*self.lines, f"Previous {self.copied} {saved}"] if self.copied else self.lines
        rows = [*self.here.rows(), *self.rows]
        agree(self.writing.voice, rows, lines, self.question, yes=self.writing.terms.yes)

    @contextmanager
    def carry_out(self) -> Iterator[RecordMark]:
        """Do the write within; give what keeps the record of it.

        Raises:
            RestoreIncomplete: the write ended half way; has the command that finishes it.
        """
        writing = self.writing
        try:
            yield writing.mark(command_again(writing.connection, *self.again, anywhere=True))
        except RestoreIncomplete as error:
            command = command_again(writing.connection, *self.again)
            error.details["command"] = command
            error.hint = f"fix the cause, then run: {command}"
            error.lines = incomplete_lines(error, self.here.name, self.copied, command)
            raise


_NOT_SAVED = "NOT saved: this write cannot be undone"
