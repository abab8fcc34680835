"""Every job, told in memory over a bad line, with an oracle that knows what the simulated PLC really holds.

A job ends in one of two ways. It has a result: then that is compared with the PLC's memory. Or it raises an
error of the project: then its exit code must be one that the job may have, and the PLC must be as it is said
to be. Anything else, such as an exception of Python, goes through and fails the test.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fatektool.errors import FatektoolError, RestoreIncomplete
from fatektool.jobs.elements.selection import parse_items
from fatektool.jobs.linetest.loopback.result import LoopbackPlan
from fatektool.jobs.linetest.loopback.run import run_loopback
from fatektool.jobs.linetest.scan import scan
from fatektool.jobs.linetest.scan_result import ScanSetting
from fatektool.jobs.programs.backup import backup
from fatektool.jobs.programs.reading import MOST_PASSES
from fatektool.jobs.programs.restore import restore
from fatektool.jobs.programs.verify import verify
from fatektool.jobs.snapshots.apply import plan_apply
from fatektool.jobs.snapshots.snapshot import raw_of, take_snapshot
from fatektool.jobs.snapshots.spec import items_of
from fatektool.jobs.snapshots.write_values import write_values
from fatektool.jobs.status import read_status
from fatektool.program.archive import load_backup
from tests.program.samples import backup as backup_of
from tests.rigs import DISCRETES, NEAR, NEW, OLD, PAGES, REGISTERS, Rig

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.elements import Element

ASKED = ("R0-R99", "M0-M39", "WM8", "DR4")
REFUSED = "R60000"
"""More than any PLC has."""
EXCHANGES = 24
LEARNT = 3
"""The most requests by which a loopback test learns whether the line echoes."""
SPOILING = ("drop", "flip", "truncate", "wrong-station", "wrong-line")
"""Faults that leave nothing of an answer to take."""
SCANNED = (1, 2, 3)
THERE = (1, 3)


def truth(rig: Rig, element: Element) -> int:
    """What the PLC holds, as raw bits; a wide element is put together by hand."""
    if element.symbol == "R":
        return rig.device.read_words("R", element.address, 1)[0]
    if element.symbol == "DR":
        low, high = rig.device.read_words("R", element.address, 2)
        return high << 16 | low
    width = 16 if element.symbol == "WM" else 1
    bits = rig.device.read_discretes("M", element.address, width)
    return sum(bit << place for place, bit in enumerate(bits))


def tell_status(rig: Rig, _: Path) -> int:
    report = read_status(rig.plc)
    assert report.flags.battery_low
    assert report.flags.running == rig.device.running
    assert report.system is not None
    assert report.system.ladder_words == OLD.ladder_words
    return 0


def tell_backup(rig: Rig, _: Path) -> int:
    assert backup(rig.plc).program == OLD
    return 0


def tell_verify(rig: Rig, _: Path) -> int:
    """Against the program that is there, and against one that differs in a word."""
    assert verify(rig.plc, OLD).same
    assert verify(rig.plc, NEAR).page_numbers == [2]
    return 1


def tell_restore(rig: Rig, folder: Path) -> int:
    try:
        result = restore(
            rig.plc,
            backup_of(NEW),
            folder / "press.json",
            confirm=lambda plan, kept: True,  # noqa: ARG005
            safety_folder=folder,
        )
    except RestoreIncomplete as error:
        _as_told(rig, error)
        raise
    except FatektoolError:
        _unchanged(rig)
        raise
    finally:
        assert all(load_backup(path).program == OLD for path in folder.iterdir())
    assert result.verified
    assert rig.pages == NEW.pages
    assert result.safety_backup is not None
    assert load_backup(Path(result.safety_backup)).program == OLD
    return 0


def _unchanged(rig: Rig) -> None:
    assert rig.pages == OLD.pages, "an error that does not say so left a changed program"


def _as_told(rig: Rig, error: RestoreIncomplete) -> None:
    assert load_backup(Path(error.details["safety_backup"])).program == OLD
    new, old, uncertain = (error.details[f"pages_{state}"] for state in ("written", "old", "uncertain"))
    assert sorted([*new, *old, *uncertain]) == list(range(PAGES))
    unread = error.details["pages_unread"]
    assert ("not read back" in error.message) == bool(unread)
    for page in new + old:
        images = (OLD, NEW) if page in unread else (NEW,) if page in new else (OLD,)
        assert rig.pages[page] in [image.pages[page] for image in images]


def tell_snapshot(rig: Rig, _: Path) -> int:
    refused = [] if rig.modbus else [REFUSED]  # a reference that the map has not is no request at all
    found = take_snapshot(rig.plc, items_of(parse_items([*ASKED, *refused])))
    assert list(found.errors) == refused
    assert all("illegal address" in said for said in found.errors.values())
    for key, (element, raw) in raw_of(found).items():
        assert key == REFUSED or raw == truth(rig, element), key
    assert found.running == (None if rig.modbus else rig.device.running)
    return 0


def _old_or_new(rig: Rig, before: dict[Element, int], after: dict[Element, int]) -> None:
    assert all(truth(rig, element) in {value, after[element]} for element, value in before.items())


def tell_apply(rig: Rig, _: Path) -> int:
    """A snapshot of a good line, put back over the bad one."""
    wanted = take_snapshot(Rig(rig.codec.name).plc, items_of(parse_items(("R0-R99", "M0-M39"))))
    rig.device.write_words("R", 10, [7] * 80)
    rig.device.write_discretes("M", 5, b"\1\0" * 10)
    before = {element: truth(rig, element) for element in (*REGISTERS, *DISCRETES)}
    after = {element: int(value) for element, value in (REGISTERS | DISCRETES).items()}
    try:
        plan = plan_apply(rig.plc, wanted)
        assert {element: raw for _, element, raw in plan.changes} == {
            element: value for element, value in after.items() if value != before[element]
        }
        failed = write_values(rig.plc, plan.values).not_taken
    except FatektoolError as error:
        _old_or_new(rig, before, after if error.exit_code == 6 else before)
        raise
    refused = {each.element: each.got for each in failed}
    for element, value in after.items():
        held = truth(rig, element)
        assert held == value or refused[element] == held
        assert element not in refused or held != value
    return 4 if failed else 0


def tell_loopback(rig: Rig, _: Path) -> int:
    result = run_loopback(rig.plc, LoopbackPlan(count=EXCHANGES))
    total = result.total
    assert result.ended == "count"
    assert total.sent == EXCHANGES
    assert total.ok + sum(total.errors.values()) == EXCHANGES
    faults = rig.simulation.faults
    struck = 0 if faults is None else max(faults.counts.get(kind, 0) for kind in SPOILING)
    assert total.ok <= EXCHANGES + LEARNT - struck, "a spoiled answer was counted as a good one"
    return 1 if result.faults else 0


def tell_scan(rig: Rig, _: Path) -> int:
    setting = ScanSetting(rig.codec, rig.line)
    result = scan(rig.transport, [setting], SCANNED, timeout_s=0.5)
    found = [station.station for station in result.found]
    assert len(set(found)) == len(found)
    assert result.probes == len(SCANNED)
    foreign = rig.simulation.faults is not None and rig.simulation.faults.counts.get("wrong-station")
    assert foreign or set(found) <= set(THERE)
    for station in result.found:
        assert rig.modbus or (station.brief is not None and station.brief.flags.battery_low)
    return 0 if found else 1


def _told(error: FatektoolError) -> int:
    """One line, and a next step."""
    assert str(error).isprintable()
    assert error.hint
    return error.exit_code


class Job:
    """A job with what it may end in.

    Args:
        tell: does it, and gives the exit code of its result.
        codes: the exit codes that it may end with on a bad line.
        requests: how many requests it may need, to know when it must be over.
        protocols: that have its commands.
        stations: whom the line has.
    """

    def __init__(
        self,
        tell: Callable[[Rig, Path], int],
        codes: set[int],
        requests: int,
        *,
        protocols: tuple[str, ...] = ("facon", "mseries"),
        stations: tuple[int, ...] = (1,),
    ) -> None:
        self.tell = tell
        self.codes = codes
        self.requests = requests
        self.protocols = protocols
        self.stations = stations

    def told(self, rig: Rig, folder: Path) -> int:
        """The exit code of this job over this line; in time."""
        began = rig.now
        try:
            code = self.tell(rig, folder)
        except FatektoolError as error:
            code = _told(error)
        took = rig.now - began
        most = rig.most_s(self.requests)
        assert took <= most, f"{took:.1f} s, expected at most {most:.1f} s"
        return code


_PASS = 1 + PAGES
_ALL = ("facon", "mseries", "modbus-rtu", "modbus-ascii", "modbus-tcp")
_FACON = ("facon",)
JOBS = {
    "status": Job(tell_status, {0, 3}, 2),
    "backup": Job(tell_backup, {0, 3, 5}, MOST_PASSES * _PASS, protocols=_FACON),
    "verify": Job(tell_verify, {1, 3}, 4 * _PASS, protocols=_FACON),
    "restore": Job(tell_restore, {0, 3, 4, 5, 6}, (MOST_PASSES + 5) * _PASS, protocols=_FACON),
    "snapshot": Job(tell_snapshot, {0, 3}, 40, protocols=_ALL),
    "apply": Job(tell_apply, {0, 3, 4, 6}, 80, protocols=_ALL),
    "loopback": Job(tell_loopback, {0, 1, 3}, EXCHANGES),
    "scan": Job(tell_scan, {0, 1, 3}, 3 * len(SCANNED), protocols=_ALL, stations=THERE),
}
