"""``link ports``: the communication ports, in words."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import click

from fatektool.cli.elements.values import warn_of
from fatektool.cli.line.link.host import host_document
from fatektool.cli.line.link.result import abnormal_rows, result_document
from fatektool.cli.shared.documents import where
from fatektool.cli.shared.options import Connection, connection_options
from fatektool.cli.shared.output import Voice, table
from fatektool.jobs.plcports.ports import PortsReport, read_ports
from fatektool.plcports.codes import NONE_YET, TRANSACTIONS, meaning, next_step
from fatektool.plcports.kinds import TableKind
from fatektool.plcports.settings import DIALLING, PROFILES

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.client import Plc
    from fatektool.plcports.ports import Port
    from fatektool.plcports.results import TransactionResult
    from fatektool.plcports.settings import HighSpeedLink, Modem

_KEEPERS = (*TRANSACTIONS, TableKind.MD1)
"""The instructions whose last result a port keeps; which of them it was, the registers do not say."""


@click.command("ports", epilog="Example: fatektool link ports -p /dev/ttyUSB0")
@connection_options
def ports_command(connection: Connection, voice: Voice) -> int:
    """Show the communication ports 1 to 4: state, protocol, time-outs, last result; high-speed link, modem.

    What this model does not have is shown as '-', and named on stderr with -v.
    """
    with connection.open(voice) as plc:
        report = read_ports(plc)
        document = _document(plc, report)
    voice.show(document, _lines(report))
    for warning in report.host.warnings():
        voice.warn(warning)
    if voice.verbose:
        warn_of(report.errors, voice)
    elif report.errors:
        voice.say(f"{len(report.errors)} of the registers are not in this PLC; -v names them")
    return 0


def _document(plc: Plc, report: PortsReport) -> dict[str, Any]:
    return {
        "schema": "fatektool.link-ports/1",
        **where(plc),
        "os": host_document(report.host),
        "ports": [
            asdict(port)
            | {
                "parameters": _hex(port.parameters),
                "last_result": None if port.last_result is None else _result_document(port.last_result),
            }
            for port in report.ports
        ],
        "message_detection": asdict(report.detection),
        "high_speed_link": asdict(report.high_speed)
        | {"abnormal": report.high_speed.abnormal, "parameters": _hex(report.high_speed.parameters)},
        "modem": asdict(report.modem),
        "registers": {
            name: bool(value) if name.startswith("M") else f"{value:04X}"
            for name, value in report.raw.items()
        },
        "errors": report.errors,
    }


def _result_document(result: TransactionResult) -> dict[str, Any]:
    return result_document(result, _meaning(result), next_step(result.code, _KEEPERS))


def _meaning(result: TransactionResult) -> str:
    return NONE_YET if result.none_yet else meaning(result.code, _KEEPERS)


def _hex(word: int | None) -> str | None:
    return None if word is None else f"{word:04X}"


def _lines(report: PortsReport) -> Iterator[str]:
    for port in report.ports:
        yield from _block(f"port {port.number}", _port_rows(port))
    by_time = report.detection.by_time
    interval = report.detection.interval_ms
    ends = None if by_time is None else "by R4148" if by_time else "as usual (M1956 off)"
    yield from _block("messages", [("end without code", ends), ("R4148", _unit(interval, "ms"))])
    yield from _block("high-speed link (port 2)", _high_speed_rows(report.high_speed))
    yield from _block("modem (port 1)", modem_rows(report.modem))


def _block(title: str, rows: list[tuple[str, object]]) -> Iterator[str]:
    yield title
    for line in table((name, "-" if value is None else value) for name, value in rows):
        yield f"  {line}"


def _port_rows(port: Port) -> list[tuple[str, object]]:
    result = port.last_result
    told = None
    if result is not None:
        told = f"{result.code:X}, {_meaning(result)}"
        if not result.none_yet:
            told += f" (transaction {result.transaction}, station {result.station})"
    elif port.continuous is False:
        told = "kept for continuous execution alone; else see 'fatektool link result'"
    return [
        ("state", _word(port.free, "free", "busy")),
        ("table", _word(port.finished, "last transaction finished", "not at its end")),
        ("as a slave", port.protocol),
        ("parameters", None if port.parameters is None else f"{port.parameters:04X}H"),
        ("TX delay", _unit(port.tx_delay_s, "s")),
        ("RX time-out", _timeout(port)),
        ("transaction", _unit(port.minimum_scans, "scans at least")),
        ("one edge starts", _word(port.continuous, "all transactions", "one transaction")),
        ("last result", told),
    ]


def _timeout(port: Port) -> str | None:
    if port.rx_timeout_s is None:
        return None
    return f"{port.rx_timeout_s:g} s (in units of {port.rx_timeout_unit_s:g} s)"


def _high_speed_rows(link: HighSpeedLink) -> list[tuple[str, object]]:
    station = None
    if link.station is not None:
        station = f"{link.station} ({'set' if link.station_set else 'shown'} by R4055)"
    return [
        ("this PLC", _word(link.slave, "slave", "no slave")),
        ("cycles", _word(link.one_cycle, "one, then stop", "for ever")),
        ("master station", link.master_station),
        ("own station", station),
        *abnormal_rows(link),
        ("time-out", f"{link.timeout} (R4160)" if link.timeout is not None else "by the parameters"),
        ("parameters", None if link.parameters is None else f"{link.parameters:04X}H"),
    ]


def modem_rows(modem: Modem) -> list[tuple[str, object]]:
    """The modem of port 1 by name and value; None for what the PLC does not have."""
    control = modem.dial_control
    profile = modem.profile
    dialling = None if control is None else f"{control}, {DIALLING.get(control, DIALLING[4])}"
    settings = None if profile is None else PROFILES.get(profile, f"{profile}, not in the paper")
    state = "connected" if modem.connected else "failed" if modem.failed else "not connected"
    return [
        ("modem", _word(modem.on, "on", "off")),
        ("phone number", modem.phone_number or "none"),
        ("dials by", _word(modem.pulse_dialling, "pulses", "tones")),
        ("dial (M1964)", _word(modem.dial, "on", "off")),
        ("connection", None if modem.connected is None else state),
        ("dial control", dialling),
        ("settings", settings),
        ("answers after", _unit(modem.rings, "rings")),
    ]


def _word(value: bool | None, yes: str, no: str) -> str | None:
    return None if value is None else yes if value else no


def _unit(value: float | None, unit: str) -> str | None:
    return None if value is None else f"{value:g} {unit}"
