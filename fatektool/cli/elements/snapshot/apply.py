"""``snapshot apply``: a snapshot's data back into the PLC."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.elements.values import shown, warn_of
from fatektool.cli.shared.addressee import Origin, Pace, look
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.documents import where
from fatektool.cli.shared.modbus_map import modbus_map_option
from fatektool.cli.shared.options import PATH, yes_option
from fatektool.cli.shared.output import Voice, table
from fatektool.cli.shared.pairs import apart
from fatektool.cli.shared.places import safety_folder
from fatektool.cli.shared.way_back import RegisterWrite, same_again
from fatektool.errors import PlcError
from fatektool.jobs.elements.reads import named
from fatektool.jobs.snapshots.apply import ApplyPlan, apply_plan, plan_apply
from fatektool.jobs.snapshots.snapshot import load_snapshot
from fatektool.planner import plan_writes
from fatektool.protocol.values import raw_text

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.client import Plc
    from fatektool.jobs.elements.writes import NotTaken
    from fatektool.jobs.snapshots.snapshot import Snapshot


@click.command("apply", epilog="Example: fatektool snapshot apply press.json -p /dev/ttyUSB0 --only 'R*'")
@click.argument("file", type=PATH)
@click.option("--only", multiple=True, metavar="GLOB", help="Only these keys; repeat for more.")
@click.option("--dry-run", is_flag=True, help="Show what would be written, and write nothing.")
@click.option(
    "--safety-dir",
    type=PATH,
    metavar="DIR",
    help="Where the present values are saved; by default beside FILE.",
)
@click.option("--no-safety-snapshot", is_flag=True, help="Do not save the present values: no way back.")
@yes_option
@connection_options
@modbus_map_option
def apply_command(
    file: Path,
    connection: Connection,
    voice: Voice,
    *,
    only: tuple[str, ...],
    dry_run: bool,
    safety_dir: Path | None,
    no_safety_snapshot: bool,
    yes: bool,
) -> int:
    """Put the data in FILE back into the PLC.

    Only what differs is written; the present values are saved as a safety snapshot first, and all is read
    back. Inputs (X) are not written. What the PLC does not take is named (exit 4). If the line fails on the
    way (exit 6), the same command finishes it.
    """
    apart("no_safety_snapshot", "safety_dir")
    snapshot = load_snapshot(file, voice.warn)
    folder = None if no_safety_snapshot else safety_folder(safety_dir, file, voice, dry_run=dry_run)
    safety: str | None = None
    failed: list[NotTaken] = []
    with connection.open(voice, writes=not dry_run) as plc:
        pace = Pace(plc)
        plan = plan_apply(plc, snapshot, only)
        _warn(plan, voice)
        here = look(plc)
        origin = Origin(snapshot.target, snapshot.station, snapshot.time)
        origin.warn_unless_from(here, file, voice)
        rows: list[tuple[str, object]] = [("file", file), ("from", origin)]
        lines = list(_plan_lines(plan, snapshot))
        if plan.changes and not dry_run:
            requests = plan_writes(plan.writes, plc.link.codec)
            work = RegisterWrite(
                here,
                plan.present,
                file.stem,
                folder,
                [*rows, ("time", pace.time_of(2 * len(requests)))],
                lines,
                len(plan.writes),
                same_again(connection, "apply"),
                "the snapshot was not applied whole",
            )
            safety, failed = work.carry_out(voice, partial(apply_plan, plc, plan), yes=yes)
        document = _document(plc, file, plan, snapshot, failed, safety=safety, dry_run=dry_run)
    document |= here.document() | {"source": origin.document()}
    shown = list(_result_lines(plan, lines, failed, dry_run=dry_run))
    if plan.changes:
        facts = [*here.rows(), *rows]
        shown = [*table(facts), *shown] if dry_run else [*shown, f"from {origin}", f"into {here.line}"]
    voice.show(document, shown)
    names = plan.keys()
    warn_of({names.get(each.element, str(each.element)): _did_not(each) for each in failed}, voice)
    return PlcError.exit_code if failed or plan.refused else 0


def _did_not(each: NotTaken) -> str:
    return each.words(lambda raw: raw_text(raw, each.element.kind.bits), str(each.element))


def _warn(plan: ApplyPlan, voice: Voice) -> None:
    if plan.present.running and plan.changes:
        voice.warn("the PLC is in RUN: its program may change the values again")
    for keys, why in (
        (plan.inputs, "inputs follow their terminals"),
        (plan.missing, "no value in the snapshot"),
    ):
        if keys:
            voice.warn(f"not written: {named(keys)}: {why}")
    warn_of({key: f"not written: {error}" for key, error in plan.refused.items()}, voice)


def _plan_lines(plan: ApplyPlan, snapshot: Snapshot) -> Iterator[str]:
    width = max((len(key) for key, *_ in plan.changes), default=0)
    for key, *_ in plan.changes:
        before, after = plan.present.values[key], snapshot.values[key]
        yield f"{key:<{width}}  {shown(before)} -> {shown(after)}"


def _result_lines(
    plan: ApplyPlan, lines: list[str], failed: list[NotTaken], *, dry_run: bool
) -> Iterator[str]:
    if not plan.changes:
        other = plan.inputs or plan.missing or plan.refused
        yield "nothing to write: all else is the same" if other else "same: nothing was written"
    elif dry_run:
        yield from lines
        yield "dry run: nothing was written"
    else:
        yield f"{len(plan.writes) - len(failed)} of {len(plan.writes)} values written and read back"


def _document(
    plc: Plc,
    file: Path,
    plan: ApplyPlan,
    snapshot: Snapshot,
    failed: list[NotTaken],
    *,
    safety: str | None,
    dry_run: bool,
) -> dict[str, Any]:
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
                "from": plan.present.values[key],
                "to": snapshot.values[key],
            }
            for key, element, *_ in plan.changes
        ],
        "written": 0 if dry_run else len(plan.writes) - len(failed),
        "not_taken": [
            {
                "key": names.get(each.element, str(each.element)),
                "element": str(each.element),
                "reason": each.reason,
            }
            for each in failed
        ]
        + [
            {"key": key, "element": snapshot.elements[key]["element"], "reason": reason}
            for key, reason in plan.refused.items()
        ],
        "not_written": [*plan.inputs, *plan.missing],
        "safety_snapshot": safety,
    }
