"""What ``snapshot apply`` will write: the values of a snapshot that the PLC does not hold.

Inputs (X) follow their terminals and are not written.
"""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

from fatektool.errors import DataError
from fatektool.jobs.elements.planned import RegisterChange
from fatektool.jobs.elements.selection import Item, places_of
from fatektool.jobs.snapshots.snapshot import Snapshot, raw_of, snapshot_and_status
from fatektool.jobs.snapshots.spec import SpecItem
from fatektool.jobs.snapshots.write_values import ValuesPlan
from fatektool.planner.atoms import atoms_of
from fatektool.protocol.elements import Element
from fatektool.protocol.values import ValueType

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fatektool.client import Plc


@dataclass(frozen=True, slots=True)
class ApplyPlan:
    """What will be written.

    Attributes:
        values: what is written, each discrete and register once.
        changes: key, element, and raw bits on file.
        inputs: keys of inputs that differ; they are not written.
        missing: keys that the snapshot has no value for; they are not written.
        refused: keys that this PLC refuses, and what it says; they are not written.
    """

    values: ValuesPlan
    changes: tuple[tuple[str, Element, int], ...]
    inputs: tuple[str, ...]
    missing: tuple[str, ...]
    refused: dict[str, str]

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
    present, status = snapshot_and_status(plc, items)
    now = raw_of(present)
    changes, inputs, missing, refused, same = [], [], [], {}, 0
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
        else:
            same += 1
    once = tuple(_once(changes, {element: raw for element, raw in now.values() if raw is not None}))
    values = ValuesPlan("the snapshot was not applied completely", present, status, once, same)
    return ApplyPlan(values, tuple(changes), tuple(inputs), tuple(missing), refused)


def _once(changes: Iterable[tuple[str, Element, int]], now: dict[Element, int]) -> Iterator[RegisterChange]:
    """What is written, each discrete and register once: as the widest element that it is part of."""
    claimed: set[tuple[str, int]] = set()
    for _, element, wanted in sorted(changes, key=lambda change: -change[1].kind.bits):
        before = now[element]
        places = places_of(element)
        free = [place for place in places if place not in claimed]
        claimed.update(free)
        if len(free) == len(places):
            yield RegisterChange(element, before, wanted)
            continue
        width = element.kind.bits // len(places)
        for number, place in enumerate(places):
            if place in free:
                shift, mask = number * width, (1 << width) - 1
                yield RegisterChange(Element(*place), before >> shift & mask, wanted >> shift & mask)


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
