"""Rounds on time over one line, which others may have between two of them."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from fatektool.cli.shared.documents import error_document
from fatektool.cli.shared.options import SecondsType
from fatektool.cli.shared.output import print_stderr, with_prefix
from fatektool.errors import FatektoolError, LineError, TransportClosed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc

_MOST_FAILURES: Final = 10
T = TypeVar("T")
F = TypeVar("F", bound="Callable[..., Any]")


@dataclass(frozen=True, slots=True)
class RoundTimes:
    """How often rounds are read.

    Attributes:
        interval_s: from round to round.
        count: so many rounds; None for no end.
    """

    interval_s: float
    count: int | None = None


def rounds_options(default: str) -> Callable[[F], F]:
    """``--interval`` and ``--count``; the command gets both, None for what is not given.

    Args:
        default: the interval then, in words.
    """

    def decorate(function: F) -> F:
        count = click.option(
            "--count",
            type=click.IntRange(1),
            metavar="N",
            help="Number of rounds; by default until q or Ctrl-C.",
        )
        interval = click.option(
            "--interval",
            type=SecondsType(0, 86400),
            metavar="S",
            help=f"Time from round to round; by default {default}.",
        )
        return interval(count(function))

    return decorate


def paced_rounds(
    plc: Plc,
    read: Callable[[], T],
    pace: RoundTimes,
    *,
    failed: Callable[[LineError], object],
    voice: Voice | None,
    sleep: Callable[[float], object] | None = None,
    clock: Callable[[], float] = time.perf_counter,
) -> Iterator[T]:
    """What each round reads, on time.

    Args:
        plc: the PLC.
        read: reads one round.
        pace: how often, and how many.
        failed: is called for each round that failed.
        voice: warns of them; many in a row, or the first of all, then end it. None goes on for ever.
        sleep: waits; it may raise to end the rounds. None for ``time.sleep``.
        clock: seconds.

    Raises:
        LineError: no answer, for long or from the beginning.
    """
    due = clock()
    failures = done = 0
    while pace.count is None or done < pace.count:
        broken = False
        try:
            plc.take()
            found = read()
        except LineError as error:
            broken = isinstance(error, TransportClosed)
            failures += 1
            failed(error)
            if voice is not None:
                if failures >= _MOST_FAILURES or not done:
                    raise
                voice.warn(f"{error.message}; trying again")
        else:
            failures = 0
            done += 1
            yield found
        due = max(due + pace.interval_s, clock())
        if pace.count is None or done < pace.count:
            plc.lend(max(0.0, due - clock()), broken=broken, sleep=sleep)


def failed_in_line(error: FatektoolError | KeyboardInterrupt) -> int:
    """Say what went wrong in one line of NDJSON, as all before it, and one on stderr."""
    from fatektool.cli import Interrupted

    told = error if isinstance(error, FatektoolError) else Interrupted("interrupted")
    click.echo(json.dumps(error_document(told)))
    print_stderr(with_prefix("fatektool:", " ".join(str(told).split()), bad=True))
    return told.exit_code
