"""``fleet check``: the monitoring plugin for many PLCs.

The first line is of all of them; one for each that is not OK follows.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.many.alarms import Alarms, alarm_options
from fatektool.cli.many.fleet.run import Orders, fleet_options, run_fleet
from fatektool.cli.many.plugin import PluginCommand, plugin_line
from fatektool.cli.many.run_check import check_result, run_check
from fatektool.cli.shared.connection import Connection
from fatektool.cli.shared.options import PATH
from fatektool.cli.shared.pairs import apart
from fatektool.errors import UsageError
from fatektool.jobs.check.age import parse_age
from fatektool.jobs.check.plc import CheckPlan
from fatektool.jobs.check.result import State, worst

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.cli.many.outcome import JobResult
    from fatektool.cli.shared.output import Voice
    from fatektool.inventory.entries import PlcEntry
    from fatektool.jobs.fleet.rounds import Turn

_MOST_NAMED = 5


@click.command(
    "check",
    cls=PluginCommand,
    epilog="Example: fatektool fleet check --no-reference --backups backups --max-age 36h",
)
@click.option("--no-reference", is_flag=True, help="Do not compare the programs, which takes time.")
@click.option(
    "--backups",
    type=PATH,
    metavar="DIR",
    help="Folder of the last backups, written by 'fleet backup'.  [default for --max-age: 'backups' of the "
    "inventory]",
)
@click.option("--max-age", metavar="AGE", help="Maximum age of the backups: 36h, 7d.")
@alarm_options(changes=True, place_first=False)
@fleet_options
def check_command(
    orders: Orders,
    alarms: Alarms,
    voice: Voice,
    *,
    no_reference: bool,
    backups: Path | None,
    max_age: str | None,
) -> int:
    """Check the PLCs as one monitoring plugin: exit 0 OK, 1 WARNING, 2 CRITICAL, 3 UNKNOWN, the worst of all.

    Each PLC is checked as by 'check', with the reference and the mode of the inventory.
    """
    if max_age is not None and backups is None:
        backups = orders.inventory.backups
    if max_age is not None and backups is None:
        raise UsageError("--max-age goes with --backups DIR, or 'backups' in [defaults] of the inventory")
    apart("on_change", "no_reference")
    age_s = None if max_age is None else parse_age(max_age)

    def work(entry: PlcEntry, turn: Turn[JobResult]) -> JobResult:
        plan = CheckPlan(
            entry.expect,
            None if no_reference else entry.reference,
            None if backups is None else backups / f"{entry.name}.json",
            age_s,
        )
        limit = turn.limit
        if limit is None:  # it has begun: for the type checker
            raise AssertionError
        connection = Connection(entry.address, entry)
        found = run_check(
            connection,
            plan,
            voice.of(entry.name),
            limit=limit,
            shared=turn.shared,
            progress=turn.progress,
        )
        return check_result(connection, entry.name, plan, found)

    document, interrupted = run_fleet("check", orders, alarms, voice, work, lines=False)
    states = {plc["name"]: _state(plc) for plc in document["plcs"]}
    found = worst(states.values())
    if interrupted or alarms.lost is not None:
        found = worst((found, State.UNKNOWN))
    lost = [] if alarms.lost is None else [f"figures NOT WRITTEN: {alarms.lost.message}"]
    voice.show(document | {"state": found.name}, _lines(document, states, found, lost, voice))
    for words in lost:  # in the plugin's line as well, but not in the document
        voice.warn(words)
    return int(found)


def _state(plc: dict[str, Any]) -> State:
    code = plc["exit_code"]
    return State(code) if code in set(State) else State.UNKNOWN


def _lines(
    document: dict[str, Any], states: dict[str, State], found: State, lost: list[str], voice: Voice
) -> Iterator[str]:
    counts = Counter(states.values())
    parts = []
    for state in (State.CRITICAL, State.WARNING, State.UNKNOWN):
        names = [name for name, its in states.items() if its is state]
        if names:
            more = f" and {len(names) - _MOST_NAMED} more" if len(names) > _MOST_NAMED else ""
            parts.append(f"{len(names)} {state.name}: {', '.join(names[:_MOST_NAMED])}{more}")
    cut = ["interrupted"] if document["interrupted"] else []
    words = "; ".join([f"{counts[State.OK]} of {len(states)} PLCs OK", *parts, *cut, *lost])
    figures = {state.name.lower(): str(counts[state]) for state in State}
    yield plugin_line(found, words, figures | {"duration": f"{document['duration_s']}s;;;0"})
    for plc in document["plcs"]:
        state = states[plc["name"]]
        if state is not State.OK or voice.verbose:
            yield plugin_line(state, f"{plc['name']}: {plc['words']}", {}).removeprefix("FATEK ")
