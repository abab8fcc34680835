"""What the JSON documents have in common; each section of the command line has its own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.files.times import utc

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.errors import FatektoolError


def where(plc: Plc) -> dict[str, Any]:
    """When and where, as every document of a PLC begins."""
    return {
        "time": utc(),
        "target": plc.target,
        "station": plc.link.station,
        "protocol": plc.link.codec.name,
    }


def error_document(error: FatektoolError) -> dict[str, Any]:
    """``fatektool.error/1``."""
    return {
        "schema": "fatektool.error/1",
        "error": {
            "kind": error.kind,
            "exit_code": error.exit_code,
            "message": error.message,
            "hint": error.hint,
            "details": error.details,
        },
    }


def broadcast_document(plc: Plc, command: str, sent: int) -> dict[str, Any]:
    """``fatektool.broadcast/1``: a command that was sent to every PLC on the line, in so many requests."""
    return {
        "schema": "fatektool.broadcast/1",
        **where(plc),
        "station": 0,
        "command": command,
        "sent": sent,
        "verified": False,
    }
