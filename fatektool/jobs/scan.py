"""Who is on the line: which stations answer, at which speed and format, in which protocol.

A probe is what the codec says, a brief status (40) or a register, sent once: silence is the usual answer, and
its deadline is all that a scan is made of. A refusal is somebody too. What is heard and is no frame makes a
probe be repeated, as it may be an answer come to grief. A late answer says itself which station it is of, so
it counts as well as one in time.

Order: the PLCs of one line share one setting. So the first station is tried at every setting before the
others are; then the settings that answered are scanned to the end, then the rest.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf
from typing import TYPE_CHECKING, Final

from fatektool.errors import FrameError, PlcBusy, PlcRefused, TransportClosed, TransportTimeout, UsageError
from fatektool.protocol.codec import require_station
from fatektool.protocol.status import BriefStatus

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from fatektool.protocol.codec import Codec, Frame
    from fatektool.transport.base import LineSettings, Transport

_READ_BYTES: Final = 4096
_MOST_CLOSED: Final = 3


@dataclass(frozen=True, slots=True)
class Setting:
    """A protocol at a speed and format."""

    codec: Codec
    line: LineSettings


@dataclass(frozen=True, slots=True)
class Station:
    """A station that answered.

    Attributes:
        station: as it answered.
        setting: at which it did.
        brief: its brief status; None if it refused to tell, or was not asked.
        latency_s: how long it took; None if its answer came late.
    """

    station: int
    setting: Setting
    brief: BriefStatus | None
    latency_s: float | None


@dataclass(frozen=True, slots=True)
class Unclear:
    """A place where something was heard, and no frame of it."""

    station: int
    setting: Setting
    noise_bytes: int


@dataclass(slots=True)
class ScanResult:
    """What a scan found, in the order it was found."""

    found: list[Station] = field(default_factory=list)
    unclear: list[Unclear] = field(default_factory=list)
    probes: int = 0
    duration_s: float = 0.0
    interrupted: bool = False


def scan(
    transport: Transport,
    settings: Sequence[Setting],
    stations: Sequence[int],
    *,
    timeout_s: float,
    retries: int = 3,
    most: int | None = None,
    on_found: Callable[[Station], object] = lambda _: None,
    on_probe: Callable[[int, int], object] = lambda _done, _total: None,
) -> ScanResult:
    """Ask every station at every setting, until the end or Ctrl-C.

    Args:
        transport: the medium; its speed is set anew for each setting.
        settings: which to try, the likeliest first.
        stations: 0 to 255 each; one that a setting's protocol does not have is not asked there.
        timeout_s: a PLC's time to answer, beside wire time.
        retries: further probes where something was heard that is no frame.
        most: end when so many were found; None for all.
        on_found: is told each station at once.
        on_probe: is told how many probes are done, and how many there are.

    Raises:
        LineError: the medium is gone, or does not take a setting.
    """
    if not settings or not stations:
        raise UsageError("scan: expected settings, and stations such as 1 to 254")
    for setting in settings:
        if not any(station in setting.codec.stations for station in stations):
            require_station(setting.codec, min(stations))
    result = ScanResult()
    began = transport.clock()
    scanner = _Scanner(transport, settings[0], timeout_s, retries=retries, result=result, on_found=on_found)
    total = sum(station in setting.codec.stations for setting in settings for station in stations)
    try:
        for setting, station in _order(settings, stations, result):
            if station not in setting.codec.stations:
                continue
            scanner.probe(setting, station)
            result.probes += 1
            on_probe(result.probes, total)
            if most is not None and len(result.found) >= most:
                break
    except KeyboardInterrupt:
        result.interrupted = True
    result.duration_s = transport.clock() - began
    return result


def _order(
    settings: Sequence[Setting], stations: Sequence[int], result: ScanResult
) -> Iterator[tuple[Setting, int]]:
    """All pairs; ``result`` is looked at when the first station was asked everywhere."""
    first, *others = stations
    for setting in settings:
        yield setting, first
    answered = [found.setting for found in result.found]
    for setting in sorted(settings, key=lambda setting: setting not in answered):
        for station in others:
            yield setting, station


class _Scanner:
    def __init__(
        self,
        transport: Transport,
        first: Setting,
        timeout_s: float,
        *,
        retries: int,
        result: ScanResult,
        on_found: Callable[[Station], object],
    ) -> None:
        self._transport = transport
        self._timeout_s = timeout_s
        self._retries = retries
        self._result = result
        self._on_found = on_found
        self._setting: Setting | None = None
        self._decoder = first.codec.decoder()
        self._closed = 0
        self._noise_bytes = 0
        self._heard_at = -inf

    def probe(self, setting: Setting, station: int) -> None:
        """Ask one station, again only after noise."""
        if setting != self._setting:
            self._change_to(setting)
        for _ in range(self._retries + 1):
            self._noise_bytes = 0
            if self._ask(setting, station) or not self._noise_bytes:
                return
        self._result.unclear.append(Unclear(station, setting, self._noise_bytes))

    def _change_to(self, setting: Setting) -> None:
        if self._setting is None or setting.line != self._setting.line:
            self._transport.set_line(setting.line)
        self._transport.drain()
        self._setting = setting
        self._decoder = setting.codec.decoder()

    def _ask(self, setting: Setting, station: int) -> bool:
        """One request; True if its station answered."""
        transport, codec = self._transport, setting.codec
        probe = codec.probe
        request = codec.encode(station, probe)
        try:
            self._look_at(transport.drain(), setting)
            self._keep_quiet(setting)
            transport.write(request)
            asked = transport.clock()
            wire_s = (len(request) + codec.answer_bytes(probe)) * setting.line.byte_time_s
            deadline = asked + wire_s + self._timeout_s
            begun = 0.0  # until when the rest of an answer may come that has begun
            while (rest := (begun or deadline) - transport.clock()) > 0:
                try:
                    data = transport.read(_READ_BYTES, rest)
                except TransportTimeout:
                    continue
                self._closed = 0
                if station in self._look_at(data, setting, asked, station):
                    return True
                begun = begun or deadline + wire_s
            if begun:
                self._noise_bytes += self._decoder.clear()
        except TransportTimeout:
            return False
        except TransportClosed:  # a gateway that hangs up on what it does not understand
            self._closed += 1
            if self._closed >= _MOST_CLOSED:
                raise
            transport.renew()
        return False

    def _keep_quiet(self, setting: Setting) -> None:
        """Let the silence pass that the protocol wants between frames, and look at what breaks it."""
        quiet_s = setting.codec.quiet_chars * setting.line.byte_time_s
        while (rest := self._heard_at + quiet_s - self._transport.clock()) > 0:
            try:
                self._look_at(self._transport.read(_READ_BYTES, rest), setting)
            except TransportTimeout:
                continue

    def _look_at(self, data: bytes, setting: Setting, asked: float = 0.0, station: int = 0) -> list[int]:
        """The stations whose answers are in the bytes; ``station`` was asked at ``asked``."""
        answered: list[int] = []
        if data:
            self._heard_at = self._transport.clock()
        self._decoder.feed(data)
        while True:
            try:
                frame = self._decoder.next_frame()
                if frame is None:
                    return answered
                latency_s = self._transport.clock() - asked if frame.station == station else None
                if self._take(frame, setting, latency_s):
                    answered.append(frame.station)
            except FrameError as error:
                self._noise_bytes += len(error.raw)

    def _take(self, frame: Frame, setting: Setting, latency_s: float | None) -> bool:
        """True for an answer; an echo of the request is none."""
        codec, brief = setting.codec, None
        probe = codec.probe
        if not frame.station and 0 not in codec.stations:  # a broadcast: nobody answers under it
            return False
        try:
            if frame.command != codec.code(probe) or frame.raw == codec.encode(frame.station, probe):
                return False
            answer = codec.parse_answer(probe, frame)
            brief = answer if isinstance(answer, BriefStatus) else None
        except (TransportTimeout, UsageError):  # a gateway that found nobody; a station that no frame has
            return False
        except (PlcRefused, PlcBusy):
            pass
        known = [(found.station, found.setting) for found in self._result.found]
        if (frame.station, setting) not in known:
            found = Station(frame.station, setting, brief, latency_s)
            self._result.found.append(found)
            self._on_found(found)
        return True
