"""``watch``: values live on a terminal, or one NDJSON line a round."""

from __future__ import annotations

import json
import sys
import time
from collections import deque
from typing import TYPE_CHECKING, Any, Final

import click

from fatektool.cli.options import PATH, Connection, connection_options
from fatektool.cli.read import SELECTION, shown
from fatektool.cli.snapshot import selected
from fatektool.errors import LineError
from fatektool.jobs.snapshot import Snapshot, take_snapshot

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from fatektool.cli.output import Voice
    from fatektool.client import Plc
    from fatektool.jobs.snapshot_spec import SpecItem
    from fatektool.protocol.values import Value

_TREND: Final = 24
_BARS: Final = "▁▂▃▄▅▆▇█"
_MOST_FAILURES: Final = 10


@click.command(
    "watch",
    epilog="Example: fatektool watch R12 D4:f32 Y0-Y7 --interval 0.5 -p /dev/ttyUSB0",
    help=f"Show values live until Ctrl-C; without a terminal, print one NDJSON line a round.\n\n{SELECTION}",
)
@click.argument("elements", nargs=-1)
@click.option("--spec", type=PATH, metavar="FILE.toml", help="What to read, with names, scales and units.")
@click.option("--group", "groups", multiple=True, help="Only items of this group of --spec; repeat for more.")
@click.option("--interval", type=click.FloatRange(0, 86400), default=1.0, show_default=True, metavar="S")
@click.option("--count", type=click.IntRange(1), help="So many rounds; by default until Ctrl-C.")
@connection_options
def watch_command(
    elements: tuple[str, ...],
    connection: Connection,
    voice: Voice,
    *,
    spec: Path | None,
    groups: tuple[str, ...],
    interval: float,
    count: int | None,
) -> None:
    """Show values live."""
    items = selected(elements, spec, groups, whole=False)
    with connection.open(voice) as plc:
        rounds = _rounds(plc, items, interval, count, voice)
        if sys.stdout.isatty() and not voice.json:
            _live(rounds, items)
        else:
            for snapshot in rounds:
                click.echo(json.dumps(_document(snapshot), allow_nan=False))
                sys.stdout.flush()


def _rounds(
    plc: Plc, items: list[SpecItem], interval_s: float, count: int | None, voice: Voice
) -> Iterator[Snapshot]:
    """A snapshot a round, on time; a line that fails for long ends it."""
    due = time.monotonic()
    failures = done = 0
    while count is None or done < count:
        try:
            snapshot = take_snapshot(plc, items)
        except LineError as error:
            failures += 1
            if failures >= _MOST_FAILURES or not done:
                raise
            voice.warn(f"{error.message}; trying on")
        else:
            failures = 0
            done += 1
            yield snapshot
        due = max(due + interval_s, time.monotonic())
        if count is None or done < count:
            time.sleep(max(0.0, due - time.monotonic()))


def _document(snapshot: Snapshot) -> dict[str, Any]:
    return {
        "schema": "fatektool.watch/1",
        "time": snapshot.time,
        "target": snapshot.target,
        "station": snapshot.station,
        "protocol": snapshot.protocol,
        "running": snapshot.running,
        "duration_s": snapshot.duration_s,
        "values": snapshot.values,
        "errors": snapshot.errors,
    }


def _live(rounds: Iterator[Snapshot], items: list[SpecItem]) -> None:
    from rich.live import Live

    trends: dict[str, deque[float]] = {item.item.key: deque(maxlen=_TREND) for item in items}
    before: dict[str, Value | None] = {}
    with Live(refresh_per_second=4) as live:
        for snapshot in rounds:
            live.update(_table(snapshot, before, trends), refresh=True)
            before = snapshot.values


def _table(snapshot: Snapshot, before: dict[str, Value | None], trends: dict[str, deque[float]]) -> Any:
    from rich.table import Table
    from rich.text import Text

    mode = "RUN" if snapshot.running else "STOP"
    table = Table(title=f"station {snapshot.station} on {snapshot.target}  {mode}  {snapshot.time}", box=None)
    table.add_column("element", no_wrap=True)
    table.add_column("value", justify="right", no_wrap=True)
    table.add_column("unit")
    table.add_column("", width=1)
    table.add_column("trend", no_wrap=True)
    for key, value in snapshot.values.items():
        if isinstance(value, int | float):
            trends[key].append(float(value))
        changed = key in before and before[key] != value
        text = Text(shown(value, snapshot.errors.get(key)), style="bold reverse" if changed else "")
        unit = str(snapshot.elements[key].get("unit", ""))
        table.add_row(Text(key), text, Text(unit), "*" if changed else "", trend(trends[key]))
    return table


def trend(values: deque[float], bars: str = _BARS) -> str:
    """A small chart of numbers, the lowest at the bottom."""
    if not values:
        return ""
    least, most = min(values), max(values)
    span = most - least
    place: Callable[[float], int] = lambda value: int((value - least) / span * (len(bars) - 1)) if span else 0  # noqa: E731
    return "".join(bars[place(value)] for value in values)
