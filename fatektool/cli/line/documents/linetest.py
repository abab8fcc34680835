"""The JSON documents of ``loopback``, ``doctor`` and ``scan``, also of a network."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.cli.shared.documents import where
from fatektool.transport import discovery

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.client import Plc
    from fatektool.jobs.linetest.doctor import Examination
    from fatektool.jobs.linetest.enough_time import EnoughTime
    from fatektool.jobs.linetest.finding import Finding
    from fatektool.jobs.linetest.loopback.result import LoopbackResult, Tally
    from fatektool.jobs.linetest.raw_frame import RawFrame
    from fatektool.jobs.linetest.scan_result import ScanResult, ScanSetting, Station, Unclear
    from fatektool.transport.discovery import Answer


def loopback_document(plc: Plc, result: LoopbackResult, findings: Iterable[Finding]) -> dict[str, Any]:
    """``fatektool.loopback/1``."""
    plan, total = result.plan, result.total
    return {
        "schema": "fatektool.loopback/1",
        **(where(plc) if plan.raw is None else where(plc) | {"station": None, "protocol": "raw"}),
        "line": plc.link.transport.serial_settings,
        "raw": None if plan.raw is None else _frame(plan.raw),
        "verdict": "fail" if result.faults else "pass",
        "ended": result.ended,
        "sent": total.sent,
        "ok": total.ok,
        "errors": total.errors,
        "error_rate": _rate(total.error_rate),
        "error_rate_upper95": _rate(total.error_rate_upper95),
        "bytes_sent": result.bytes_sent,
        "bytes_received": result.bytes_received,
        "duration_s": round(result.duration_s, 3),
        "latency_ms": total.latency.summary_ms(),
        "turnaround_ms": result.turnaround.summary_ms(),
        "line_use": None if result.line_use is None else round(result.line_use, 4),
        "by_size": [{"size": size, **_tally(tally)} for size, tally in sorted(result.by_size.items())],
        "histogram": [
            {
                "from_ms": round(bar.from_s * 1000, 4),
                "to_ms": round(bar.to_s * 1000, 4),
                "count": bar.count,
            }
            for bar in total.latency.bars()
        ],
        "limits": {"max_error_rate": plan.max_error_rate, "max_p99_ms": plan.max_p99_ms},
        "limits_passed": result.faults,
        "patterns": [pattern.value for pattern in plan.patterns],
        "seed": plan.seed,
        "diagnosis": [finding_document(finding) for finding in findings],
    }


def _frame(raw: RawFrame) -> dict[str, str | None]:
    codes = {"start": raw.start, "end": raw.end}
    return {name: None if code is None else f"{code:02X}" for name, code in codes.items()}


def _tally(tally: Tally) -> dict[str, Any]:
    return {
        "sent": tally.sent,
        "ok": tally.ok,
        "errors": tally.errors,
        "error_rate": _rate(tally.error_rate),
        "latency_ms": tally.latency.summary_ms(),
    }


def _rate(rate: float) -> float:
    """Six digits that count, as a small rate has no fewer."""
    return float(f"{rate:.6g}")


def finding_document(finding: Finding) -> dict[str, Any]:
    """One finding of a diagnosis."""
    return {
        "rule": finding.rule,
        "fault": finding.fault,
        "finding": finding.finding,
        "evidence": finding.evidence,
        "advice": finding.advice,
    }


def doctor_document(plc: Plc, found: Examination) -> dict[str, Any]:
    """``fatektool.doctor/1``."""
    total = found.loopback.total
    return {
        "schema": "fatektool.doctor/1",
        **where(plc),
        "line": plc.link.transport.serial_settings,
        "healthy": found.healthy,
        "findings": [finding_document(finding) for finding in found.findings],
        "status": None if found.brief is None else found.brief.flags.document(),
        "loopback": {
            **_tally(total),
            "turnaround_ms": found.loopback.turnaround.summary_ms(),
            "duration_s": round(found.loopback.duration_s, 3),
        },
        "enough_time": None if found.enough is None else _enough(found.enough),
        "searched": None if found.searched is None else _searched(found.searched),
        "elsewhere": [station_document(station) for station in found.elsewhere],
    }


def _enough(enough: EnoughTime) -> dict[str, Any]:
    return {
        "timeout_s": enough.timeout_s,
        "proven": enough.proven,
        "sent": enough.sent,
        "ok": enough.ok,
        "slowest_s": round(enough.slowest_s, 3),
    }


def _searched(result: ScanResult) -> dict[str, Any]:
    return {
        "tried": [str(setting.line) for setting in result.tried],
        "refused": [str(setting.line) for setting in result.refused],
        "stations": result.stations,
        "out_of_time": result.out_of_time,
        "duration_s": round(result.duration_s, 3),
    }


def scan_document(time: str, target: str, result: ScanResult, *, serial: bool) -> dict[str, Any]:
    """``fatektool.scan/1``.

    Args:
        time: when it began, UTC.
        target: as the user named it.
        result: what was found.
        serial: False for a medium without speed and format, whose documents say null there.
    """
    return {
        "schema": "fatektool.scan/1",
        "time": time,
        "target": target,
        "probes": result.probes,
        "duration_s": round(result.duration_s, 3),
        "interrupted": result.interrupted,
        "refused": [_setting(setting, serial=serial) for setting in result.refused],
        "found": [station_document(station, serial=serial) for station in result.found],
        "unclear": [_unclear(place, serial=serial) for place in result.unclear],
    }


def station_document(found: Station, *, serial: bool = True) -> dict[str, Any]:
    """One station that answered."""
    brief = found.brief
    return {
        "station": found.station,
        **_setting(found.setting, serial=serial),
        "running": None if brief is None else brief.flags.running,
        "model": None if brief is None else brief.model,
        "latency_ms": None if found.latency_s is None else round(found.latency_s * 1000, 3),
        "late": found.late,
        "any_number": found.any_number,
    }


def _unclear(place: Unclear, *, serial: bool) -> dict[str, Any]:
    return {
        "station": place.station,
        **_setting(place.setting, serial=serial),
        "noise_bytes": place.noise_bytes,
    }


def _setting(setting: ScanSetting, *, serial: bool) -> dict[str, Any]:
    return {
        "protocol": setting.codec.name,
        "baud": setting.line.baud if serial else None,
        "format": setting.line.format if serial else None,
    }


def network_document(time: str, target: str, listened_s: float, answers: Iterable[Answer]) -> dict[str, Any]:
    """``fatektool.network/1``: which Ethernet modules answered a call.

    Args:
        time: when it was sent, UTC.
        target: the address and port that it was sent to.
        listened_s: for how long answers were waited for.
        answers: what came.
    """
    return {
        "schema": "fatektool.network/1",
        "time": time,
        "target": target,
        "requests": [request.hex(" ").upper() for request in discovery.REQUESTS],
        "listened_s": listened_s,
        "answers": [
            {
                "address": answer.address,
                "port": answer.port,
                "bytes": len(answer.data),
                "hex": answer.data.hex(" ").upper(),
            }
            for answer in answers
        ],
    }
