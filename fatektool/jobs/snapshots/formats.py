"""A snapshot as text: JSON, NDJSON, CSV, InfluxDB line protocol, Prometheus exposition format."""

from __future__ import annotations

import calendar
import json
import re
import time
from typing import TYPE_CHECKING, Final

from fatektool.files.indented_json import indented_json

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.jobs.snapshots.snapshot import Snapshot
    from fatektool.protocol.values import Value

_COLUMNS: Final = ("time", "target", "station", "key", "element", "type", "raw", "value", "unit", "error")


def as_json(snapshot: Snapshot) -> str:
    """One document, indented."""
    return indented_json(snapshot.document(), 2) + "\n"


def as_ndjson(snapshot: Snapshot) -> str:
    """One document on one line."""
    return json.dumps(snapshot.document(), allow_nan=False, separators=(",", ":")) + "\n"


def as_csv(snapshot: Snapshot) -> str:
    """A header and a row an item."""
    rows: list[tuple[object, ...]] = [_COLUMNS]
    for key, part in snapshot.elements.items():
        rows.append(
            (
                snapshot.time,
                snapshot.target,
                snapshot.station,
                key,
                part["element"],
                part["type"],
                part["raw"] or "",
                _plain(snapshot.values[key]),
                part.get("unit", ""),
                snapshot.errors.get(key, ""),
            )
        )
    return "".join(",".join(_field(str(cell)) for cell in row) + "\n" for row in rows)


def as_influx(snapshot: Snapshot) -> str:
    """InfluxDB line protocol: measurement ``fatek``, a line an item, nanoseconds.

    A field has one type in all lines of a measurement, or InfluxDB drops those that came later. So numbers
    are floats, discretes 1 and 0 among them, in the field ``value``, and hex is in the field ``text``.
    """
    stamp = _seconds(snapshot) * 1_000_000_000
    lines = []
    for key, value in snapshot.values.items():
        if value is None:
            continue
        tags = {
            "target": snapshot.target,
            "station": str(snapshot.station),
            "key": key,
            "element": snapshot.elements[key]["element"],
            "unit": snapshot.elements[key].get("unit"),
        }
        named = ",".join(f"{name}={_influx_tag(text)}" for name, text in tags.items() if text)
        lines.append(f"fatek,{named} {_influx_field(value)} {stamp}\n")
    return "".join(lines)


def as_prometheus(snapshot: Snapshot, name: str = "") -> str:
    """Prometheus exposition format: ``fatek_value`` with labels; samples carry no time.

    Args:
        snapshot: the values.
        name: distinguishes this snapshot from others of the same PLC; empty for the only one.
    """
    from fatektool.jobs.prometheus import exposition, sample

    where: dict[str, object] = {"target": snapshot.target, "station": snapshot.station}
    if name:
        where["snapshot"] = name
    samples = [sample("fatek_snapshot_timestamp_seconds", _seconds(snapshot), where)]
    if snapshot.running is not None:
        samples.append(sample("fatek_running", snapshot.running, where))
    for key, value in snapshot.values.items():
        if value is None or isinstance(value, str):
            continue
        part = snapshot.elements[key]
        labels = where | {"key": key, "element": part["element"]}
        samples.append(
            sample("fatek_value", value, labels | ({"unit": part["unit"]} if "unit" in part else {}))
        )
    return exposition(samples)


FORMATS: Final[dict[str, Callable[[Snapshot], str]]] = {
    "json": as_json,
    "ndjson": as_ndjson,
    "csv": as_csv,
    "influx": as_influx,
    "prometheus": as_prometheus,
}
SUFFIXES: Final = {"json": "json", "ndjson": "ndjson", "csv": "csv", "influx": "influx", "prometheus": "prom"}


def _seconds(snapshot: Snapshot) -> int:
    return calendar.timegm(time.strptime(snapshot.time[:19], "%Y-%m-%dT%H:%M:%S"))


def _plain(value: Value | None) -> str:
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _field(text: str) -> str:
    """A field of CSV; the csv module of some versions leaves a carriage return bare."""
    if any(character in text for character in ',"\r\n'):
        return '"' + text.replace('"', '""') + '"'
    return text


def _influx_tag(text: str) -> str:
    """A tag's value. Readers do not agree how to escape a backslash: it is replaced with /."""
    plain = re.sub(r"[\x00-\x1f\x7f]", " ", text).replace("\\", "/")
    return re.sub(r"([,= ])", r"\\\1", plain)


def _influx_field(value: Value) -> str:
    if isinstance(value, str):
        quoted = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'text="{quoted}"'
    return f"value={int(value) if isinstance(value, bool) else value!r}"
