"""Model, mode and state of a PLC: 40, and 53 unless only the brief status is wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.errors import PlcRefused
from fatektool.protocol.commands import Command, ReadDetailedStatus
from fatektool.value import Value, frozen

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.protocol.status import BriefStatus, DetailedStatus, RawStatus, StatusFlags, System


@frozen
class StatusReport(Value):
    """A PLC's status.

    Attributes:
        time: when it was read, UTC.
        target: as the user named it.
        station: 1 to 254.
        protocol: ``facon`` or ``mseries``.
        brief: the answer to 40.
        detailed: the answer to 53; None if it was not asked for, or refused.
        refused: how an M-series PLC refused 53, whose layout its paper does not have; empty if it did not.
    """

    time: str
    target: str
    station: int
    protocol: str
    brief: BriefStatus
    detailed: DetailedStatus | RawStatus | None
    refused: str = ""

    @property
    def system(self) -> System | None:
        """The answer to 53; None if it was not asked for, or its layout is not known."""
        return getattr(self.detailed, "system", None)

    @property
    def flags(self) -> StatusFlags:
        """The seven flags, from 40."""
        return self.brief.flags


def read_status(plc: Plc, *, brief: bool = False) -> StatusReport:
    """Read a PLC's status.

    Args:
        plc: the PLC.
        brief: only 40.

    Raises:
        LineError: no answer.
        PlcRefused: the PLC refuses 40; or 53, and is none of the M-series.
    """
    short = plc.brief_status()
    detailed, refused = None, ""
    if not brief:
        try:
            detailed = plc.link.ask(ReadDetailedStatus())
        except PlcRefused as error:
            if not short.m_series:
                raise
            refused = error.message
    from fatektool.files.times import utc  # not before there is one

    return StatusReport(utc(), plc.target, plc.link.station, plc.link.codec.name, short, detailed, refused)


def brief_or_none(plc: Plc) -> BriefStatus | None:
    """The answer to 40, as additional information: None where the protocol lacks it or the PLC refuses it.

    Raises:
        LineError: no answer.
    """
    if Command.BRIEF_STATUS not in plc.link.codec.commands:
        return None
    try:
        return plc.brief_status()
    except PlcRefused as error:
        plc.link.note(f"RUN or STOP is not known: {error.message}")
        return None
