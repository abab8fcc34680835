"""Back up a PLC's program: every page proven, header checked, only valid images are saved."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fatektool.callbacks import ignore
from fatektool.files.times import utc
from fatektool.jobs.programs.proving import read_proven
from fatektool.jobs.programs.reading import ProgramReading, read_program
from fatektool.program.archive import Backup, Source
from fatektool.version import __version__

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.jobs.programs.known import KnownPages
    from fatektool.jobs.progress import Progress


@dataclass(frozen=True, slots=True)
class BackupResult:
    """A backup that was read, not yet written to a file.

    Attributes:
        backup: the program with its source.
        duration_s: how long the reading took.
    """

    backup: Backup
    duration_s: float


def read_backup(
    plc: Plc,
    *,
    single_pass: bool = False,
    any_header: bool = False,
    known: KnownPages | None = None,
    data: bool = False,
    progress: Progress = ignore,
) -> BackupResult:
    """``backup``, with the time that it took; arguments and errors are the same."""
    clock = plc.link.transport.clock
    began = clock()
    found = backup(
        plc, single_pass=single_pass, any_header=any_header, known=known, data=data, progress=progress
    )
    return BackupResult(found, clock() - began)


def backup(
    plc: Plc,
    *,
    single_pass: bool = False,
    any_header: bool = False,
    known: KnownPages | None = None,
    data: bool = False,
    progress: Progress = ignore,
) -> Backup:
    """Read a PLC's program into a backup. ``save_backup`` writes it to a file.

    Args:
        plc: the PLC; it may run.
        single_pass: read once, and compare with nothing.
        any_header: keep an image with an invalid header; it is marked.
        known: what is on file of this PLC: a page that is as on file needs no second reading.
        data: read the PLC's data too, when the program is read: see ``read_data``.
        progress: called for each page.

    Raises:
        LineError: no answer for a page, or the line has too many errors.
        PlcRefused: the PLC refuses its program.
        DataError: an invalid header, or two passes differ.
    """

    def check(reading: ProgramReading) -> None:
        if not any_header:
            reading.program.require_header(
                "run it again; if the error stays, --any-header saves the image as it is, marked as such"
            )

    if single_pass:
        reading = read_program(plc, progress=progress)
        check(reading)
    else:
        reading = read_proven(plc, known, progress, after_first=check)
        check(reading)
    found = backup_of(plc, reading)
    if not data:
        return found
    from fatektool.jobs.data.reading import read_data  # with the planner, which a program does not need

    return replace(found, data=read_data(plc, reading.status, progress))


def backup_of(plc: Plc, reading: ProgramReading) -> Backup:
    """A program that was read just now as a backup."""
    return Backup(
        program=reading.program,
        created=utc(),
        tool=f"fatektool {__version__}",
        source=Source(plc.target, plc.link.station, plc.link.codec.name, plc.link.transport.serial_settings),
        plc={
            "status": reading.status.flags.document(),
            "system": reading.status.system.document(),
        },
        passes=reading.passes,
        proof=reading.proof,
    )
