"""``snapshot apply``: write a snapshot's data back into the PLC."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.elements.documents import apply_document
from fatektool.cli.elements.values import shown, warn_of
from fatektool.cli.shared.addressee import ExchangeTime, Origin
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.modbus_map import modbus_map_option
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.put_values import offer_of, put_values, result_lines
from fatektool.cli.shared.unfinished import forget_those_undone
from fatektool.cli.shared.write_back import WriteCommand
from fatektool.cli.shared.write_options import Terms, write_options
from fatektool.errors import PlcError
from fatektool.jobs.elements.reads import named
from fatektool.jobs.snapshots.apply import ApplyPlan, plan_apply
from fatektool.jobs.snapshots.snapshot import load_snapshot
from fatektool.protocol.values import raw_text

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.jobs.elements.writes import NotTaken
    from fatektool.jobs.snapshots.snapshot import Snapshot


@click.command("apply", epilog='Example: fatektool snapshot apply press-data.json -p sim: --yes --only "R*"')
@click.argument("file", type=PATH)
@click.option("--only", multiple=True, metavar="GLOB", help="Only these keys; repeat for more.")
@write_options("values", "snapshot")
@connection_options
@modbus_map_option
def apply_command(
    file: Path, connection: Connection, voice: Voice, *, only: tuple[str, ...], terms: Terms
) -> int:
    """Write the data in FILE back into the PLC.

    Only what differs is written. The previous values are saved as a safety snapshot first, and all is read
    back. Inputs (X) are not written. Values that do not take are named (exit 4). If the line fails on the way
    (exit 6), the same command writes what is left.
    """
    snapshot = load_snapshot(file, voice.warn)
    writing = WriteCommand(connection, voice, terms, file, *sorted(only))
    with writing.open() as plc:
        pace = ExchangeTime(plc)
        plan = plan_apply(plc, snapshot, only)
        writing.require_answer(changes=bool(plan.changes))
        _warn(plan, voice)
        origin = Origin(snapshot.target, snapshot.station, snapshot.time)
        rows = [("file", file), ("from", origin)]
        offer = offer_of(plc, plan.values, writing, pace, rows=rows, lines=_plan_lines(plan, snapshot))
        origin.warn_unless_from(offer.here, file, voice)
        done = put_values(plc, plan.values, offer, pace, file.stem)
        document = apply_document(plc, file, snapshot, plan, done, dry_run=terms.dry_run)
    if not terms.dry_run and not only:
        forget_those_undone(connection.address.target, connection.address.station, file, voice)
    document |= offer.here.document() | {"source": origin.document()}
    lines = [*result_lines(plan.values, done, offer, pace)]
    if not plan.changes and (plan.inputs or plan.missing or plan.refused):
        lines = ["nothing to write: all else is the same"]
    elif plan.changes and not terms.dry_run:
        lines.insert(1, f"from {origin}")
    voice.show(document, lines)
    names = plan.keys()
    warn_of({names.get(each.element, str(each.element)): _did_not(each) for each in done.not_taken}, voice)
    return PlcError.exit_code if done.not_taken or plan.refused else 0


def _did_not(each: NotTaken) -> str:
    return each.words(lambda raw: raw_text(raw, each.element.kind.bits), str(each.element))


def _warn(plan: ApplyPlan, voice: Voice) -> None:
    if plan.values.present.running and plan.changes:
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
        before, after = plan.values.present.values[key], snapshot.values[key]
        yield f"{key:<{width}}  {shown(before)} -> {shown(after)}"
