"""``monitor`` without a terminal: one NDJSON line a round."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING

import click

from fatektool.cli.programs.monitor.documents import monitor_document
from fatektool.cli.programs.monitor.why import say_of_program
from fatektool.cli.shared.rounds import paced_rounds
from fatektool.cli.shared.streams import output_loss

if TYPE_CHECKING:
    from fatektool.cli.shared.output import Voice
    from fatektool.cli.shared.rounds import RoundTimes
    from fatektool.client import Plc
    from fatektool.errors import LineError
    from fatektool.jobs.monitor.live import Monitor


def print_rounds(plc: Plc, monitor: Monitor, pace: RoundTimes, voice: Voice) -> bool:
    """Print a line a round; False if an element of the last had no value.

    Raises:
        LineError: no answer, for long or from the beginning.
    """
    said = None
    found = None

    def failed(_: LineError) -> None:
        """What is lost is said by the rounds."""

    for found in paced_rounds(plc, monitor.read, pace, failed=failed, voice=voice):
        known = (monitor.program.sameness, monitor.program.reason)
        if known != said:
            said = known
            say_of_program(monitor.program, voice)
        click.echo(json.dumps(monitor_document(plc, monitor, found), allow_nan=False))
        sys.stdout.flush()
        if output_loss() is not None:
            break
    return found is None or not found.errors
