"""``check``: a plugin for Nagios, Icinga, Checkmk, Zabbix and others that start one."""

from __future__ import annotations

import time
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.many.alarms import Alarms, Told, alarm_options
from fatektool.cli.many.fleet.jobs import Done
from fatektool.cli.many.plugin import PluginCommand, check_document, plugin_line
from fatektool.cli.shared.options import PATH, Connection, Seconds, connection_options
from fatektool.cli.shared.pairs import apart, together
from fatektool.cli.shared.unfinished import unfinished_document
from fatektool.errors import FatektoolError, UsageError
from fatektool.inventory.values import EXPECTATIONS
from fatektool.jobs.fleet.check import Checked, State, check_backup, check_plc, parse_age
from fatektool.jobs.progress import Progress, no_progress
from fatektool.transport.limit import Limit

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.cli.shared.output import Voice
    from fatektool.transport.shared_line import SharedLine


@dataclass(frozen=True, slots=True)
class Plan:
    """What is looked at beside the PLC's status.

    Attributes:
        expect: ``run``, ``stop`` or ``any``.
        reference: the backup whose program ought to be in it; None for none.
        backup: the last backup; None for none.
        max_age_s: how old that may be; None for any age.
    """

    expect: str
    reference: Path | None
    backup: Path | None
    max_age_s: float | None


@click.command(
    "check",
    cls=PluginCommand,
    epilog="Example: fatektool check -p /dev/ttyUSB0 --reference press.json --expect run",
)
@click.option(
    "--expect",
    type=click.Choice(EXPECTATIONS),
    help="The mode it ought to be in.  [default: that of the inventory, else run]",
)
@click.option(
    "--reference",
    type=PATH,
    metavar="BACKUP",
    help="The program that ought to be in it.  [default: that of the inventory]",
)
@click.option("--no-reference", is_flag=True, help="Do not read the program: a look of a moment.")
@click.option("--backup", type=PATH, metavar="BACKUP", help="The last backup, which must be a good one.")
@click.option("--max-age", metavar="AGE", help="How old that may be: 36h, 7d.")
@click.option(
    "--deadline",
    type=Seconds(0, 86400, min_open=True),
    default=600.0,
    show_default=True,
    metavar="S",
    help="How long it may take in all.",
)
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

    Looks at whether it answers, its mode, battery, ladder checksum, watchdog and emergency stop; whether a
    restore into it was left unfinished; whether its program is the reference; whether there is a good
    backup, and how old.
    """
    if max_age is not None and backup is None:
        raise UsageError("--max-age goes with --backup FILE")
    apart("reference", "no_reference")
    entry = connection.entry
    if entry is not None and reference is None:
        reference = entry.reference
    plan = Plan(
        expect or ("run" if entry is None else entry.expect),
        None if no_reference else reference,
        backup,
        None if max_age is None else parse_age(max_age),
    )
    together("on_change", holds=plan.reference is not None, needs="a reference, with which to compare")
    name = connection.target if entry is None else entry.name
    began = time.monotonic()
    found = Checked()
    done = check_one(connection, name, plan, voice, found, limit=Limit(deadline))
    told = Told(
        name,
        connection.target,
        connection.station,
        done.exit_code,
        done.words,
        time.monotonic() - began,
        done.up,
        done,
    )
    alarms.tell("check", told, voice)
    alarms.write({name}, voice)
    if alarms.lost is not None:
        found.add(State.UNKNOWN, f"figures NOT WRITTEN: {alarms.lost.message}")
        done = _done(connection, name, plan, found)
    voice.show(done.document, [done.line])
    return done.exit_code


@dataclass(frozen=True, slots=True)
class CheckDone(Done):
    """What a check found, with its line as a plugin prints it."""

    line: str = ""


def check_one(
    connection: Connection,
    name: str,
    plan: Plan,
    voice: Voice,
    found: Checked,
    *,
    limit: Limit,
    shared: SharedLine | None = None,
    progress: Progress = no_progress,
) -> CheckDone:
    """Look at one PLC, and at its backup whether it answers or not; ``found`` takes the facts."""
    try:
        with connection.open(voice, limit=limit, shared=shared) as plc:
            check_plc(plc, found, expect=plan.expect, reference=plan.reference, progress=progress)
    except FatektoolError as error:
        found.fail(error)
    unfinished = unfinished_document(connection.target, connection.station)
    if unfinished is not None and found.differs is not False:  # the reference's program is whole
        found.add(State.CRITICAL, f"restore UNFINISHED since {unfinished['time']}: it must not RUN")
    if plan.backup is not None:
        check_backup(plan.backup, found, max_age_s=plan.max_age_s, now=datetime.now(UTC))
    return _done(connection, name, plan, found)


def _done(connection: Connection, name: str, plan: Plan, found: Checked) -> CheckDone:
    place: dict[str, Any] = {
        "target": connection.target,
        "station": connection.station,
        "protocol": connection.protocol,
    }
    return CheckDone(
        int(found.state),
        check_document(found.state, found.words, found, name=name, **place),
        found.words,
        plan.reference,
        found.differs,
        found.flags,
        found.flags is not None,
        line=plugin_line(found.state, f"{name}: {found.words.removeprefix(f'{name}: ')}", found.figures),
    )
