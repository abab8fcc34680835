"""Values that are put into a PLC, with a safety snapshot of what they replace."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from fatektool.callbacks import ignore
from fatektool.errors import FatektoolError
from fatektool.jobs.elements.planned import PlannedValues, RegisterChange
from fatektool.jobs.elements.reads import turnaround
from fatektool.jobs.snapshots.formats import as_json
from fatektool.jobs.snapshots.snapshot import Snapshot, load_snapshot, raw_of
from fatektool.jobs.write_back.plan import WritePlan
from fatektool.jobs.write_back.record import NO_MARK, WriteMark
from fatektool.jobs.write_back.safety_copy import save_copy
from fatektool.jobs.write_back.write import Agree, agreed, write_back
from fatektool.planner import plan_writes
from fatektool.planner.atoms import Atom, parts_of

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.jobs.elements.writes import NotTaken
    from fatektool.jobs.progress import Progress
    from fatektool.protocol.status import BriefStatus


@dataclass(frozen=True, slots=True)
class ValuesPlan:
    """Values that will be written.

    Attributes:
        failed: what is said if the write ends half way: "the table was not written completely".
        present: the values in the PLC now.
        status: its status (40) then; None where there is none.
        changes: the values that differ, no discrete or register twice.
        same: how many hold already what they shall.
    """

    failed: str
    present: Snapshot
    status: BriefStatus | None
    changes: tuple[RegisterChange, ...]
    same: int

    def exchanges(self, plc: Plc) -> int:
        """How many exchanges it takes to write and read back."""
        items = [(change.element, change.after) for change in self.changes]
        return 2 * len(plan_writes(items, plc.link.codec, turnaround=turnaround(plc)))


@dataclass(frozen=True, slots=True)
class SafetySnapshot:
    """The safety copy of values: ``snapshot apply`` writes it back.

    Attributes:
        plan: what is to be written.
        name: what the file's name begins with.
        folder: where it goes; None for none.
        earlier: the copy that an unfinished run of the same write made; None if there is none.
    """

    what: ClassVar[str] = "values"
    key: ClassVar[str] = "safety_snapshot"

    plan: ValuesPlan
    name: str
    folder: Path | None
    earlier: Path | None = None

    def find(self, _: Path) -> Path | None:
        """The copy of the unfinished run, if all that is still to be written is as it was before that run."""
        if self.earlier is None:
            return None
        try:
            old = _atoms(load_snapshot(self.earlier))
        except FatektoolError:
            return None  # a damaged file cannot be written back, and is no reason to stop
        now = _atoms(self.plan.present)
        left: dict[Atom, int] = {}  # not what is written already: of a 32-bit value that may be a half
        for change in self.plan.changes:
            after = parts_of(change.element, change.after)
            before = parts_of(change.element, change.before)
            left |= {atom: bits for atom, bits in before.items() if bits != after[atom]}
        return self.earlier if now.keys() <= old.keys() and left.items() <= old.items() else None

    def save(self, folder: Path) -> Path:
        """Write a new file; it is on disk when this returns.

        Raises:
            UsageError: the folder cannot be written.
            DataError: the disk is full or broken.
        """
        present = self.plan.present
        return save_copy(folder, self.name, present.station, present.time, as_json(present).encode())


def _atoms(snapshot: Snapshot) -> dict[Atom, int]:
    found: dict[Atom, int] = {}
    for element, raw in raw_of(snapshot).values():
        if raw is not None:
            found |= parts_of(element, raw)
    return found


class Written(NamedTuple):
    """What came of it.

    Attributes:
        safety: where the previous values are saved; None if they are not.
        not_taken: what did not take, or was not read back.
    """

    safety: Path | None
    not_taken: list[NotTaken]


def write_values(
    plc: Plc,
    plan: ValuesPlan,
    copy: SafetySnapshot | None = None,
    agree: Agree = agreed,
    *,
    rollback: bool = False,
    mark: WriteMark = NO_MARK,
    progress: Progress = ignore,
) -> Written:
    """Save the previous values, ask, write what differs, read it back: see ``write_back``.

    Args:
        plc: the PLC.
        plan: of this PLC, just now.
        copy: the safety snapshot; None for none.
        agree: gets where that is, and raises an error if the user does not agree.
        rollback: write the previous values back if writing or reading back fails for good.
        mark: records that a write has begun.
        progress: called as it goes on.

    Raises:
        RestoreIncomplete: some values are written.
        FatektoolError: as ``write_back`` says; nothing was changed.
    """
    values = PlannedValues(plc, plan.changes, plan.status)
    whole = WritePlan((values,), copy or SafetySnapshot(plan, "", None), plan.failed, rollback=rollback)
    safety = write_back(plc, whole, agree, mark=mark, progress=progress)
    return Written(safety, values.not_taken)
