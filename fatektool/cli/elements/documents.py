"""The JSON documents of the commands for elements and snapshots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.cli.shared.documents import where
from fatektool.jobs.elements.items import value_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from fatektool.cli.shared.addressee import Addressee
    from fatektool.client import Plc
    from fatektool.jobs.elements.discretes import DiscreteStates
    from fatektool.jobs.elements.items import ItemValues
    from fatektool.jobs.elements.selection import Item
    from fatektool.jobs.elements.writes import NotTaken
    from fatektool.jobs.snapshots.apply import ApplyPlan
    from fatektool.jobs.snapshots.compare import ValueChange
    from fatektool.jobs.snapshots.snapshot import Snapshot
    from fatektool.jobs.snapshots.write_values import Written
    from fatektool.protocol.elements import Element


def read_document(plc: Plc, found: ItemValues, comments: Mapping[str, str]) -> dict[str, Any]:
    """``fatektool.read/1``; ``comments`` by key."""
    return {
        "schema": "fatektool.read/1",
        **where(plc),
        "requests": found.requests,
        "values": found.values,
        "elements": {
            item.key: {
                "element": str(item.element),
                "type": item.type.value,
                "raw": found.raw[item.key],
                **({"comment": comments[item.key]} if item.key in comments else {}),
            }
            for item in found.items
        },
        "errors": found.errors,
        "not_asked": found.not_asked,
    }


def write_document(
    plc: Plc, here: Addressee, items: Mapping[Element, Item], failed: Sequence[NotTaken]
) -> dict[str, Any]:
    """``fatektool.write/1``: what was to be written, and what did not take."""
    return {
        "schema": "fatektool.write/1",
        **where(plc),
        **here.document(),
        "written": len(items) - len(failed),
        "not_taken": [
            {
                "element": items[each.element].key,
                "wanted": value_of(items[each.element], each.wanted),
                "got": value_of(items[each.element], each.got),
                "reason": each.reason,
            }
            for each in failed
        ],
    }


def discrete_document(plc: Plc, found: DiscreteStates, here: Addressee | None) -> dict[str, Any]:
    """``fatektool.discrete/1``; ``here`` is the PLC that was written to, None if nothing was written."""
    return {
        "schema": "fatektool.discrete/1",
        **where(plc),
        **({} if here is None else here.document()),
        "discretes": {
            name: {"on": state.on, "disabled": state.disabled} for name, state in found.states.items()
        },
        "not_taken": found.not_taken,
        "errors": found.errors,
        "not_asked": found.not_asked,
    }


def watch_document(snapshot: Snapshot, comments: Mapping[str, str]) -> dict[str, Any]:
    """``fatektool.watch/1``: one round."""
    document: dict[str, Any] = {
        "schema": "fatektool.watch/1",
        "time": snapshot.time,
        "target": snapshot.target,
        "station": snapshot.station,
        "protocol": snapshot.protocol,
        "running": snapshot.running,
        "duration_s": snapshot.duration_s,
        "values": snapshot.values,
        "errors": snapshot.errors,
        "not_asked": snapshot.not_asked,
    }
    return document | ({"comments": comments} if comments else {})


def snapshot_diff_document(
    a: tuple[Path, Snapshot], b: tuple[Path, Snapshot], changes: Sequence[ValueChange]
) -> dict[str, Any]:
    """``fatektool.snapshot-diff/1`` of two files."""
    return {
        "schema": "fatektool.snapshot-diff/1",
        **{side: {"file": str(file), "time": each.time} for side, (file, each) in (("a", a), ("b", b))},
        "same": not changes,
        "changes": [{"key": change.key, "a": change.a, "b": change.b} for change in changes],
    }


def apply_document(
    plc: Plc, file: Path, snapshot: Snapshot, plan: ApplyPlan, done: Written, *, dry_run: bool
) -> dict[str, Any]:
    """``fatektool.apply/1``: what was to be written of a snapshot, and what the PLC did not keep."""
    names = plan.keys()
    return {
        "schema": "fatektool.apply/1",
        **where(plc),
        "file": str(file),
        "dry_run": dry_run,
        "changes": [
            {
                "key": key,
                "element": str(element),
                "from": plan.values.present.values[key],
                "to": snapshot.values[key],
            }
            for key, element, *_ in plan.changes
        ],
        "written": 0 if dry_run else len(plan.values.changes) - len(done.not_taken),
        "not_taken": [
            {
                "key": names.get(each.element, str(each.element)),
                "element": str(each.element),
                "reason": each.reason,
            }
            for each in done.not_taken
        ]
        + [
            {"key": key, "element": snapshot.elements[key]["element"], "reason": reason}
            for key, reason in plan.refused.items()
        ],
        "not_written": [*plan.inputs, *plan.missing],
        "safety_snapshot": None if done.safety is None else str(done.safety),
    }
