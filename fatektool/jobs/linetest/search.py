"""The search for a PLC that does not answer as it was asked: other stations, baud rates and formats.

On a serial line the factory station and the one that was asked are tried at all settings first, then the
lowest stations, at all settings too. Over a network there are stations alone.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from fatektool.jobs.linetest.finding import Finding
from fatektool.jobs.linetest.scan import scan
from fatektool.jobs.linetest.scan_result import ScanResult, ScanSetting, Station
from fatektool.protocol.line_settings import BAUDS, FORMATS
from fatektool.system.shell import own_command_line
from fatektool.transport.base import LineSettings

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.client import Plc

LONGEST_S: Final = 120.0
FACTORY_STATION: Final = 1
LAST_STATION: Final = 8
"""Stations are numbered from 1, and most lines have few."""
SHORT_TIMEOUT_S: Final = 0.2
"""For the many other stations: a PLC answers once per scan, some milliseconds."""


def search(plc: Plc, on_step: Callable[[str, int, int], object]) -> ScanResult:
    """Look for a PLC at other stations and settings; end with the first, and set the line as it was.

    Args:
        plc: the one that does not answer.
        on_step: gets the step, how much of it is done, and of how much.

    Raises:
        LineError: the line was lost.
        KeyboardInterrupt: Ctrl-C.
    """
    link = plc.link
    likely = sorted({FACTORY_STATION, link.station})
    others = [station for station in range(1, LAST_STATION + 1) if station not in likely]
    try:
        found = _scan(plc, likely, link.timeout_s, LONGEST_S, on_step)
        if not found.found:
            timeout_s = min(link.timeout_s, SHORT_TIMEOUT_S) if _is_serial(plc) else link.timeout_s
            more = _scan(plc, others, timeout_s, LONGEST_S - found.duration_s, on_step)
            found = _together(found, more)
    finally:
        link.transport.configure(link.line)
    return found


def answers_elsewhere(plc: Plc, found: Station) -> Finding:
    """What the search found, with the whole command to use."""
    line, codec = found.setting.line, found.setting.codec
    words = ["status", "-p", plc.target, "-s", str(found.station)]
    where = ""
    if _is_serial(plc):
        words += ["--baud", str(line.baud), "--line", line.format]
        where = f" at {line}"
    if codec.name != "facon":
        words += ["--protocol", codec.name]
    return Finding(
        "answers-elsewhere",
        fault=True,
        finding=f"station {found.station} answers{where}",
        evidence="one exchange of its brief status (40)",
        advice=f"use: {own_command_line(*words)}",
    )


def _is_serial(plc: Plc) -> bool:
    return plc.link.transport.serial_settings is not None


def _scan(
    plc: Plc,
    stations: Sequence[int],
    timeout_s: float,
    longest_s: float,
    on_step: Callable[[str, int, int], object],
) -> ScanResult:
    link = plc.link
    carried = [form for form in FORMATS if int(form[0]) >= (link.codec.data_bits or 0)]
    lines = [LineSettings(baud, form) for form in carried for baud in BAUDS]
    settings = [ScanSetting(link.codec, line) for line in (lines if _is_serial(plc) else [link.line])]
    found = scan(
        link.transport,
        settings,
        stations,
        timeout_s=timeout_s,
        retries=0,
        most=1,
        longest_s=longest_s,
        on_probe=lambda done, total: on_step(f"stations {stations[0]}-{stations[-1]}", done, total),
    )
    if found.interrupted:
        raise KeyboardInterrupt
    return found


def _together(one: ScanResult, other: ScanResult) -> ScanResult:
    return replace(
        one,
        found=other.found,
        unclear=[*one.unclear, *other.unclear],
        stations=sorted({*one.stations, *other.stations}),
        probes=one.probes + other.probes,
        duration_s=one.duration_s + other.duration_s,
        out_of_time=other.out_of_time,
    )
