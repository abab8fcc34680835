"""The JSON documents of ``status``, ``run`` and ``stop``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.cli.shared.documents import where

if TYPE_CHECKING:
    from fatektool.cli.shared.addressee import Addressee
    from fatektool.client import Plc
    from fatektool.jobs.status import StatusReport


def status_document(report: StatusReport) -> dict[str, Any]:
    """``fatektool.status/1``."""
    from fatektool.cli.shared.unfinished import unfinished_documents  # loaded with the connection

    return {
        "schema": "fatektool.status/1",
        "time": report.time,
        "target": report.target,
        "station": report.station,
        "protocol": report.protocol,
        "status": report.flags.document(),
        "system": _system(report),
        "brief": {
            "status1": report.brief.status1,
            "status2": report.brief.status2,
            "status3": report.brief.status3,
            "model": report.brief.model,
        },
        "raw": {
            "brief": report.brief.to_bytes().hex().upper(),
            "detailed": None if report.detailed is None else report.detailed.raw.hex().upper(),
        },
        **unfinished_documents(report.target, report.station),
    }


def _system(report: StatusReport) -> dict[str, Any] | None:
    """The answer to 53: marked if its layout is assumed, in hex if it has none."""
    from fatektool.protocol.status import DetailedStatus, RawStatus  # not before there is one

    match report.detailed:
        case DetailedStatus(system=system, assumed=assumed):
            return ({"layout": "assumed"} if assumed else {}) | system.document()
        case RawStatus(raw):
            return {"layout": "raw", "raw": raw.hex().upper()}
    return None


def mode_document(plc: Plc, before: Addressee, mode_after: str) -> dict[str, Any]:
    """``fatektool.mode/1``; modes are ``run`` and ``stop``."""
    return {
        "schema": "fatektool.mode/1",
        **where(plc),
        "model": before.model,
        "mode_before": "run" if before.running else "stop",
        "mode_after": mode_after,
    }
