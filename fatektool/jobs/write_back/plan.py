"""What a write that can be undone is made of: its parts, in order, and the safety copy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.jobs.progress import Progress


class PlannedPart(Protocol):
    """One thing that is written: a program, or values of elements. It is planned on this PLC just now."""

    @property
    def before(self) -> str:
        """What is said of the PLC if this part is known to be as it was; empty if another part says it."""

    @property
    def mode(self) -> str:
        """After a failure, the PLC's mode and what must not be done; empty if this part leaves it alone."""

    @property
    def untouched(self) -> bool:
        """True if the PLC is known to hold what it held before, whatever was sent."""

    def prepare(self) -> None:
        """Check that it is still the PLC of the plan, as a question may wait long; then STOP it if planned.

        Raises:
            DataError: it is another PLC.
            PlcError: it is in a state in which nothing may be written.
            LineError: no answer.
        """

    def write(self, progress: Progress) -> None:
        """Write what differs, read it back and compare.

        Raises:
            PlcError: the PLC refused, or has other contents now.
            LineError: no answer.
        """

    def put_back(self, progress: Progress) -> None:
        """Write what was there before, read it back and compare; the errors of ``write``."""

    def look(self) -> None:
        """After a failure, ask the PLC what it holds and does, as far as that is not known.

        Raises:
            PlcError: the PLC refuses.
            LineError: no answer.
        """

    def states(self) -> list[tuple[str, str]]:
        """What the PLC has after a failure, for people: ``("page 0-3", "the new program")``."""

    def details(self) -> dict[str, Any]:
        """The same for scripts."""


class SafetyCopy(Protocol):
    """What is in the PLC now, to be saved in a file from which it can be written back."""

    @property
    def what(self) -> str:
        """What it is a copy of: ``program``, ``values``."""

    @property
    def key(self) -> str:
        """The name of its path in an error's details."""

    @property
    def folder(self) -> Path | None:
        """Where it goes; None if nothing is to be saved."""

    def find(self, folder: Path) -> Path | None:
        """The copy that an unfinished run of the same write made, if what is there now is half that write."""

    def save(self, folder: Path) -> Path:
        """Write a new file; it is on disk when this returns.

        Raises:
            UsageError: the folder cannot be written.
            DataError: the disk is full or broken.
        """


@dataclass(frozen=True, slots=True)
class WritePlan:
    """A planned write.

    Attributes:
        parts: what is written, in order.
        copy: of all that they change.
        failed: what is said if it ends half way.
        rollback: write back the previous data if writing or reading back finally fails.
    """

    parts: tuple[PlannedPart, ...]
    copy: SafetyCopy
    failed: str
    rollback: bool = False
