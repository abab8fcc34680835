"""Running a job on many PLCs: their selection, the output as they end, the document, the exit code."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import partial, wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli import Interrupted
from fatektool.cli.many.documents import FleetRun, fleet_document
from fatektool.cli.many.fleet.view import View
from fatektool.cli.many.fleet.words import not_done_words, summary_words
from fatektool.cli.many.outcome import JobResult, Outcome, failure
from fatektool.cli.shared.connection import Connection
from fatektool.cli.shared.inventory_file import inventory_option, open_inventory, select_option
from fatektool.cli.shared.options import deadline_option, voice_options
from fatektool.errors import FatektoolError
from fatektool.files.times import utc
from fatektool.inventory.select import select
from fatektool.jobs.fleet.lines import addresses_of, line_name
from fatektool.jobs.fleet.rounds import Fleet, Task

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.cli.many.alarms import Alarms
    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc
    from fatektool.inventory.entries import Inventory, PlcEntry
    from fatektool.jobs.fleet.rounds import Turn
    from fatektool.protocol.commands import Command

F = TypeVar("F", bound="Callable[..., Any]")

_LOOK_S = 0.2
_NEWS = "fatektool.news"


@dataclass(frozen=True, slots=True)
class Orders:
    """The options of a fleet command.

    Attributes:
        inventory: all PLCs.
        entries: the selected ones.
        jobs: so many lines at once.
        deadline_s: how long one PLC may take.
    """

    inventory: Inventory
    entries: list[PlcEntry]
    jobs: int
    deadline_s: float


def fleet_options(function: F) -> F:
    """Which PLCs, how many at once, how long each; the command gets ``orders`` and ``voice``."""

    @inventory_option
    @select_option
    @click.option(
        "--jobs",
        type=click.IntRange(1, 1000),
        default=16,
        show_default=True,
        metavar="N",
        help="Number of lines at the same time.",
    )
    @deadline_option(1800.0, "Time limit for one PLC.")
    @voice_options
    @wraps(function)
    def with_orders(
        *args: Any, inventory: Path | None, words: tuple[str, ...], jobs: int, deadline: float, **rest: Any
    ) -> Any:
        found = open_inventory(inventory)
        return function(*args, orders=Orders(found, select(found, words), jobs, deadline), **rest)

    return with_orders  # type: ignore[return-value]  # click's decorators hand back what they get


def news_option(function: F) -> F:
    """``--news``, for a command that prints a line for each PLC."""

    def keep(context: click.Context, _: click.Parameter, value: bool) -> None:  # click's call
        context.meta[_NEWS] = value

    return click.option(
        "--news",
        is_flag=True,
        expose_value=False,
        callback=keep,
        help="Print only PLCs that failed, differ or have changed.",
    )(function)


def _only_news() -> bool:
    context = click.get_current_context(silent=True)
    return context is not None and bool(context.meta.get(_NEWS))


def run_fleet(
    job: str,
    orders: Orders,
    alarms: Alarms,
    voice: Voice,
    work: Callable[[PlcEntry, Turn[JobResult]], JobResult],
    *,
    lines: bool = True,
) -> tuple[dict[str, Any], bool]:
    """Do a job with each PLC, and report each as it ends.

    Args:
        job: the name of the command.
        orders: which PLCs, and how.
        alarms: gets the outcomes.
        voice: prints.
        work: does the job with one PLC, in a thread.
        lines: False for a job that does not print a line for each PLC.

    Returns:
        ``fatektool.fleet/1``, and True if it was interrupted.
    """
    time_, began = utc(), time.perf_counter()
    addresses = addresses_of(entry.address.target for entry in orders.entries)
    tasks = [
        Task(entry.name, line_name(entry.address, entry.name, addresses), partial(work, entry))
        for entry in orders.entries
    ]
    entries = {entry.name: entry for entry in orders.entries}
    outcomes: dict[str, Outcome] = {}
    interrupted = False

    def report(turn: Turn[JobResult]) -> None:
        outcome = _outcome(entries[turn.task.name], turn)
        # A document may be large, and an error holds the frames with what was read so far.
        turn.result = turn.error = None
        if not voice.json:
            outcome = replace(outcome, result=replace(outcome.result, document=None))
        outcomes[outcome.name] = outcome
        view.line(outcome)
        alarms.notify(job, outcome, voice)

    view = View(job, list(entries), voice, lines=lines, news=_only_news())
    with view, Fleet(tasks, orders.jobs, orders.deadline_s) as fleet:
        try:
            for turn in fleet.ended(_LOOK_S if view.live else None):
                if turn is not None:
                    report(turn)
                view.refresh(fleet)
        except KeyboardInterrupt:
            interrupted = True
            fleet.stop()
            for turn in fleet.turns:  # some may have ended meanwhile
                if not turn.interrupted and turn.task.name not in outcomes:
                    report(turn)
    for entry in orders.entries:
        if entry.name not in outcomes:
            error = Interrupted("interrupted before it was done")
            outcomes[entry.name] = Outcome(
                entry.name, entry.address.target, entry.address.station, 0.0, failure(error)
            )
    alarms.write(set(orders.inventory.plcs), voice)
    ordered = [outcomes[entry.name] for entry in orders.entries]
    run = FleetRun(job, time_, time.perf_counter() - began, orders.inventory.file, ordered, interrupted)
    return fleet_document(run), interrupted


def opened(entry: PlcEntry, turn: Turn[JobResult], voice: Voice, *needs: Command) -> Plc:
    """The PLC, connected within the limit of its turn."""
    return Connection(entry.address, entry).open(
        voice.of(entry.name), needs=needs, limit=turn.limit, shared=turn.shared
    )


def ended(job: str, document: dict[str, Any], voice: Voice, alarms: Alarms, *, interrupted: bool) -> int:
    """Print document and summary; give the exit code: 0 if all are done, 1 if some failed or differ."""
    voice.show(document, ())
    voice.say(", ".join(summary_words(job, document)))
    from fatektool.cli import failed

    if interrupted:
        return failed(Interrupted(f"interrupted; not done: {not_done_words(document)}"), as_json=False)
    if alarms.lost is not None:
        return failed(alarms.lost, as_json=False)
    return 1 if document["summary"]["failed"] else 0


def _outcome(entry: PlcEntry, turn: Turn[JobResult]) -> Outcome:
    result = turn.result
    if result is None:
        result = failure(turn.error or FatektoolError("no result"))
    return Outcome(entry.name, entry.address.target, entry.address.station, turn.duration_s or 0.0, result)
