"""``fleet status``: mode and state of the PLCs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.many.alarms import Alarms, alarm_options
from fatektool.cli.many.fleet.run import Orders, ended, fleet_options, news_option, opened, run_fleet
from fatektool.cli.many.outcome import JobResult
from fatektool.cli.plc.documents import status_document
from fatektool.jobs.status import read_status

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.cli.shared.output import Voice
    from fatektool.inventory.entries import PlcEntry
    from fatektool.jobs.fleet.rounds import Turn
    from fatektool.protocol.status import StatusFlags


@click.command("status", epilog="Example: fatektool fleet status --select hall-1")
@click.option("--brief", is_flag=True, help="Only the brief status (40).")
@alarm_options(changes=False)
@news_option
@fleet_options
def status_command(orders: Orders, alarms: Alarms, voice: Voice, *, brief: bool) -> int:
    """Show mode and state of the PLCs."""
    document, interrupted = run_fleet("status", orders, alarms, voice, _work(voice, brief=brief))
    return ended("status", document, voice, alarms, interrupted=interrupted)


def _work(voice: Voice, *, brief: bool) -> Callable[[PlcEntry, Turn[JobResult]], JobResult]:
    """``fleet status``."""

    def work(entry: PlcEntry, turn: Turn[JobResult]) -> JobResult:
        with opened(entry, turn, voice) as plc:
            report = read_status(plc, brief=brief)
        return JobResult(0, status_document(report), flag_words(report.flags), flags=report.flags)

    return work


def flag_words(flags: StatusFlags) -> str:
    """RUN or STOP, and the faults that the PLC reports."""
    odd = {
        "battery LOW": flags.battery_low,
        "ladder checksum ERROR": flags.ladder_checksum_error,
        "watchdog TIMED OUT": flags.watchdog_timeout,
        "emergency stop ACTIVE": flags.emergency_stop,
    }
    return ", ".join(["RUN" if flags.running else "STOP", *(word for word, on in odd.items() if on)])
