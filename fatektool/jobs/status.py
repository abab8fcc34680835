"""What a PLC is and how it is: 40, and 53 unless only the brief status is wanted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.jobs.times import utc

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.protocol.status import BriefStatus, StatusFlags, System


@dataclass(frozen=True, slots=True)
class StatusReport:
    """A PLC's status.

    Attributes:
        time: when it was read, UTC.
        target: as the user named it.
        station: 1 to 254.
        protocol: ``facon``.
        brief: the answer to 40.
        system: what 53 tells; None if it was not asked.
    """

    time: str
    target: str
    station: int
    protocol: str
    brief: BriefStatus
    system: System | None

    @property
    def flags(self) -> StatusFlags:
        """The seven flags, from 40."""
        return self.brief.flags


def read_status(plc: Plc, *, brief: bool = False) -> StatusReport:
    """Read a PLC's status.

    Args:
        plc: the PLC.
        brief: 40 alone.

    Raises:
        LineError: no answer.
        PlcRefused: the PLC refuses one of them.
    """
    short = plc.brief_status()
    system = None if brief else plc.detailed_status().system
    return StatusReport(utc(), plc.target, plc.link.station, plc.link.codec.name, short, system)
