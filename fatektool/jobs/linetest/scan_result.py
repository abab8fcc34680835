"""What a scan tries and what it finds."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec
    from fatektool.protocol.status import BriefStatus
    from fatektool.transport.base import LineSettings


@dataclass(frozen=True, slots=True)
class ScanSetting:
    """A protocol with a baud rate and format."""

    codec: Codec
    line: LineSettings


@dataclass(frozen=True, slots=True)
class Station:
    """A station that answered.

    Attributes:
        station: its number.
        setting: with which it answered.
        brief: its brief status; None if it was refused or not asked for.
        latency_s: how long it took; None if that is not known.
        late: True if its answer came after the time-out.
        any_number: True if this PLC answers for every station number.
    """

    station: int
    setting: ScanSetting
    brief: BriefStatus | None
    latency_s: float | None
    late: bool = False
    any_number: bool = False


@dataclass(frozen=True, slots=True)
class Unclear:
    """A station and setting where bytes were received, but no valid frame."""

    station: int
    setting: ScanSetting
    noise_bytes: int


@dataclass(slots=True)
class ScanResult:
    """What a scan found, in the order in which it was found.

    Attributes:
        found: the stations that answered.
        unclear: where bytes were received, but no valid frame.
        refused: settings that this port does not support.
        tried: settings that it supports.
        stations: those that were asked, in order.
        probes: how many requests were sent.
        duration_s: how long it took.
        interrupted: by Ctrl-C.
        out_of_time: True if it ended before all was tried.
    """

    found: list[Station] = field(default_factory=list)
    unclear: list[Unclear] = field(default_factory=list)
    refused: list[ScanSetting] = field(default_factory=list)
    tried: list[ScanSetting] = field(default_factory=list)
    stations: list[int] = field(default_factory=list)
    probes: int = 0
    duration_s: float = 0.0
    interrupted: bool = False
    out_of_time: bool = False
