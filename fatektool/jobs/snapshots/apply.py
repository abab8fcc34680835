"""Putting a snapshot's data back: after a battery died, or into a spare PLC.

The order is that of a restore: read what is there, save it as a safety snapshot, ask, write only what
differs, read back. Inputs (X) follow their terminals and are not written.
"""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

from fatektool.errors import DataError
from fatektool.jobs.elements.selection import Item, places_of
from fatektool.jobs.elements.writes import NotTaken, write_planned
from fatektool.jobs.snapshots.snapshot import Snapshot, raw_of, take_snapshot
from fatektool.jobs.snapshots.spec import SpecItem
from fatektool.planner.atoms import atoms_of
from fatektool.protocol.elements import Element
from fatektool.protocol.values import ValueType

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.client import Plc


@dataclass(frozen=True, slots=True)
class ApplyPlan:
    """What will be written.

    Attributes:
        present: the same items as they are now.
        changes: key, element, and raw bits on file.
        inputs: keys of inputs that differ; they are not written.
        missing: keys that the snapshot has no value for; they are not written.
        refused: keys that this PLC refuses, and what it says; they are not written.
    """

    present: Snapshot
    changes: tuple[tuple[str, Element, int], ...]
    inputs: tuple[str, ...]
    missing: tuple[str, ...]
    refused: dict[str, str]

    @property
    def writes(self) -> list[tuple[Element, int]]:
        """What is written, each discrete and register once: the widest element that it is part of."""
        claimed: set[tuple[str, int]] = set()
        found = []
        for _, element, wanted in sorted(self.changes, key=lambda change: -change[1].kind.bits):
            places = places_of(element)
            free = [place for place in places if place not in claimed]
            claimed.update(free)
            if len(free) == len(places):
                found.append((element, wanted))
                continue
            width = element.kind.bits // len(places)
            for number, place in enumerate(places):
                if place in free:
                    found.append((Element(*place), wanted >> (number * width) & ((1 << width) - 1)))
        return found

    def keys(self) -> dict[Element, str]:
        """What the snapshot calls an element that is written."""
        return {element: key for key, element, _ in reversed(self.changes)}


def plan_apply(plc: Plc, snapshot: Snapshot, only: Iterable[str] = ()) -> ApplyPlan:
    """Read what is there now and find what differs. Changes nothing.

    Args:
        plc: the PLC.
        snapshot: what should be there.
        only: globs of keys; all if empty.

    Raises:
        DataError: nothing in it matches, or it says two things of one register.
        LineError: no answer.
    """
    globs = list(only)
    wanted = {
        key: found
        for key, found in raw_of(snapshot).items()
        if not globs or any(fnmatchcase(key, glob) for glob in globs)
    }
    if not wanted:
        raise DataError(f"no key of the snapshot matches {' or '.join(globs) or 'anything'}")
    _one_value_each(wanted)
    items = [
        SpecItem(Item(key, element, ValueType(snapshot.elements[key]["type"])), *_scale(snapshot, key))
        for key, (element, _) in wanted.items()
    ]
    present = take_snapshot(plc, items)
    now = raw_of(present)
    changes, inputs, missing, refused = [], [], [], {}
    for key, (element, raw) in wanted.items():
        if raw is None:
            missing.append(key)
        elif now[key][1] is None:
            refused[key] = present.errors[key]
        elif now[key][1] != raw:
            if element.symbol.endswith("X"):
                inputs.append(key)
            else:
                changes.append((key, element, raw))
    return ApplyPlan(present, tuple(changes), tuple(inputs), tuple(missing), refused)


def _scale(snapshot: Snapshot, key: str) -> tuple[float | None, float | None, str | None]:
    part = snapshot.elements[key]
    return part.get("scale"), part.get("offset"), part.get("unit")


def _one_value_each(wanted: dict[str, tuple[Element, int | None]]) -> None:
    """Refuse a snapshot that says two things of one register."""
    said: dict[tuple[str, int], tuple[int, str]] = {}
    for key, (element, raw) in wanted.items():
        if raw is None:
            continue
        atoms = atoms_of(element)
        width = element.kind.bits // len(atoms)
        for place, atom in enumerate(atoms):
            bits = raw >> (place * width) & ((1 << width) - 1)
            before = said.setdefault(atom, (bits, key))
            if before[0] != bits:
                raise DataError(
                    f"the snapshot says two things of {atom[0]}{atom[1]}: {before[1]} and {key}",
                    hint="pick one with --only",
                )


def apply_plan(plc: Plc, plan: ApplyPlan, safety: str | None) -> list[NotTaken]:
    """Write what differs and read it back; give what did not take.

    Args:
        plc: the PLC.
        plan: of this PLC, just now.
        safety: where the present values lie, for messages.

    Raises:
        LineError: no answer, and nothing was written.
        RestoreIncomplete: the line failed on the way.
    """
    return write_planned(plc, plan.writes, safety, failed="the snapshot was not applied whole")
