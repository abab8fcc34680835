"""Which stations are on the line, with which baud rate, format and protocol.

A probe is a request of the codec, for the brief status (40) or a register, sent once: most stations are
silent, and their time-outs are most of a scan's time. A refusal is an answer too. After bytes that are no
valid frame the probe is repeated, as they may be a damaged answer. A late answer has its station in it, so it
counts like one in time.

Order: the PLCs of one line share one setting. So the first station is tried at every setting before the
others are; then the settings that answered are scanned to the end, then the rest.

A port without a station check answers for every number, so a scan would find a PLC at each. So when the
first two stations with a setting give the same answer, and none was silent, numbers far apart are tried. If
all of them give the same answer, it is one PLC, and the setting is done.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING, Final

from fatektool.errors import (
    FrameError,
    LineError,
    PlcBusy,
    PlcRefused,
    TransportClosed,
    TransportTimeout,
    UsageError,
)
from fatektool.jobs.linetest.scan_result import ScanResult, Station, Unclear
from fatektool.protocol.codec import require_station
from fatektool.protocol.status import BriefStatus

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from fatektool.jobs.linetest.scan_result import ScanSetting
    from fatektool.protocol.codec import Frame
    from fatektool.transport.base import Transport

_READ_BYTES: Final = 4096
_MOST_CLOSED: Final = 3
_MOST_REFUSED: Final = 3
_LATE_S: Final = 2.0
_ENOUGH_TO_COMPARE: Final = 2
_FAR_APART: Final = (254, 247, 191, 128)
"""Station numbers that are rarely used, to find a port that answers for every number."""


def scan(
    transport: Transport,
    settings: Sequence[ScanSetting],
    stations: Sequence[int],
    *,
    timeout_s: float,
    retries: int = 3,
    most: int | None = None,
    longest_s: float = inf,
    on_found: Callable[[Station], object] = lambda _: None,
    on_probe: Callable[[int, int], object] = lambda _done, _total: None,
) -> ScanResult:
    """Ask every station at every setting, until the end or Ctrl-C.

    Args:
        transport: the medium; its speed is set anew for each setting.
        settings: which to try, the likeliest first.
        stations: 0 to 255 each; one that a setting's protocol does not have is not asked there.
        timeout_s: a PLC's time to answer, without wire time.
        retries: further probes after bytes that are no valid frame.
        most: end when so many stations were found; None for all.
        longest_s: begin no probe after so many seconds.
        on_found: gets each station at once.
        on_probe: gets how many probes are done, and how many there are.

    Raises:
        LineError: the line is gone, or supports none of the settings.
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
            if station not in setting.codec.stations or not scanner.is_open(setting):
                total -= station in setting.codec.stations
                continue
            if transport.clock() - began > longest_s:
                result.out_of_time = True
                break
            scanner.probe(setting, station)
            result.probes += 1
            on_probe(result.probes, max(total, result.probes))
            if most is not None and len(result.found) >= most:
                break
        if not result.found:
            scanner.listen_for_late()
    except KeyboardInterrupt:
        result.interrupted = True
    result.duration_s = transport.clock() - began
    return result


