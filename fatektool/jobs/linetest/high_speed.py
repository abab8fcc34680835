"""The errors that an FBs logs of its high-speed link (CLINK, MD3), for ``doctor``.

FBs link paper, section 13.1.2, MD3: R4058 and R4059. They are only read from an FBs: their meaning in other
PLCs is not documented.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.errors import LineError, PlcError
from fatektool.jobs.linetest.finding import Finding
from fatektool.jobs.plcports.host import read_host
from fatektool.plcports.settings import ABNORMAL_STEP, UNWATCHED, decode_high_speed
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from fatektool.client import Plc

_REGISTERS: Final = Element("R", 4058), 2


def high_speed_findings(plc: Plc) -> list[Finding]:
    """A finding if an FBs logged an abnormal slave of its high-speed link; nothing for all other PLCs.

    Args:
        plc: the PLC, which has answered already.
    """
    if not read_host(plc).fbs:
        return []
    try:
        station, log = plc.read_registers(*_REGISTERS)
    except (LineError, PlcError):
        return []
    link = decode_high_speed({"R4058": station, "R4059": log})
    if link.good:
        return []
    evidence = f"R4058 = {station}, R4059 = {log:04X}H ({link.abnormal_count} abnormal answers"
    evidence += f", the last: {link.abnormal})" if link.abnormal else ")"
    return [
        Finding(
            "high-speed-link",
            fault=bool(station),
            finding=f"station {station} of the high-speed link (port 2, MD3) is abnormal"
            if station
            else "the high-speed link (port 2, MD3) had abnormal answers since R4059 was cleared",
            evidence=evidence,
            advice=f"{ABNORMAL_STEP}; {UNWATCHED}",
        )
    ]
