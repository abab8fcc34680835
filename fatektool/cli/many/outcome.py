"""What became of one PLC's turn: its result, for alarms, figures and the document of all PLCs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fatektool.cli.shared.documents import error_document
from fatektool.errors import LineError, PlcError, PortBusy

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.errors import FatektoolError
    from fatektool.protocol.status import StatusFlags


@dataclass(frozen=True, slots=True)
class JobResult:
    """What a job gave.

    Attributes:
        exit_code: that of the single command.
        document: that of the single command; None where it will not be printed.
        words: the same on one line.
        file: what was written, or compared with; None if there is none.
        changed: True if the program is another than before; None where that is not known.
        flags: the PLC's status; None where it was not read.
        up: whether the PLC answered; None if it was not asked.
    """

    exit_code: int
    document: dict[str, Any] | None
    words: str
    file: Path | None = None
    changed: bool | None = None
    flags: StatusFlags | None = None
    up: bool | None = True


def failure(error: FatektoolError) -> JobResult:
    """The result of a job that failed."""
    up: bool | None = None
    if isinstance(error, LineError) and not isinstance(error, PortBusy):
        up = False
    elif isinstance(error, PlcError):
        up = True
    return JobResult(error.exit_code, error_document(error), str(error), up=up)


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one PLC.

    Attributes:
        name: the PLC's.
        target: where it is.
        station: 1 to 254.
        duration_s: how long its turn took.
        result: what came of it.
    """

    name: str
    target: str
    station: int
    duration_s: float
    result: JobResult
