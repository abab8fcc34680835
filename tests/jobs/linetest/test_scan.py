"""The scan: who answers, in which order it is asked, and how long silence takes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from fatektool.errors import LineError, TransportClosed, UsageError
from fatektool.jobs.linetest.scan import scan
from fatektool.jobs.linetest.scan_result import ScanResult, ScanSetting, Station
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.protocol.line_settings import BAUDS
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from tests.exchange.peer import frame

if TYPE_CHECKING:
    from collections.abc import Callable

FACTORY = LineSettings()
FAST = LineSettings(19200)


def status(station: int) -> bytes:
    return frame("40", station)


def answer(station: int) -> bytes:
    return frame("400010054", station)


class Line:
    """PLCs that answer at one speed, and a record of who was asked."""

    def __init__(self, stations: set[int], baud: int = 9600, after_s: float = 0.02) -> None:
        self.stations = stations
        self.baud = baud
        self.after_s = after_s
        self.set_to = 0
        self.asked: list[tuple[int, int]] = []
        self.forge: Callable[[int, bytes], bytes] = lambda _station, data: data

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        station = int(data[1:3], 16)
        assert data == status(station)
        self.asked.append((self.set_to, station))
        if self.set_to != self.baud or station not in self.stations:
            return []
        return [(now + self.after_s, self.forge(station, answer(station)))]


class Adjustable(MemoryTransport):
    """A line in memory that has a speed."""

    def __init__(self, line: Line) -> None:
        super().__init__(line)
        self.peer = line

    def configure(self, settings: LineSettings) -> None:
        self.peer.set_to = settings.baud


def look(
    line: Line,
    *bauds: int,
    stations: tuple[int, ...] = tuple(range(1, 11)),
    timeout_s: float = 0.1,
    retries: int = 3,
) -> ScanResult:
    settings = [ScanSetting(FACON, LineSettings(baud)) for baud in bauds or (9600,)]
    return scan(Adjustable(line), settings, stations, timeout_s=timeout_s, retries=retries)


def test_it_finds_who_answers() -> None:
    result = look(Line({3, 7}))
    assert [found.station for found in result.found] == [3, 7]
    assert result.probes == 10
    assert result.unclear == []
    found = result.found[0]
    assert found.brief is not None
    assert found.brief.flags.running
    assert found.latency_s == pytest.approx(0.02)


def test_silence_costs_its_deadline_and_one_listening_for_what_is_late() -> None:
    line = Line(set())
    result = look(line, stations=tuple(range(1, 255)), timeout_s=0.5)
    wire_s = (8 + 15) * 10 / 9600
    assert len(line.asked) == 254
    assert 254 * 0.5 + 1.5 <= result.duration_s <= 254 * (wire_s + 0.5) * 1.001 + 1.5


def test_the_first_station_is_tried_everywhere_then_the_setting_that_answered() -> None:
    line = Line({1, 5}, baud=19200)
    result = look(line, 9600, 19200, 38400, stations=(1, 4, 5))
    assert line.asked == [
        *[(9600, 1), (19200, 1), (38400, 1)],
        *[(19200, 4), (19200, 5), (9600, 4), (9600, 5), (38400, 4), (38400, 5)],
    ]
    assert [(found.station, found.setting.line.baud) for found in result.found] == [(1, 19200), (5, 19200)]


def test_a_late_answer_counts_for_the_station_that_gave_it() -> None:
    result = look(Line({2, 3}, after_s=0.17), stations=(1, 2, 3, 4))
    assert [(found.station, found.late) for found in result.found] == [(2, True), (3, True)]
    assert [found.latency_s for found in result.found] == pytest.approx([0.17, 0.17])


def test_noise_is_asked_again_and_told() -> None:
    line = Line({2})
    line.forge = lambda _station, data: data[:-3] + b"00\x03"
    result = look(line, stations=(1, 2, 3), retries=2)
    assert result.found == []
    assert [(place.station, place.noise_bytes) for place in result.unclear] == [(2, len(answer(2)))]
    assert [station for _, station in line.asked] == [1, 2, 2, 2, 3]


def test_an_answer_that_was_hit_once_is_found_by_the_next_try() -> None:
    line = Line({2})
    line.forge = lambda _station, data: data if len(line.asked) > 2 else b"\x00" + data[:4]
    assert [found.station for found in look(line, stations=(1, 2, 3)).found] == [2]


def test_an_answer_that_breaks_off_is_no_answer() -> None:
    line = Line({2})
    line.forge = lambda _station, data: data[:-1]
    result = look(line, stations=(2, 3), retries=1)
    assert [place.station for place in result.unclear] == [2]


def test_an_echo_is_nobody() -> None:
    class Echo(Line):
        def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
            return [(now, data), *super().receive(data, now)]

    assert [found.station for found in look(Echo({4})).found] == [4]
    assert look(Echo(set())).found == []


def test_a_refusal_is_somebody() -> None:
    line = Line({4})
    line.forge = lambda station, _data: frame("404", station)
    assert [(found.station, found.brief) for found in look(line).found] == [(4, None)]


def test_a_foreign_answer_of_another_kind_is_nobody() -> None:
    line = Line({4})
    line.forge = lambda station, _data: frame("4E00", station)
    assert look(line).found == []


def test_ctrl_c_gives_what_was_found_so_far() -> None:
    told: list[Station] = []

    def interrupt(done: int, total: int) -> None:
        assert total == 10
        if done == 5:
            raise KeyboardInterrupt

    result = scan(
        Adjustable(Line({3, 7})),
        [ScanSetting(FACON, FACTORY)],
        range(1, 11),
        timeout_s=0.1,
        on_found=told.append,
        on_probe=interrupt,
    )
    assert result.interrupted
    assert [found.station for found in told] == [found.station for found in result.found] == [3]


def test_it_ends_when_enough_were_found() -> None:
    line = Line({2, 3, 4})
    result = scan(Adjustable(line), [ScanSetting(FACON, FACTORY)], (1, 2, 3, 4), timeout_s=0.1, most=2)
    assert [station for _, station in line.asked] == [1, 2, 3]
    assert len(result.found) == 2


def test_a_gateway_that_hangs_up_for_good_is_an_error() -> None:
    transport = Adjustable(Line({1}))
    transport.close()
    with pytest.raises(TransportClosed):
        scan(transport, [ScanSetting(FACON, FACTORY)], range(1, 11), timeout_s=0.1)


@pytest.mark.parametrize("stations", [(), (0,), (255,)])
def test_stations_have_a_range(stations: tuple[int, ...]) -> None:
    with pytest.raises(UsageError, match="1 to 254"):
        look(Line({1}), stations=stations)


@pytest.mark.parametrize(
    "faults", [["flip=0.3"], ["noise=0.5"], ["truncate=0.2"], ["duplicate=0.5"], ["echo=1"]]
)
def test_a_noisy_line_hides_nobody_and_invents_nobody(faults: list[str]) -> None:
    simulation = build_simulation([2, 9, 200], faults=faults, baud=9600, seed=3)
    result = scan(
        MemoryTransport(simulation.line()),
        [ScanSetting(FACON, FACTORY)],
        range(1, 255),
        timeout_s=0.1,
        retries=8,
    )
    assert [found.station for found in result.found] == [2, 9, 200]


# --- a port that answers every number ---------------------------------------------------------------------


def test_a_port_that_answers_every_number_is_one_plc() -> None:
    simulation = build_simulation([3])
    simulation.plcs[3].write_words("R", 4149, [1])
    told: list[Station] = []
    result = scan(
        MemoryTransport(simulation.line()),
        [ScanSetting(FACON, FACTORY)],
        range(1, 255),
        timeout_s=0.1,
        on_found=told.append,
    )
    (found,) = result.found
    assert (found.station, found.any_number) == (1, True)
    assert result.probes == 2 + 4
    assert [station.station for station in told] == [1]


@pytest.mark.parametrize("stations", [{1, 2}, {1, 2, 3, 254}, set(range(1, 11))])
def test_plcs_that_answer_alike_are_several_all_the_same(stations: set[int]) -> None:
    told: list[int] = []
    result = scan(
        Adjustable(Line(stations)),
        [ScanSetting(FACON, FACTORY)],
        range(1, 11),
        timeout_s=0.1,
        on_found=lambda found: told.append(found.station),
    )
    found = [station.station for station in result.found]
    assert sorted(found) == sorted(told) == sorted(stations)
    assert not any(station.any_number for station in result.found)


def test_one_that_does_not_answer_alike_is_another() -> None:
    line = Line(set(range(1, 255)))
    line.forge = lambda station, data: frame("400000054", station) if station == 254 else data
    assert len(look(line).found) == 10 + 4  # those that were asked besides


# --- what comes late, what a port does not take, how long it may last -----------------------------------


@pytest.mark.parametrize("stations", [(1,), (1, 2, 3), (3, 2, 1)])
def test_a_late_answer_is_told_with_its_time(stations: tuple[int, ...]) -> None:
    (found,) = look(Line({1}, after_s=0.25), stations=stations).found
    assert (found.station, found.late) == (1, True)
    assert found.latency_s == pytest.approx(0.25)


class Picky(Adjustable):
    """An adapter that has not every speed."""

    def configure(self, settings: LineSettings) -> None:
        if settings.baud > 115200:
            raise LineError(f"{self.name}: does not take {settings}")
        super().configure(settings)


def test_a_speed_that_the_port_does_not_take_is_left_out_and_told() -> None:
    line = Line({1}, baud=9600)
    settings = [ScanSetting(FACON, LineSettings(baud)) for baud in (921600, 9600, 614400)]
    result = scan(Picky(line), settings, [1, 2], timeout_s=0.1)
    assert [found.station for found in result.found] == [1]
    assert [setting.line.baud for setting in result.refused] == [921600, 614400]
    assert [setting.line.baud for setting in result.tried] == [9600]


def test_a_port_that_takes_nothing_is_an_error() -> None:
    settings = [ScanSetting(FACON, LineSettings(baud)) for baud in (921600, 614400, 307200, 230400, 153600)]
    with pytest.raises(LineError, match="does not take"):
        scan(Picky(Line({1})), settings, [1], timeout_s=0.1)


def test_it_ends_when_its_time_is_over() -> None:
    settings = [ScanSetting(FACON, LineSettings(baud)) for baud in BAUDS]
    transport = Adjustable(Line(set()))
    result = scan(transport, settings, range(1, 255), timeout_s=0.5, longest_s=10.0)
    assert result.out_of_time
    assert 10.0 <= result.duration_s < 13.0
    assert result.probes <= 20


def test_the_speeds_are_those_that_fatek_has() -> None:
    assert sorted(BAUDS) == [
        *(4800, 7200, 9600, 14400, 19200, 28800, 38400, 57600, 76800, 115200),
        *(153600, 230400, 307200, 614400, 921600),
    ]
