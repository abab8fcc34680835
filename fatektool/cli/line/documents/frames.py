"""The JSON documents of ``decode`` and ``encode``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.cli.line.frame_view import characters

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.protocol.explain import Explanation
    from fatektool.transport.trace_reader import TraceRecord


def decode_document(protocol: str, found: Iterable[tuple[TraceRecord | None, Explanation]]) -> dict[str, Any]:
    """``fatektool.decode/1``: frames, each with the record of the trace that it is in, None for typed hex."""
    return {
        "schema": "fatektool.decode/1",
        "protocol": protocol,
        "frames": [
            {
                "time": record.time if record else None,
                "direction": record.direction if record else None,
                **_explanation(explanation),
            }
            for record, explanation in found
        ],
    }


def encode_document(protocol: str, raw: bytes, explanation: Explanation) -> dict[str, Any]:
    """``fatektool.encode/1``: a frame that was built, explained."""
    return {
        "schema": "fatektool.encode/1",
        "protocol": protocol,
        "hex": raw.hex().upper(),
        "characters": characters(raw),
        "bytes": len(raw),
        "frame": _explanation(explanation),
    }


def _explanation(explanation: Explanation) -> dict[str, Any]:
    """What a frame is, its station, and its fields."""
    return {
        "role": explanation.role.value,
        "raw": explanation.raw.hex().upper(),
        "station": explanation.station,
        "command": None if explanation.command is None else f"{explanation.command:02X}",
        "checksum_ok": explanation.checksum_ok,
        "fault": explanation.fault,
        "fields": [
            {
                "name": field.name,
                "raw": field.raw.hex().upper(),
                "text": characters(field.raw),
                "meaning": field.meaning,
            }
            for field in explanation.fields
        ],
    }
