"""``status``: model, mode and state of a PLC."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.shared.colour import bad, word
from fatektool.cli.shared.connection_options import connection_options
from fatektool.cli.shared.output import Voice, table
from fatektool.counts import counted
from fatektool.jobs.status import StatusReport, read_status
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.cli.shared.connection import Connection
    from fatektool.protocol.status import System


@click.command("status", epilog="Example: fatektool status -p sim:")
@click.option("--brief", is_flag=True, help="Only the brief status (40), the shortest exchange.")
@connection_options
def status_command(connection: Connection, voice: Voice, *, brief: bool) -> None:
    """Show model, mode and state of the PLC (40 and 53)."""
    needs = (Command.BRIEF_STATUS,) if brief else (Command.BRIEF_STATUS, Command.DETAILED_STATUS)
    with connection.open(voice, needs=needs) as plc:
        report = read_status(plc, brief=brief)
    document = {}
    if voice.json:
        from fatektool.cli.plc.documents import status_document  # its modules are for JSON alone

        document = status_document(report)
    if report.refused:
        voice.warn(f"{report.refused}: the paper of the M-series has no layout for it; this is from 40 alone")
    voice.show(document, table(_rows(report)))


def _rows(report: StatusReport) -> Iterator[tuple[str, object]]:
    flags = report.flags
    yield "PLC", f"station {report.station} on {report.target}"
    yield "mode", word("RUN" if flags.running else "STOP")
    low = bad("LOW", ": take a backup and a snapshot now, then replace it")
    yield "battery", low if flags.battery_low else word("ok")
    yield (
        "ladder checksum",
        bad("ERROR", ": restore a good backup") if flags.ladder_checksum_error else word("ok"),
    )
    yield "watchdog", bad("TIMED OUT") if flags.watchdog_timeout else word("ok")
    yield "emergency stop", bad("ACTIVE") if flags.emergency_stop else "no"
    if report.brief.m_series:
        yield "memory card", "yes" if flags.rom_pack else "no"
    else:
        yield "ROM pack", "in use: the program cannot be written" if flags.rom_pack else "no"
    yield "ID", "set" if flags.id_set else "not set"
    if not report.brief.m_series:
        yield "model code", f"{report.brief.status2:02X}, {report.brief.model or 'not in the paper'}"
    from fatektool.protocol.status import DetailedStatus, RawStatus  # not before there is one

    match report.detailed:
        case DetailedStatus(system=system, assumed=assumed):
            if assumed:
                yield "detailed status", "layout of FACON assumed: no paper describes that of the M-series"
            yield from _system_rows(system)
        case RawStatus(raw):
            yield (
                "detailed status",
                f"{counted(len(raw), 'byte')} that no paper describes: {raw.hex(' ').upper()}",
            )


def _system_rows(system: System) -> Iterator[tuple[str, object]]:
    yield "main unit", f"type {system.unit_type:02X}, {system.unit_type_name or 'not in the paper'}"
    points = system.points
    yield "main unit points", f"code {system.main_unit_points:02X}, {points or 'not in the paper'}"
    yield "OS version", system.os_version
    yield "ladder size", f"{system.ladder_words} words"
    yield "discrete I/O", f"{system.discrete_inputs} in, {system.discrete_outputs} out"
    yield "analog I/O", f"{system.analog_inputs} in, {system.analog_outputs} out"
    yield "relays", f"{system.m_relays} M, {system.s_relays} S, {system.l_relays} L"
    yield "registers", f"{system.r_registers} R, {system.d_registers} D"
    yield "timers, counters", f"{system.timers}, {system.counters}"
