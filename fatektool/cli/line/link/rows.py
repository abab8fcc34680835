"""The registers of the PLC's ports as rows of name and value; None for what the PLC does not have."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.jobs.plcports.ports import kept_meaning
from fatektool.plcports.settings import DIALLING, PROFILES

if TYPE_CHECKING:
    from fatektool.plcports.ports import Port
    from fatektool.plcports.settings import HighSpeedLink, MessageDetection, Modem


def port_rows(port: Port) -> list[tuple[str, object]]:
    """A communication port."""
    result = port.last_result
    told = None
    if result is not None:
        told = f"{result.code:X}, {kept_meaning(result)}"
        if not result.none_yet:
            told += f" (transaction {result.transaction}, station {result.station})"
    elif port.continuous is False:
        told = "only kept in continuous execution; otherwise see 'fatektool link result'"
    return [
        ("state", _word(port.free, "free", "busy")),
        ("table", _word(port.finished, "last transaction finished", "not finished")),
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


def detection_rows(detection: MessageDetection) -> list[tuple[str, object]]:
    """How the end of a message is found."""
    by_time = detection.by_time
    ends = None if by_time is None else "by R4148" if by_time else "default (M1956 off)"
    return [("end without code", ends), ("R4148", _unit(detection.interval_ms, "ms"))]


def high_speed_rows(link: HighSpeedLink) -> list[tuple[str, object]]:
    """The high-speed link of port 2."""
    station = None
    if link.station is not None:
        station = f"{link.station} ({'set' if link.station_set else 'shown'} by R4055)"
    return [
        ("this PLC", _word(link.slave, "slave", "no slave")),
        ("cycles", _word(link.one_cycle, "one, then stop", "endless")),
        ("master station", link.master_station),
        ("own station", station),
        *abnormal_rows(link),
        ("time-out", f"{link.timeout} (R4160)" if link.timeout is not None else "by the parameters"),
        ("parameters", None if link.parameters is None else f"{link.parameters:04X}H"),
    ]


def modem_rows(modem: Modem) -> list[tuple[str, object]]:
    """The modem of port 1."""
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


def abnormal_rows(link: HighSpeedLink) -> list[tuple[str, object]]:
    """The errors of the high-speed link: R4058 and R4059."""
    station, count = link.abnormal_station, link.abnormal_count
    logged = None
    if count is not None:
        logged = f"{count}, {link.abnormal}" if link.abnormal else count
    return [
        ("abnormal station", None if station is None else f"{station or 'none'} (R4058)"),
        ("abnormal answers", None if logged is None else f"{logged} (R4059)"),
    ]
