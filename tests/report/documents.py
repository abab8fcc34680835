"""Documents of every kind of report, with no PLC asked."""

from __future__ import annotations

import math
from functools import cache
from random import Random
from typing import TYPE_CHECKING, Any

from fatektool.cli.programs.documents import program_differences
from fatektool.program.image import Program
from fatektool.project.comparison import compare_programs
from fatektool.report.loopback import loopback_report
from fatektool.report.program import diff_report, verify_report
from fatektool.report.rounds import Rounds
from fatektool.report.series import SeriesSource, series_report
from fatektool.report.snapshot import snapshot_report
from tests.cli.running import check
from tests.program.samples import changed, program
from tests.report.ladders import ladder_diff, listing

if TYPE_CHECKING:
    from collections.abc import Callable

TIME = "2026-11-22T03:15:00Z"
TIMES_MS = {"min": 18.2, "p50": 21.25, "p90": 24.5, "p99": 48.0, "p999": 93.5, "max": 120.75, "mean": 22.9}
NO_TIMES = dict.fromkeys(TIMES_MS)
KINDS = ("timeout", "checksum", "garbled", "mismatch", "stale", "refused")


def errors(**counts: int) -> dict[str, int]:
    return dict.fromkeys(KINDS, 0) | counts


def loopback(**other: Any) -> dict[str, Any]:
    """A test of a line with a few errors."""
    counts = [3, 310, 402, 120, 40, 12, 0, 0, 3, 0, 1]
    found: dict[str, Any] = {
        "schema": "fatektool.loopback/1",
        "time": TIME,
        "target": "/dev/ttyUSB0",
        "station": 3,
        "protocol": "facon",
        "sent": 900,
        "ok": 891,
        "errors": errors(timeout=6, checksum=2, garbled=1),
        "error_rate": 0.01,
        "error_rate_upper95": 0.01738,
        "bytes_sent": 77_350,
        "bytes_received": 76_802,
        "duration_s": 181.372,
        "latency_ms": TIMES_MS,
        "turnaround_ms": TIMES_MS | {"min": 1.2, "p50": 3.5},
        "line_use": 0.8125,
        "by_size": [
            {
                "size": size,
                "sent": 150,
                "ok": 150 - bad,
                "errors": errors(timeout=bad),
                "error_rate": bad / 150,
                "latency_ms": {name: round(value + size, 3) for name, value in TIMES_MS.items()},
            }
            for size, bad in ((0, 0), (1, 0), (16, 0), (64, 1), (128, 2), (256, 6))
        ],
        "histogram": [
            {"from_ms": round(18 * 1.2**n, 3), "to_ms": round(18 * 1.2 ** (n + 1), 3), "count": count}
            for n, count in enumerate(counts)
        ],
        "limits": {"max_error_rate": 0.0, "max_p99_ms": 50.0},
        "verdict": "fail",
        "ended": "count",
        "limits_passed": ["error rate 0.01, allowed 0"],
        "patterns": ["ascii", "random"],
        "seed": 0,
        "line": "115200 7E1",
        "diagnosis": [
            {
                "rule": "long-frames",
                "finding": "long frames fail more often than short ones",
                "evidence": "6 of 150 with 256 bytes, 0 of 450 with 16 or fewer",
                "advice": "look for missing termination, or a cable that is too long for 115200 baud",
                "fault": True,
            }
        ],
    }
    return found | other


def dead_line() -> dict[str, Any]:
    """A test in which nothing came back."""
    by_size = {"size": 16, "sent": 5, "ok": 0, "errors": errors(timeout=5), "error_rate": 1.0}
    return loopback(
        sent=5, ok=0, errors=errors(timeout=5), error_rate=1.0, error_rate_upper95=1.0, bytes_received=0,
        latency_ms=NO_TIMES, turnaround_ms=NO_TIMES, line_use=None, histogram=[], ended="interrupted",
        by_size=[by_size | {"latency_ms": NO_TIMES}], diagnosis=[], line=None,
    )  # fmt: skip


def verified(a: Program, b: Program, **other: Any) -> dict[str, Any]:
    document = {
        "schema": "fatektool.verify/1",
        "time": TIME,
        "target": "tcp://192.168.2.3",
        "station": 1,
        "protocol": "facon",
        "file": "press.json",
        "sha256": a.sha256,
        "duration_s": 0.5,
        **program_differences(compare_programs(a, b)),
        **other,
    }
    check(document, "verify")
    return document


