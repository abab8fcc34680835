"""``fleet verify``: each PLC's program against its reference."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.many.alarms import Alarms, alarm_options
from fatektool.cli.many.fleet.run import Orders, ended, fleet_options, news_option, opened, run_fleet
from fatektool.cli.many.outcome import JobResult
from fatektool.cli.programs.differences import size_of
from fatektool.cli.programs.documents import verify_document
from fatektool.errors import UsageError
from fatektool.jobs.programs.verify import compare_with_plc
from fatektool.project.program_file import load_program
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.cli.shared.output import Voice
    from fatektool.inventory.entries import PlcEntry
    from fatektool.jobs.fleet.rounds import Turn


@click.command("verify", epilog='Example: fatektool fleet verify --on-change "echo changed:"')
@alarm_options(changes=True)
@news_option
@fleet_options
def verify_command(orders: Orders, alarms: Alarms, voice: Voice) -> int:
    """Compare each PLC's program with its reference, the backup that the inventory names."""
    document, interrupted = run_fleet("verify", orders, alarms, voice, _work(voice))
    return ended("verify", document, voice, alarms, interrupted=interrupted)


def _work(voice: Voice) -> Callable[[PlcEntry, Turn[JobResult]], JobResult]:
    """``fleet verify``."""

    def work(entry: PlcEntry, turn: Turn[JobResult]) -> JobResult:
        reference = entry.reference
        if reference is None:
            raise UsageError("no reference in the inventory", hint='add reference = "FILE" there')
        on_file = load_program(reference)
        with opened(entry, turn, voice, Command.READ_PAGE) as plc:
            result = compare_with_plc(plc, on_file, progress=turn.progress)
            document = verify_document(plc, result)
        found = result.found
        if found.pages.b_has_more:
            voice.of(entry.name).warn(f"the PLC has more pages than {reference}: they are not compared")
        words = f"same as {reference}" if found.same else f"DIFFERS from {reference}: {size_of(found)}"
        return JobResult(0 if found.same else 1, document, words, reference, not found.same)

    return work
