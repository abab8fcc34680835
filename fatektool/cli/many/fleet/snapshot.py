"""``fleet snapshot``: the data of all PLCs, each by its specification."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import click

from fatektool.cli.many.alarms import Alarms, alarm_options
from fatektool.cli.many.fleet.run import Orders, ended, fleet_options, news_option, opened, run_fleet
from fatektool.cli.many.outcome import JobResult
from fatektool.cli.programs.program_files import comments_of_entry
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.places import require_folder_for
from fatektool.counts import counted
from fatektool.errors import PlcError, UsageError
from fatektool.files.atomic import make_folder
from fatektool.jobs.snapshots.comments import snapshot_with_comments
from fatektool.jobs.snapshots.formats import as_json
from fatektool.jobs.snapshots.modbus_map import with_entry_map
from fatektool.jobs.snapshots.snapshot import take_snapshot
from fatektool.jobs.snapshots.spec import load_spec
from fatektool.jobs.snapshots.store import Keep, save_dated

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.inventory.entries import PlcEntry
    from fatektool.jobs.fleet.rounds import Turn


@click.command("snapshot", epilog="Example: fatektool fleet snapshot --dir snapshots --keep 30d")
@click.option(
    "--dir",
    "folder",
    type=PATH,
    required=True,
    metavar="DIR",
    help="Write a dated file for each PLC, in DIR/NAME/.",
)
@click.option("--keep", metavar="N|DAYSd", help="Keep N snapshots of each PLC, or those of so many days.")
@alarm_options(changes=False)
@news_option
@fleet_options
def snapshot_command(orders: Orders, alarms: Alarms, voice: Voice, *, folder: Path, keep: str | None) -> int:
    """Read each PLC's data by its specification, which the inventory names."""
    require_folder_for(folder, voice)
    kept = None if keep is None else Keep.parse(keep)
    document, interrupted = run_fleet("snapshot", orders, alarms, voice, _work(voice, folder, kept))
    return ended("snapshot", document, voice, alarms, interrupted=interrupted)


def _work(voice: Voice, folder: Path, keep: Keep | None) -> Callable[[PlcEntry, Turn[JobResult]], JobResult]:
    """``fleet snapshot``: into a folder for each PLC, as two may have the same station."""

    def work(entry: PlcEntry, turn: Turn[JobResult]) -> JobResult:
        if entry.spec is None:
            raise UsageError("no specification in the inventory", hint='add spec = "FILE.toml" there')
        spec = load_spec(entry.spec)
        mapped = replace(entry, address=with_entry_map(entry.address, entry.modbus_map))
        with opened(mapped, turn, voice) as plc:
            snapshot = take_snapshot(plc, spec.items, turn.progress)
        snapshot = snapshot_with_comments(snapshot, comments_of_entry(entry, voice.of(entry.name)))
        own = folder / entry.name
        make_folder(own)
        path = save_dated(snapshot, as_json(snapshot), own, suffix="json", keep=keep)
        wrong = f", {len(snapshot.errors)} refused: {', '.join(snapshot.errors)}"[:200]
        words = f"{counted(len(snapshot.values), 'value')}{wrong if snapshot.errors else ''}"
        code = PlcError.exit_code if snapshot.errors else 0
        return JobResult(code, snapshot.document(), words, path)

    return work
