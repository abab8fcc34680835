"""``watch``: values live on a terminal, or one NDJSON line a round."""

from __future__ import annotations

import json
import sys
from collections import deque
from typing import TYPE_CHECKING, Any, Final

import click

from fatektool.cli.elements.documents import watch_document
from fatektool.cli.elements.selection import selected, spec_options
from fatektool.cli.elements.values import SELECTION, shown
from fatektool.cli.programs.program_files import comments_for, comments_options
from fatektool.cli.shared.bars import levels
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.modbus_map import modbus_map_option
from fatektool.cli.shared.options import SecondsType, completing
from fatektool.cli.shared.report import report_option, watch_report
from fatektool.cli.shared.rounds import RoundTimes, failed_in_line, paced_rounds
from fatektool.cli.shared.streams import reader_is_gone
from fatektool.errors import FatektoolError, PlcError
from fatektool.files.times import utc
from fatektool.jobs.elements.items import comments_of
from fatektool.jobs.snapshots.snapshot import Snapshot, take_snapshot

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc
    from fatektool.errors import LineError
    from fatektool.jobs.snapshots.spec import SpecItem
    from fatektool.protocol.values import Value
    from fatektool.report.rounds import Rounds

_TREND: Final = 24
_VALUE: Final = 7
_GAPS: Final = 4
_AROUND: Final = 4  # title, header, what is left out, and the line of the cursor


@click.command(
    "watch",
    epilog="Example: fatektool watch R12 D4:f32 Y0-Y7 --interval 0.5 --count 3 -p sim:",
    help="Show values live until Ctrl-C; without a terminal, print one NDJSON line a round.\n\n"
    "Another process can use the line between two rounds.\n\n"
    f"{SELECTION}",
)
@click.argument("elements", nargs=-1, shell_complete=completing("complete_elements"))
@spec_options
@click.option(
    "--interval",
    type=SecondsType(0, 86400),
    metavar="S",
    help="Interval of the rounds; by default interval_s of --spec, else 1.",
)
@click.option(
    "--count", type=click.IntRange(1), metavar="N", help="Number of rounds; by default until Ctrl-C."
)
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
            rounds = _rounds(plc, wanted.items, pace_s, count, voice, kept=kept)
            live = sys.stdout.isatty() and not voice.json
            last = _live(rounds, wanted.items, texts) if live else _lines(rounds, texts)
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
        if reader_is_gone():
            break
    return snapshot


def _rounds(
    plc: Plc,
    items: list[SpecItem],
    interval_s: float,
    count: int | None,
    voice: Voice,
    *,
    kept: Rounds | None,
) -> Iterator[Snapshot]:
    """A snapshot for each round; ends if the line fails for long.

    Args:
        plc: the PLC.
        items: what to read.
        interval_s: from round to round.
        count: how many; None for no end.
        voice: warns of rounds that failed.
        kept: gets the rounds, for a report; None for none.
    """

    def failed(error: LineError) -> None:
        if kept is not None:
            kept.fail(utc(), error.message)

    def read() -> Snapshot:
        return take_snapshot(plc, items)

    for snapshot in paced_rounds(plc, read, RoundTimes(interval_s, count), failed=failed, voice=voice):
        if kept is not None:
            kept.add(snapshot.document())
        yield snapshot


def _live(rounds: Iterator[Snapshot], items: list[SpecItem], comments: Mapping[str, str]) -> Snapshot | None:
    """Show a table that changes; give the last round."""
    from rich.live import Live

    trends: dict[str, deque[float]] = {item.item.key: deque(maxlen=_TREND) for item in items}
    before: dict[str, Value | None] = {}
    snapshot = None
    with Live(auto_refresh=False, vertical_overflow="crop") as live:
        for snapshot in rounds:
            live.update(_table(snapshot, before, trends, comments, live.console.size), refresh=True)
            before = snapshot.values
    return snapshot


def _table(
    snapshot: Snapshot,
    before: dict[str, Value | None],
    trends: dict[str, deque[float]],
    comments: Mapping[str, str],
    size: tuple[int, int],
) -> Any:
    """What is on the terminal: as many rows as fit, and how many more there are.

    Args:
        snapshot: this round's.
        before: the values of the round before.
        trends: the numbers so far, by key; gets this round's.
        comments: of the elements, by key.
        size: the terminal's columns and lines.
    """
    from rich.console import Group
    from rich.table import Table
    from rich.text import Text

    columns, lines = size
    names = max(7, min(max(map(len, snapshot.values), default=0), columns // 3))
    with_units = any("unit" in part for part in snapshot.elements.values())
    table = Table(box=None, padding=(0, 1, 0, 0))
    table.add_column("element", no_wrap=True, min_width=names, max_width=names)
    table.add_column("value ", justify="right", no_wrap=True, min_width=_VALUE)
    if with_units:
        table.add_column("unit", no_wrap=True)
    if comments:
        table.add_column("comment", no_wrap=True)
    table.add_column("trend", no_wrap=True)
    for value, trended in zip(snapshot.values.values(), trends.values(), strict=True):
        if isinstance(value, int | float):
            trended.append(float(value))
    units = (
        max(4, *(len(str(part.get("unit", ""))) for part in snapshot.elements.values())) if with_units else 0
    )
    values = max(_VALUE, *(len(shown(value)) + 1 for value in snapshot.values.values()))
    widest = max(map(len, comments.values()), default=0)
    remarks = min(max(_VALUE, widest), columns // 4) if comments else 0
    fits = max(1, columns - names - values - units - remarks - _GAPS - bool(comments))
    space = max(1, lines - _AROUND)
    for key, value in list(snapshot.values.items())[:space]:
        text = Text(shown(value))
        if key in before and before[key] != value:
            text = Text.assemble((text.plain, "bold reverse"), "*")
        else:
            text.append(" ")
        unit = [Text(str(snapshot.elements[key].get("unit", "")))] if with_units else []
        last = snapshot.errors[key] if key in snapshot.errors else trend(trends[key])[-fits:]
        remark = [Text(comments.get(key, "")[:remarks])] if comments else []
        table.add_row(Text(key), text, *unit, *remark, Text(last))
    mode = {True: "RUN", False: "STOP", None: "mode unknown"}[snapshot.running]
    title = f"{snapshot.time}  {mode}  station {snapshot.station} on {snapshot.target}"
    parts: list[Any] = [Text(title, no_wrap=True, overflow="ellipsis"), table]
    if len(snapshot.values) > space:
        parts.append(Text(f"and {len(snapshot.values) - space} more"))
    return Group(*parts)


def trend(values: deque[float]) -> str:
    """A small chart of numbers, the lowest at the bottom."""
    bars = levels()
    if not values:
        return ""
    least, most = min(values), max(values)
    span = most / 2 - least / 2  # halves: the whole may be past the largest number
    if not span:
        return bars[0] * len(values)
    return "".join(bars[round((value / 2 - least / 2) / span * (len(bars) - 1))] for value in values)
