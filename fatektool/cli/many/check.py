"""``check``: a plugin for Nagios, Icinga, Checkmk, Zabbix and others that start one."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import click

from fatektool.cli.many.alarms import Alarms, alarm_options
from fatektool.cli.many.outcome import Outcome
from fatektool.cli.many.plugin import PluginCommand, plugin_line
from fatektool.cli.many.run_check import check_result, found_document, run_check
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.options import PATH, deadline_option
from fatektool.cli.shared.pairs import apart, together
from fatektool.errors import UsageError
from fatektool.inventory.values import EXPECTATIONS
from fatektool.jobs.check.age import parse_age
from fatektool.jobs.check.plc import CheckPlan
from fatektool.jobs.check.result import State
from fatektool.transport.limit import Limit

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice


@click.command(
    "check",
    cls=PluginCommand,
    epilog="Example: fatektool check -p sim: --reference press.json --expect any",
)
@click.option(
    "--expect",
    type=click.Choice(EXPECTATIONS),
    help="Expected mode.  [default: that of the inventory, else run]",
)
@click.option(
    "--reference",
    type=PATH,
    metavar="BACKUP",
    help="Expected program.  [default: that of the inventory]",
)
@click.option("--no-reference", is_flag=True, help="Do not compare the program, which takes time.")
@click.option("--backup", type=PATH, metavar="BACKUP", help="The last backup, checked too.")
@click.option("--max-age", metavar="AGE", help="Maximum age of the backup: 36h, 7d.")
@deadline_option(600.0, "Time limit.")
@alarm_options(changes=True, place_first=False)
@connection_options
def check_command(
    connection: Connection,
    voice: Voice,
    alarms: Alarms,
    *,
    expect: str | None,
    reference: Path | None,
    no_reference: bool,
    backup: Path | None,
    max_age: str | None,
    deadline: float,
) -> int:
    """Check a PLC as a monitoring plugin: exit 0 OK, 1 WARNING, 2 CRITICAL, 3 UNKNOWN, and one line.

    Checked are: whether the PLC answers, its mode, battery, ladder checksum, watchdog and emergency stop;
    unfinished restores and other writes; the program against the reference; the last backup and its age.
    """
    if max_age is not None and backup is None:
        raise UsageError("--max-age goes with --backup FILE")
    apart("reference", "no_reference")
    entry = connection.entry
    if entry is not None and reference is None:
        reference = entry.reference
    plan = CheckPlan(
        expect or ("run" if entry is None else entry.expect),
        None if no_reference else reference,
        backup,
        None if max_age is None else parse_age(max_age),
    )
    together("on_change", holds=plan.reference is not None, needs="a reference, with which to compare")
    name = connection.address.target if entry is None else entry.name
    began = time.perf_counter()
    found = run_check(connection, plan, voice, limit=Limit(deadline))
    result = check_result(connection, name, plan, found)
    outcome = Outcome(
        name, connection.address.target, connection.address.station, time.perf_counter() - began, result
    )
    alarms.notify("check", outcome, voice)
    alarms.write({name}, voice)
    if alarms.lost is not None:
        found.add(State.UNKNOWN, f"figures NOT WRITTEN: {alarms.lost.message}")
    words = f"{name}: {found.words.removeprefix(f'{name}: ')}"
    document = found_document(connection, name, found)
    voice.show(document, [plugin_line(found.state, words, found.figures)])
    return int(found.state)
