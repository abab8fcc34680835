"""``snapshot apply``: a snapshot's data back into the PLC."""

from __future__ import annotations

import os
import shlex
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from fatektool.cli.documents import where
from fatektool.cli.modbus_map import modbus_map_option
from fatektool.cli.options import PATH, Connection, connection_options, yes_option
from fatektool.cli.output import Voice, can_ask
from fatektool.cli.pairs import apart
from fatektool.cli.read import shown, warn_of
from fatektool.errors import PlcError, RestoreIncomplete, UsageError
from fatektool.jobs.registers import named
from fatektool.jobs.snapshot import load_snapshot
from fatektool.jobs.snapshot_apply import ApplyPlan, apply_plan, plan_apply
from fatektool.jobs.snapshot_formats import as_json
from fatektool.jobs.times import stamp
from fatektool.program.files import require_folder, write_new

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.jobs.register_writes import NotTaken
    from fatektool.jobs.snapshot import Snapshot


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
    folder = None if no_safety_snapshot else require_folder(safety_dir or file.parent)
    safety: str | None = None
    failed: list[NotTaken] = []
    with connection.open(voice, writes=not dry_run) as plc:
        plan = plan_apply(plc, snapshot, only)
        _warn(plan, voice)
        lines = list(_plan_lines(plan, snapshot, file))
        if plan.changes and not dry_run:
            if not yes and not can_ask():
                raise UsageError(
                    "this needs a confirmation, and there is no terminal to ask on: nothing was written",
                    hint="add --yes",
                )
            safety = None if folder is None else str(_save_safety(plan.present, file, folder))
            for line in lines:
                voice.say(line)
            voice.say(
                f"The values before are saved in {safety}" if safety else "The values before are NOT saved."
            )
            if not voice.confirm(f"Write {len(plan.changes)} values into the PLC?", yes=yes):
                raise UsageError("not agreed to: nothing was written")
            try:
                failed = apply_plan(plc, plan, safety)
            except RestoreIncomplete as error:
                command = _go_on(connection)
                error.details["command"] = command
                where_before = (
                    f"the values before lie in {safety}" if safety else "the values before are not saved"
                )
                error.hint = f"{where_before}; mend the cause, then: {command}"
                raise
        document = _document(plc, file, plan, snapshot, failed, safety=safety, dry_run=dry_run)
    voice.show(document, _result_lines(plan, lines, failed, dry_run=dry_run))
    names = plan.keys()
    warn_of({names.get(each.element, str(each.element)): _did_not(each) for each in failed}, voice)
    return PlcError.exit_code if failed or plan.refused else 0


def _did_not(each: NotTaken) -> str:
    digits = max(1, each.element.kind.bits // 4)
    return each.words(lambda raw: f"{raw:0{digits}X}", str(each.element))


def _go_on(connection: Connection) -> str:
    """The one command that finishes what is left: the same again."""
    context = click.get_current_context()
    words = list(context.find_root().obj)
    if context.get_parameter_source("port") is ParameterSource.ENVIRONMENT:
        at = words.index("apply") + 1
        words[at:at] = ["-p", connection.target]
    return shlex.join(["fatektool", *words])


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


def _save_safety(present: Snapshot, file: Path, folder: Path) -> Path:
    start = os.fsencode(file.stem)[:150].decode(errors="ignore")  # 255 bytes is all that a name may have
    stem = f"{start}.safety-st{present.station:02}-{stamp(present.time)}"
    return write_new(folder, stem, "json", as_json(present).encode())


def _plan_lines(plan: ApplyPlan, snapshot: Snapshot, file: Path) -> Iterator[str]:
    yield f"{file}: taken {snapshot.time} from {snapshot.target}, station {snapshot.station}"
    width = max((len(key) for key, *_ in plan.changes), default=0)
    for key, *_ in plan.changes:
        before, after = plan.present.values[key], snapshot.values[key]
        yield f"{key:<{width}}  {shown(before, None)} -> {shown(after, None)}"


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
