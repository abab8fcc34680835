"""``watch``: values live on a terminal, or one NDJSON line a round."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING

import click

from fatektool.cli.elements.documents import watch_document
from fatektool.cli.elements.selection import selected, spec_options
from fatektool.cli.elements.values import SELECTION
from fatektool.cli.elements.watch.rounds import SnapshotRounds
from fatektool.cli.programs.program_files import comments_for, comments_options
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.modbus_map import modbus_map_option
from fatektool.cli.shared.options import completing
from fatektool.cli.shared.report import report_option, watch_report
from fatektool.cli.shared.rounds import RoundTimes, failed_in_line, paced_rounds, rounds_options
from fatektool.cli.shared.streams import output_loss
from fatektool.errors import FatektoolError, PlcError
from fatektool.jobs.elements.items import comments_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc
    from fatektool.jobs.snapshots.snapshot import Snapshot


@click.command(
    "watch",
    epilog="Example: fatektool watch R12 D4:f32 Y0-Y7 --interval 0.5 --count 3 -p sim:",
    help="Show values live until q; without a terminal, print one NDJSON line a round until Ctrl-C.\n\n"
    "Arrows, PgUp, PgDn: move. space: pause. w: write a value, after a question.\n\n"
    "Another process can use the line between two rounds.\n\n"
    f"{SELECTION}",
)
@click.argument("elements", nargs=-1, shell_complete=completing("complete_elements"))
@spec_options
@rounds_options("interval_s of --spec, else 1")
@comments_options
@report_option
@connection_options
@modbus_map_option
def watch_command(
    elements: tuple[str, ...],
    connection: Connection,
    voice: Voice,
    *,
    spec: Path | None,
    groups: tuple[str, ...],
    interval: float | None,
    count: int | None,
    report: Path | None,
    comments: Path | None,
    encoding: str | None,
) -> int:
    """Show values live."""
    wanted = selected(elements, spec, groups)
    texts = comments_of(
        [item.item for item in wanted.items], comments_for(connection, comments, voice, encoding)
    )
    pace_s = next((pace for pace in (interval, wanted.interval_s) if pace is not None), 1.0)
    try:
        with connection.open(voice, lend=True) as plc, watch_report(report, plc, voice) as kept:
            rounds = SnapshotRounds(plc, wanted.items, kept)
            if sys.stdout.isatty() and not voice.json:
                from fatektool.cli.elements.watch.screen import WatchScreen

                screen = WatchScreen(plc, rounds, texts, RoundTimes(pace_s, count))
                return PlcError.exit_code if screen.run() else 0
            last = _lines(_paced(plc, rounds, RoundTimes(pace_s, count), voice), texts)
    except (FatektoolError, KeyboardInterrupt) as error:
        if not voice.json:
            raise
        return failed_in_line(error)
    return PlcError.exit_code if last is not None and last.errors else 0


def _lines(rounds: Iterator[Snapshot], comments: Mapping[str, str]) -> Snapshot | None:
    """Print a line a round; give the last."""
    snapshot = None
    for snapshot in rounds:
        click.echo(json.dumps(watch_document(snapshot, comments), allow_nan=False))
        sys.stdout.flush()
        if output_loss() is not None:
            break
    return snapshot


def _paced(plc: Plc, rounds: SnapshotRounds, pace: RoundTimes, voice: Voice) -> Iterator[Snapshot]:
    """A snapshot for each round; ends if the line fails for long."""
    return paced_rounds(plc, rounds.read, pace, failed=rounds.fail, voice=voice)
