"""``run`` and ``stop``: they change what a machine does, so they ask."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import click

from fatektool.cli.plc.documents import mode_document
from fatektool.cli.shared.addressee import agree, with_status
from fatektool.cli.shared.broadcast import broadcast_option, means_all, send_to_all
from fatektool.cli.shared.colour import joined, word
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.options import yes_option
from fatektool.cli.shared.unfinished import unfinished
from fatektool.errors import PlcError, PlcNotReady, PlcRefused
from fatektool.jobs.write_back.record import RESTORE
from fatektool.protocol.commands import Command, RunStop

if TYPE_CHECKING:
    from fatektool.cli.shared.connection import Connection
    from fatektool.cli.shared.output import Voice
    from fatektool.client import Plc


@click.command("run", epilog="Example: fatektool run -p sim: --yes")
@broadcast_option
@yes_option
@connection_options
def run_command(connection: Connection, voice: Voice, *, broadcast: bool, yes: bool) -> None:
    """Put the PLC into RUN (41) and read the mode back. The machine may move."""
    _change(connection, voice, run=True, broadcast=broadcast, yes=yes)


@click.command("stop", epilog="Example: fatektool stop -p sim: --yes")
@broadcast_option
@yes_option
@connection_options
def stop_command(connection: Connection, voice: Voice, *, broadcast: bool, yes: bool) -> None:
    """Put the PLC into STOP (41) and read the mode back. The machine is no longer controlled."""
    _change(connection, voice, run=False, broadcast=broadcast, yes=yes)


def _require_whole_program(plc: Plc, connection: Connection, voice: Voice) -> None:
    """Refuse to RUN half of a restore. The program is read only where a restore did not complete.

    Raises:
        PlcNotReady: the program is half the previous and half a new one.
    """
    address = connection.address
    for record in unfinished(address.target, address.station):
        if record.job != RESTORE:
            continue
        from fatektool.jobs.programs.half import is_half

        with voice.progress() as bar:
            half = is_half(plc, record, bar.update)
        if half:
            raise PlcNotReady(
                f"the PLC stays in STOP: it has pages of {record.file} and pages of the program before it, "
                "as a restore did not complete",
                hint=f"finish the restore: {record.command}",
            )


def _change(connection: Connection, voice: Voice, *, run: bool, broadcast: bool, yes: bool) -> None:
    mode = "RUN" if run else "STOP"
    if means_all(connection, broadcast=broadcast):
        send_to_all(connection, voice, mode, [RunStop(run)], yes=yes)
        return
    with connection.open(voice, needs=(Command.RUN_STOP,), writes=True) as plc:
        try:
            here = with_status(plc, plc.brief_status())
        except PlcRefused as error:
            raise PlcError(
                f"{mode} was not sent: the present mode cannot be read: {error.message}"
            ) from error
        before = here.running
        if before != run:
            question = f"Station {here.station} on {here.target} is in {here.mode}. {mode}?"
            agree(
                voice,
                [] if yes else [("model", here.model or "unknown")],
                [],
                question,
                yes=yes,
                unchanged=f"the PLC stays in {here.mode}",
            )
            if run:
                _require_whole_program(plc, connection, voice)
                plc.run()
            else:
                plc.stop()
        document = mode_document(plc, here, mode.lower())
    already = " already" if before == run else ""
    voice.show(document, [joined("the PLC is in ", word(mode), already), replace(here, running=None).line])
