"""Running a job on many PLCs: who is meant, what is seen as they end, the document, the exit code."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import partial, wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli import INTERRUPTED, Interrupted
from fatektool.cli.many.alarms import Told
from fatektool.cli.many.fleet.view import View
from fatektool.cli.shared.documents import error_document
from fatektool.cli.shared.inventory_file import complete_names, inventory_option, open_inventory
from fatektool.cli.shared.options import Seconds, voice_options
from fatektool.errors import LineError, PlcError, PortBusy
from fatektool.files.times import utc
from fatektool.inventory.select import select
from fatektool.jobs.fleet.lines import addresses_of, line_of
from fatektool.jobs.fleet.rounds import Fleet, Task

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.cli.many.alarms import Alarms
    from fatektool.cli.many.fleet.jobs import Done
    from fatektool.cli.shared.output import Voice
    from fatektool.inventory.entries import Inventory, PlcEntry
    from fatektool.jobs.fleet.rounds import Turn

F = TypeVar("F", bound="Callable[..., Any]")

_LOOK_S = 0.2
_NEWS = "fatektool.news"
_SLOWEST = 5


@dataclass(frozen=True, slots=True)
class Orders:
    """What the options of a fleet command say.

    Attributes:
        inventory: all PLCs.
        entries: those that are meant.
        jobs: so many lines at once.
        deadline_s: how long one PLC may take.
    """

    inventory: Inventory
    entries: list[PlcEntry]
    jobs: int
    deadline_s: float


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one PLC.

    Attributes:
        entry: the PLC.
        exit_code: of its job; 130 if it was interrupted, or not begun.
        document: of its job; dropped where nobody will see it.
        words: the same on one line.
        duration_s: how long it took.
        changed: True if the program is another than before; None where nobody can tell.
        file: what was written, or compared with; None if there is none.
    """

    entry: PlcEntry
    exit_code: int
    document: dict[str, Any] | None
    words: str
    duration_s: float
    changed: bool | None = None
    file: Path | None = None


def _complete_selection(context: click.Context, _: click.Parameter, incomplete: str) -> list[Any]:
    return complete_names(context.params.get("inventory"), incomplete)


def fleet_options(function: F) -> F:
    """Which PLCs, how many at once, how long each; the command gets ``orders`` and ``voice``."""

    @inventory_option
    @click.option(
        "--select",
        "words",
        multiple=True,
        metavar="NAME|TAG|GLOB",
        shell_complete=_complete_selection,
        help="Only these PLCs; repeat for more.  [default: all]",
    )
    @click.option(
        "--jobs",
        type=click.IntRange(1, 1000),
        default=16,
        show_default=True,
        metavar="N",
        help="So many lines at once.",
    )
    @click.option(
        "--deadline",
        type=Seconds(0, 86400, min_open=True),
        default=1800.0,
        show_default=True,
        metavar="S",
        help="How long one PLC may take, before it is given up.",
    )
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
        help="Print only the PLCs that are not well or have changed.",
    )(function)


def _only_news() -> bool:
    context = click.get_current_context(silent=True)
    return context is not None and bool(context.meta.get(_NEWS))


def run_fleet(
    job: str,
    orders: Orders,
    alarms: Alarms,
    voice: Voice,
    work: Callable[[PlcEntry, Turn[Done]], Done],
    *,
    lines: bool = True,
) -> tuple[dict[str, Any], bool]:
    """Do a job with each PLC, and tell of each as it ends.

    Args:
        job: what is done, as the command is called.
        orders: with whom, and how.
        alarms: who is told.
        voice: how the command talks.
        work: does it with one PLC, in a thread.
        lines: False for a job that prints another thing than a line a PLC.

    Returns:
        ``fatektool.fleet/1``, and True if it was interrupted.
    """
    time_, began = utc(), time.monotonic()
    addresses = addresses_of(entry.target for entry in orders.entries)
    tasks = [
        Task(entry.name, line_of(entry.target, entry.protocol, entry.name, addresses), partial(work, entry))
        for entry in orders.entries
    ]
    entries = {entry.name: entry for entry in orders.entries}
    outcomes: dict[str, Outcome] = {}
    interrupted = False

    def report(turn: Turn[Done]) -> None:
        entry, done = entries[turn.task.name], turn.result
        told = _told(entry, turn)
        outcomes[entry.name] = Outcome(
            entry,
            told.exit_code,
            _document(turn) if voice.json else None,
            told.words,
            told.duration_s,
            None if done is None else done.changed,
            None if done is None else done.file,
        )
        # A document may be large, and an error holds the frames with what was read so far.
        turn.result = turn.error = None
        view.line(told)
        alarms.tell(job, told, voice)

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
    rest = [_not_done(entry) for entry in orders.entries if entry.name not in outcomes]
    outcomes |= {outcome.entry.name: outcome for outcome in rest}
    alarms.write(set(orders.inventory.plcs), voice)
    ordered = [outcomes[entry.name] for entry in orders.entries]
    document = fleet_document(job, orders, ordered, interrupted=interrupted)
    return document | {"time": time_, "duration_s": round(time.monotonic() - began, 3)}, interrupted


