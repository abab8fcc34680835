"""A snapshot: what a PLC's data were at one time. ``fatektool.snapshot/1``.

::

    time target station protocol running duration_s requests
    values   {key: value}                       what people and scripts want
    elements {key: {element, type, raw, unit?, scale?, offset?}}    what it takes to put it back
    errors   {key: why its value is null}
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import DataError, UsageError
from fatektool.jobs.registers import read_elements
from fatektool.jobs.times import utc
from fatektool.program.files import read_bounded
from fatektool.protocol.elements import Element
from fatektool.protocol.values import Value, decode

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.jobs.snapshot_spec import SpecItem

SCHEMA: Final = "fatektool.snapshot/1"
MAX_SNAPSHOT: Final = 64 << 20


@dataclass(frozen=True, slots=True)
class Snapshot:
    """One snapshot, as its document has it.

    Attributes:
        time: when it was begun, UTC, RFC 3339.
        target: as the user named it.
        station: 1 to 254.
        protocol: ``facon``.
        running: True in RUN.
        duration_s: how long the reading took.
        requests: how many requests it took.
        values: by key; None where there is an error.
        elements: by key: element, type, raw and, where there is one, unit, scale, offset.
        errors: by key: why there is no value.
    """

    time: str
    target: str
    station: int
    protocol: str
    running: bool
    duration_s: float
    requests: int
    values: dict[str, Value | None]
    elements: dict[str, dict[str, Any]]
    errors: dict[str, str]

    def document(self) -> dict[str, Any]:
        """The snapshot as JSON has it."""
        return {"schema": SCHEMA, **{name: getattr(self, name) for name in self.__slots__}}


def take_snapshot(
    plc: Plc, items: Sequence[SpecItem], *, limits: Mapping[str, int] | None = None
) -> Snapshot:
    """Read all items; one that the PLC refuses is None and listed under ``errors``.

    Args:
        plc: the PLC.
        items: what to read.
        limits: how many discretes of each kind the PLC has, where that is known.

    Raises:
        LineError: no answer.
    """
    clock = plc.link.transport.clock
    time, began = utc(), clock()
    running = plc.brief_status().flags.running
    reading = read_elements(plc, [item.item.element for item in items], limits=limits)
    values: dict[str, Value | None] = {}
    elements: dict[str, dict[str, Any]] = {}
    errors: dict[str, str] = {}
    for item in items:
        key, element = item.item.key, item.item.element
        raw = reading.values.get(element)
        elements[key] = _element(item, raw)
        values[key] = None
        if raw is None:
            errors[key] = reading.errors[element]
            continue
        try:
            values[key] = _scaled(decode(raw, item.item.type, element.kind.bits), item)
        except DataError as error:
            errors[key] = error.message
    return Snapshot(
        time,
        plc.target,
        plc.link.station,
        plc.link.codec.name,
        running,
        round(clock() - began, 3),
        reading.requests + 1,
        values,
        elements,
        errors,
    )


def _element(item: SpecItem, raw: int | None) -> dict[str, Any]:
    bits = item.item.element.kind.bits
    found: dict[str, Any] = {
        "element": str(item.item.element),
        "type": item.item.type.value,
        "raw": None if raw is None else f"{raw:0{max(1, bits // 4)}X}",
    }
    for name in ("unit", "scale", "offset"):
        value = getattr(item, name)
        if value is not None:
            found[name] = value
    return found


def _scaled(value: Value, item: SpecItem) -> Value:
    if item.scale is None and item.offset is None:
        return value
    # Twelve digits: 21.400000000000002 is 214 * 0.1, and nobody's measurement.
    scale = 1.0 if item.scale is None else item.scale
    return float(f"{float(value) * scale + (item.offset or 0.0):.12g}")


def parse_snapshot(data: bytes, name: str) -> Snapshot:
    """Read a snapshot: a JSON document, or the last line of an NDJSON file.

    Raises:
        DataError: it is none, or damaged; says what.
    """
    text = data.strip()
    try:
        document = json.loads(text.decode())
    except (ValueError, RecursionError):
        try:
            document = json.loads(text.rpartition(b"\n")[2].decode())
        except (ValueError, RecursionError) as error:
            raise DataError(f"{name}: no snapshot: {error}", hint="is it the right file?") from error
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        raise DataError(f"{name}: no snapshot: expected schema {SCHEMA!r}", hint="is it the right file?")
    kinds = {
        "time": str, "target": str, "station": int, "protocol": str, "running": bool,
        "duration_s": (int, float), "requests": int, "values": dict, "elements": dict, "errors": dict,
    }  # fmt: skip
    for key, kind in kinds.items():
        if not isinstance(document.get(key), kind):  # type: ignore[arg-type]  # a type or a tuple of them
            raise DataError(f"{name}: {key} is missing or damaged")
    for key, part in document["elements"].items():
        if not _holds(part, document["values"], key):
            raise DataError(f"{name}: element {key!r} is damaged")
    return Snapshot(**{key: document[key] for key in kinds})


def _holds(part: object, values: dict[str, object], key: str) -> bool:
    if not isinstance(part, dict) or key not in values:
        return False
    try:
        element = Element.parse(part["element"])
        raw = part["raw"]
        return raw is None or 0 <= int(raw, 16) < 1 << element.kind.bits
    except (KeyError, TypeError, ValueError, AttributeError, UsageError):
        return False


def load_snapshot(path: Path) -> Snapshot:
    """Read a snapshot file, or the last line of an NDJSON one.

    Raises:
        UsageError: there is no such file.
        DataError: it is none, or damaged.
    """
    return parse_snapshot(read_bounded(path, MAX_SNAPSHOT), str(path))


def raw_of(snapshot: Snapshot) -> dict[str, tuple[Element, int | None]]:
    """Element and raw bits by key."""
    return {
        key: (
            Element.parse(part["element"]),
            None if part["raw"] is None else int(part["raw"], 16),
        )
        for key, part in snapshot.elements.items()
    }
