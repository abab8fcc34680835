"""``loopback``: a test of the line."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

import click

from fatektool.cli import INTERRUPTED
from fatektool.cli.line.documents.linetest import loopback_document
from fatektool.cli.line.loopback_view import LiveFigures, lines
from fatektool.cli.shared.connection_options import connection_options, without_effect
from fatektool.cli.shared.options import SecondsType, Several
from fatektool.cli.shared.pairs import apart, together
from fatektool.cli.shared.report import report_option, write_report
from fatektool.jobs.linetest.diagnosis import diagnose
from fatektool.jobs.linetest.finding import Case
from fatektool.jobs.linetest.loopback.data import Pattern
from fatektool.jobs.linetest.loopback.result import DEFAULT_COUNT, DEFAULT_SIZES, LoopbackPlan, usual_sizes
from fatektool.jobs.linetest.loopback.run import run_loopback
from fatektool.jobs.linetest.raw_frame import MAX_FRAME, RawFrame
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice


@click.command(
    "loopback",
    epilog="Example: fatektool loopback --count 200 --max-error-rate 0.001 --json -p sim:",
)
@click.option(
    "--count", type=click.IntRange(1), metavar="N", help=f"Number of exchanges.  [default: {DEFAULT_COUNT}]"
)
@click.option(
    "--duration",
    type=SecondsType(0, inf, above=True),
    metavar="S",
    help="Seconds, instead of a number of exchanges.",
)
@click.option(
    "--sizes",
    type=Several(click.IntRange(0, MAX_FRAME)),
    metavar="N,…",
    help=f"Numbers of characters, used in turn: 0 to 256; with --raw up to {MAX_FRAME} with the codes.  "
    f"[default: {','.join(map(str, DEFAULT_SIZES))}]",
)
@click.option(
    "--pattern",
    "patterns",
    type=Several(click.Choice([pattern.value for pattern in Pattern])),
    default=",".join(pattern.value for pattern in Pattern),
    show_default=True,
    metavar="NAME,…",
    help="Patterns of the characters, used in turn.",
)
@click.option(
    "--interval",
    type=SecondsType(0, 86400),
    default=0.0,
    metavar="S",
    help="Time from request to request; 0 for no pause.",
)
@click.option(
    "--max-error-rate",
    type=click.FloatRange(0, 1),
    default=0.0,
    show_default=True,
    metavar="P",
    help="Highest error rate allowed, 0 to 1.",
)
@click.option(
    "--max-p99",
    type=click.FloatRange(0, min_open=True),
    metavar="MS",
    help="Highest 99th percentile of the latency allowed.",
)
@click.option(
    "--raw",
    metavar="START,END",
    help="Instead of 4E: texts between these codes, which a ladder program returns. Bytes in hex, or none.",
)
@click.option(
    "--seed", type=int, default=0, show_default=True, metavar="N", help="Seed of the random pattern."
)
@report_option
@without_effect("retries")
@connection_options
def loopback_command(
    connection: Connection,
    voice: Voice,
    *,
    count: int | None,
    duration: float | None,
    sizes: tuple[int, ...] | None,
    patterns: tuple[str, ...],
    interval: float,
    max_error_rate: float,
    max_p99: float | None,
    raw: str | None,
    seed: int,
    report: Path | None,
) -> int:
    """Test the line: send characters that the PLC must return (4E), and count the errors.

    Nothing is retried: each exchange without the right answer is an error. Exit 1 if a limit is exceeded.
    Ctrl-C ends the test and shows the figures so far.

    With --raw 02,03 each text is sent between these codes and expected back between them, from a ladder
    program that returns what it receives (CLINK, MD2). Station and protocol have no effect then.
    """
    frame = None if raw is None else RawFrame.parse(raw)
    apart("raw", "station", "protocol", why="frames of --raw have neither")
    together("seed", holds=Pattern.RANDOM.value in patterns, needs="--pattern random")
    plan = LoopbackPlan(
        count=DEFAULT_COUNT if count is None and duration is None else count,
        duration_s=duration,
        sizes=usual_sizes(frame) if sizes is None else sizes,
        patterns=tuple(map(Pattern, patterns)),
        interval_s=interval,
        seed=seed,
        max_error_rate=max_error_rate,
        max_p99_ms=max_p99,
        raw=frame,
    )
    with connection.open(voice, needs=(Command.LOOPBACK,) if frame is None else ()) as plc:
        with LiveFigures(voice) as live:
            result = run_loopback(plc, plan, live.update)
        findings = diagnose(Case.of(result, plc.link))
        document = loopback_document(plc, result, findings)
    if result.lost is not None:
        voice.warn(f"the line was lost: {result.lost}")
    if report is not None:
        from fatektool.report.loopback import loopback_report

        write_report(report, loopback_report(document))
    voice.show(document, lines(document))
    if result.ended == "interrupted":
        return INTERRUPTED
    return 1 if result.faults else 0