def _order(
    settings: Sequence[ScanSetting], stations: Sequence[int], result: ScanResult
) -> Iterator[tuple[ScanSetting, int]]:
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
        first: ScanSetting,
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
        self._setting: ScanSetting | None = None
        self._done: set[ScanSetting] = set()  # nothing more is to be asked there
        self._silent: set[ScanSetting] = set()  # not every number is answered there
        self._untold: list[Station] = []
        self._answers: dict[ScanSetting, dict[int, object]] = {}
        self._asked: dict[int, float] = {}  # at this setting: when, with the wire time
        self._decoder = first.codec.decoder()
        self._closed = 0
        self._noise_bytes = 0
        self._heard_at = -inf

    def is_open(self, setting: ScanSetting) -> bool:
        """True if there is something to ask with this setting; the line is set to it then.

        Raises:
            LineError: the port supports none of the settings so far.
        """
        if setting not in self._done and setting != self._setting:
            self._change_to(setting)
        return setting not in self._done

    def probe(self, setting: ScanSetting, station: int) -> None:
        """Ask one station, again only after noise, and find out whether the port answers for every number."""
        if station not in self._result.stations:
            self._result.stations.append(station)
        if self._ask_until_clear(setting, station):
            self._compare(setting)
        else:
            self._silent.add(setting)
        for found in self._untold:
            if found in self._result.found:
                self._on_found(found)
        self._untold.clear()

    def _ask_until_clear(self, setting: ScanSetting, station: int) -> bool:
        for _ in range(self._retries + 1):
            self._noise_bytes = 0
            if self._ask(setting, station):
                return True
            if not self._noise_bytes:
                return False
        self._result.unclear.append(Unclear(station, setting, self._noise_bytes))
        return False

    def _compare(self, setting: ScanSetting) -> None:
        """Is this a station of its own, or a port that answers for every number?"""
        answers = self._answers.setdefault(setting, {})
        if setting in self._silent or len(answers) != _ENOUGH_TO_COMPARE:
            return
        others = [other for other in _FAR_APART if other in setting.codec.stations and other not in answers]
        for other in others:
            self._result.probes += 1
            if not self._ask_until_clear(setting, other):
                break
        same = len({repr(answer) for answer in answers.values()}) == 1
        if not same or any(other not in answers for other in others):
            self._silent.add(setting)
            return
        found = self._result.found
        here = [each for each in found if each.setting == setting]
        found[found.index(here[0])] = replace(here[0], any_number=True)
        for each in here[1:]:
            found.remove(each)
        self._done.add(setting)

    def _change_to(self, setting: ScanSetting) -> None:
        if self._setting is None or setting.line != self._setting.line:
            try:
                self._transport.configure(setting.line)
            except LineError:  # not every adapter has every speed
                self._result.refused.append(setting)
                self._done.add(setting)
                if not self._result.tried and len(self._result.refused) > _MOST_REFUSED:
                    raise
                return
        self._result.tried += [setting] * (setting not in self._result.tried)
        self._transport.drain()
        self._setting = setting
        self._asked.clear()
        self._decoder = setting.codec.decoder()

    def listen_for_late(self) -> None:
        """At the end, if no station was found: wait for late answers."""
        until = self._transport.clock() + min(3 * self._timeout_s, _LATE_S)
        while self._setting and not self._result.found and (rest := until - self._transport.clock()) > 0:
            try:
                self._look_at(self._transport.read(_READ_BYTES, rest), self._setting)
            except TransportTimeout:
                continue

    def _ask(self, setting: ScanSetting, station: int) -> bool:
        """One request; True if its station answered."""
        transport, codec = self._transport, setting.codec
        probe = codec.probe
        request = codec.encode(station, probe)
        try:
            self._look_at(transport.drain(), setting)
            self._keep_quiet(setting)
            transport.write(request)
            asked = self._asked[station] = transport.clock()
            wire_s = (len(request) + codec.answer_bytes(probe)) * setting.line.byte_time_s
            deadline = asked + wire_s + self._timeout_s
            begun = 0.0  # until when the rest of an answer may come that has begun
            while (rest := (begun or deadline) - transport.clock()) > 0:
                try:
                    data = transport.read(_READ_BYTES, rest)
                except TransportTimeout:
                    continue
                self._closed = 0
                if station in self._look_at(data, setting, station):
                    return True
                begun = begun or deadline + wire_s
            if begun:
                self._noise_bytes += self._decoder.clear()
        except TransportTimeout:
            return False
        except TransportClosed:  # a gateway may close the connection after a request it does not understand
            self._closed += 1
            if self._closed >= _MOST_CLOSED:
                raise
            transport.renew()
        return False

    def _keep_quiet(self, setting: ScanSetting) -> None:
        """Wait for the silence that the protocol needs between frames; take what is received meanwhile."""
        quiet_s = setting.codec.quiet_chars * setting.line.byte_time_s
        while (rest := self._heard_at + quiet_s - self._transport.clock()) > 0:
            try:
                self._look_at(self._transport.read(_READ_BYTES, rest), setting)
            except TransportTimeout:
                continue

    def _look_at(self, data: bytes, setting: ScanSetting, station: int = -1) -> list[int]:
        """The stations whose answers are in the bytes; ``station`` is the one that was asked."""
        answered: list[int] = []
        if data:
            self._heard_at = self._transport.clock()
        self._decoder.feed(data)
        while True:
            try:
                frame = self._decoder.next_frame()
                if frame is None:
                    return answered
                if self._take(frame, setting, late=frame.station != station):
                    answered.append(frame.station)
            except FrameError as error:
                self._noise_bytes += len(error.raw)

    def _take(self, frame: Frame, setting: ScanSetting, *, late: bool) -> bool:
        """True for an answer; an echo of the request is none."""
        codec, brief = setting.codec, None
        answer: object = None
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
        answers = self._answers.setdefault(setting, {})
        if frame.station not in answers:
            answers[frame.station] = answer
            asked = self._asked.get(frame.station)
            took_s = None if asked is None else self._transport.clock() - asked
            found = Station(frame.station, setting, brief, took_s, late=late and asked is not None)
            self._result.found.append(found)
            if len(answers) == 1:
                self._on_found(found)
            else:
                self._untold.append(found)  # it may be the first one once more
        return True