def diffed(a: Program, b: Program, *, check_it: bool = True) -> dict[str, Any]:
    document = {
        "schema": "fatektool.diff/1",
        "a": {"file": "monday.json", "sha256": a.sha256},
        "b": {"file": "tuesday.json", "sha256": b.sha256},
        **program_differences(compare_programs(a, b)),
    }
    if check_it:
        check(document, "diff")
    return document


def snapshot(number: int = 0, step_s: int = 1, *, check_it: bool = True, **other: Any) -> dict[str, Any]:
    """A round of a press that runs; now and then its D register holds no number."""
    seconds = number * step_s
    time = f"2026-11-22T{3 + seconds // 3600:02}:{seconds // 60 % 60:02}:{seconds % 60:02}Z"
    pressure = round(51.4 + 8 * math.sin(number / 9) + Random(number).random(), 2)  # noqa: S311  # a sample
    broken = number % 20 in {13, 14}
    values: dict[str, Any] = {
        "pressure": pressure,
        "oil temperature": None if broken else 41.5 + number / 100,
        "strokes": 70_000 + number // 3,
        "valve[0]": number % 9 < 4,
        "valve[1]": number % 30 > 20,
        "recipe": "BEEF" if number < 50 else "0001",
    }
    elements: dict[str, Any] = {
        "pressure": {"element": "R12", "type": "i16", "raw": "0000", "unit": "bar", "scale": 0.1},
        "oil temperature": {"element": "DD4", "type": "f32", "raw": None, "unit": "°C"},
        "strokes": {"element": "DRC200", "type": "u32", "raw": "00011170"},
        "valve[0]": {"element": "Y0", "type": "bool", "raw": "1"},
        "valve[1]": {"element": "Y1", "type": "bool", "raw": "0"},
        "recipe": {"element": "R100", "type": "hex", "raw": "BEEF"},
    }
    document = {
        "schema": "fatektool.snapshot/1",
        "time": time,
        "target": "/dev/ttyUSB0",
        "station": 1,
        "protocol": "facon",
        "running": number < 80,
        "duration_s": 0.119,
        "requests": 4,
        "values": values,
        "elements": elements,
        "errors": {"oil temperature": "7FC00000 is not a number as f32"} if broken else {},
    } | other
    if check_it:  # it takes longer than all else
        check(document, "snapshot")
    return document


def series(count: int = 120, *, step_s: int = 1, most_points: int = 2000) -> Rounds:
    rounds = Rounds(most_points=most_points)
    for number in range(count):
        if 60 <= number < 64:
            rounds.fail(snapshot(number, step_s)["time"], "no answer from station 1 in 4 tries of 0.5 s")
        else:
            rounds.add(snapshot(number, step_s, check_it=number < 60))
    return rounds


def place(schema: str = "fatektool.watch/1", target: str = "/dev/ttyUSB0") -> SeriesSource:
    return SeriesSource(target, 1, "facon", schema, TIME)


SMALL, LARGE, OTHER = program(400), program(13_184), program(500, seed=2)
MANY = Program(13_184, (LARGE.pages[0], *program(13_184, seed=2).pages[1:]))
REPORTS: dict[str, Callable[[], str]] = {
    "loopback": lambda: loopback_report(loopback()),
    "dead line": lambda: loopback_report(dead_line()),
    "verify": lambda: verify_report(verified(LARGE, changed(LARGE, 5, 6, 40, 206)), LARGE),
    "verify same": lambda: verify_report(verified(SMALL, SMALL), SMALL),
    "verify many": lambda: verify_report(verified(LARGE, MANY), LARGE),
    "diff": lambda: diff_report(diffed(SMALL, OTHER), SMALL, OTHER, time=TIME),
    "snapshot": lambda: snapshot_report(snapshot(13)),
    "watch": lambda: series_report(series(), place(), ended="interrupted"),
    "series": lambda: series_report(series(5000, step_s=2, most_points=500), place("fatektool.snapshot/1")),
    "listing": listing,
    "ladder diff": ladder_diff,
    "nothing": lambda: series_report(Rounds(), place(), ended="no answer"),
}
"""Every kind of report, by name, and how it is made."""


@cache
def report(name: str) -> str:
    """A report, made once."""
    return REPORTS[name]()
