"""``snapshot diff``: what changed between two snapshots."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING

import click

from fatektool.cli.elements.documents import snapshot_diff_document
from fatektool.cli.elements.values import shown
from fatektool.cli.shared.colour import Style, coloured, joined, word
from fatektool.cli.shared.options import PATH, voice_options
from fatektool.errors import UsageError
from fatektool.jobs.snapshots.compare import ValueChange, compare_snapshots
from fatektool.jobs.snapshots.snapshot import load_snapshot

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.shared.output import Voice


@click.command(
    "diff", epilog='Example: fatektool snapshot diff monday-data.json tuesday-data.json --ignore "RT*"'
)
@click.argument("a", type=PATH)
@click.argument("b", type=PATH)
@click.option("--ignore", multiple=True, metavar="GLOB", help="Keys that are not compared; repeat for more.")
@click.option(
    "--tolerance",
    type=click.FloatRange(0),
    default=0.0,
    metavar="X",
    help="Largest difference of two numbers that is ignored.",
)
@voice_options
def diff_command(a: Path, b: Path, voice: Voice, *, ignore: tuple[str, ...], tolerance: float) -> int:
    """Compare the snapshots A and B: exit 0 if nothing differs, 1 if something does. Needs no PLC."""
    if isnan(tolerance):
        raise UsageError("--tolerance nan: expected a number, 0 or more")
    one, other = load_snapshot(a, voice.warn), load_snapshot(b, voice.warn)
    changes = compare_snapshots(one, other, ignore=ignore, tolerance=tolerance)
    document = snapshot_diff_document((a, one), (b, other), changes)
    voice.show(document, _change_lines(changes))
    return 1 if changes else 0


def _change_lines(changes: list[ValueChange]) -> Iterator[str]:
    if not changes:
        yield word("same")
    width = max((len(change.key) for change in changes), default=0)
    for change in changes:
        one, other = (
            "(not there)" if change.absent == side else shown(value, "- (no value)")
            for side, value in (("a", change.a), ("b", change.b))
        )
        start = f"{change.key:<{width}}  "
        yield joined(start, coloured(one, Style.REMOVED), " -> ", coloured(other, Style.GOOD))