def ended(job: str, document: dict[str, Any], voice: Voice, alarms: Alarms, *, interrupted: bool) -> int:
    """Print the document, say how it went, and give the exit code: 0 all well, 1 some not, or the worst."""
    voice.show(document, ())
    summary = document["summary"]
    slowest = document["slowest"][:1]
    words = [f"{job}: {summary['ok']} of {summary['total']} well"]
    if summary["failed"]:
        words.append(f"{summary['failed']} not")
    if summary["changed"]:
        words.append(f"{summary['changed']} changed")
    if summary["not_done"]:
        words.append(f"{summary['not_done']} not done")
    words.append(f"{document['duration_s']:.1f} s")
    words += [f"slowest {each['name']} {each['duration_s']:.1f} s" for each in slowest]
    voice.say(", ".join(words))
    from fatektool.cli import failed

    if interrupted:
        return failed(Interrupted("interrupted"), as_json=False)
    if alarms.lost is not None:
        return failed(alarms.lost, as_json=False)
    return 1 if summary["failed"] else 0


def fleet_document(job: str, orders: Orders, outcomes: list[Outcome], *, interrupted: bool) -> dict[str, Any]:
    """``fatektool.fleet/1``, but for its time and duration."""
    not_done = sum(outcome.exit_code == INTERRUPTED for outcome in outcomes)
    ok = sum(outcome.exit_code == 0 for outcome in outcomes)
    slowest = sorted(outcomes, key=lambda outcome: outcome.duration_s, reverse=True)[:_SLOWEST]
    return {
        "schema": "fatektool.fleet/1",
        "time": "",
        "job": job,
        "inventory": str(orders.inventory.file),
        "duration_s": 0.0,
        "interrupted": interrupted,
        "summary": {
            "total": len(outcomes),
            "ok": ok,
            "failed": len(outcomes) - ok - not_done,
            "changed": sum(outcome.changed is True for outcome in outcomes),
            "not_done": not_done,
        },
        "slowest": [
            {"name": outcome.entry.name, "duration_s": round(outcome.duration_s, 3)}
            for outcome in slowest
            if outcome.duration_s
        ],
        "plcs": [
            {
                "name": outcome.entry.name,
                "target": outcome.entry.target,
                "station": outcome.entry.station,
                "exit_code": outcome.exit_code,
                "duration_s": round(outcome.duration_s, 3),
                "changed": outcome.changed,
                "file": None if outcome.file is None else str(outcome.file),
                "words": outcome.words,
                "document": outcome.document,
            }
            for outcome in outcomes
        ],
    }


def _told(entry: PlcEntry, turn: Turn[Done]) -> Told:
    done, error = turn.result, turn.error
    code, words = (done.exit_code, done.words) if done is not None else (70, "nothing came of it")
    up: bool | None = None if done is None else done.up
    if error is not None:
        code, words = error.exit_code, str(error)
        if isinstance(error, LineError) and not isinstance(error, PortBusy):
            up = False
        elif isinstance(error, PlcError):
            up = True
    if done is not None:  # those who are told may keep it, and look at its document no more
        done = replace(done, document={})
    return Told(entry.name, entry.target, entry.station, code, words, turn.duration_s or 0.0, up, done)


def _document(turn: Turn[Done]) -> dict[str, Any] | None:
    if turn.error is not None:
        return error_document(turn.error)
    return None if turn.result is None else turn.result.document


def _not_done(entry: PlcEntry) -> Outcome:
    error = Interrupted("interrupted before it was done")
    return Outcome(entry, INTERRUPTED, error_document(error), str(error), 0.0)
