"""A snapshot: a PLC's data at one time. ``fatektool.snapshot/1``.

::

    time target station protocol running duration_s requests
    values   {key: value}                       for people and scripts
    elements {key: {element, type, raw, unit?, scale?, offset?, comment?}}   for writing it back
    errors   {key: why its value is null}
    not_asked [key, …]                          those of errors that the PLC was not asked for, if any
"""

from __future__ import annotations

import math
import os
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from fatektool.callbacks import ignore
from fatektool.errors import DataError, UsageError
from fatektool.files.atomic import STANDARD, file_error, is_pipe, read_bounded
from fatektool.files.strict_json import read_json
from fatektool.files.times import utc
from fatektool.jobs.elements.extent import limits
from fatektool.jobs.elements.reads import read_elements
from fatektool.jobs.snapshots.spec import everything, items_in
from fatektool.jobs.status import brief_or_none
from fatektool.protocol.commands import Command
from fatektool.protocol.elements import Element
from fatektool.protocol.values import NUMBERS, Value, ValueType, decode, raw_text

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from fatektool.client import Plc
    from fatektool.jobs.progress import Progress
    from fatektool.jobs.snapshots.spec import SpecItem
    from fatektool.protocol.elements import Stretch
    from fatektool.protocol.status import BriefStatus

SCHEMA: Final = "fatektool.snapshot/1"
MAX_SNAPSHOT: Final = 64 << 20
_LINES_LOOKED_AT: Final = 100
_LARGEST: Final = 1.7e308
_TIME: Final = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z", re.ASCII)
_HEX: Final = re.compile(r"[0-9A-F]{1,8}")


@dataclass(frozen=True, slots=True)
class Snapshot:
    """One snapshot, as its document has it.

    Attributes:
        time: when it was begun, UTC, RFC 3339.
        target: as the user named it.
        station: 1 to 254; over Modbus TCP also 0 and 255.
        protocol: ``facon``.
        running: True in RUN; None if the protocol does not have it.
        duration_s: how long the reading took.
        requests: how many requests it took.
        values: by key; None where there is an error.
        elements: by key: element, type, raw and, where there is one, unit, scale, offset, comment.
        errors: by key: why there is no value.
        not_asked: keys of ``errors`` that the PLC was not asked for; not in the document if none are.
    """

    time: str
    target: str
    station: int
    protocol: str
    running: bool | None
    duration_s: float
    requests: int
    values: dict[str, Value | None]
    elements: dict[str, dict[str, Any]]
    errors: dict[str, str]
    not_asked: list[str] = field(default_factory=list)

    def document(self) -> dict[str, Any]:
        """The snapshot as JSON has it."""
        document = {"schema": SCHEMA, **{name: getattr(self, name) for name in self.__slots__}}
        if not self.not_asked:
            del document["not_asked"]
        return document


def take_snapshot(plc: Plc, items: Sequence[SpecItem], progress: Progress = ignore) -> Snapshot:
    """Read all items; one that the PLC refuses is None and listed under ``errors``.

    Args:
        plc: the PLC.
        items: what to read.
        progress: called after each answer, with the number of elements.

    Raises:
        LineError: no answer.
    """
    return snapshot_and_status(plc, items, progress)[0]


def snapshot_and_status(
    plc: Plc, items: Sequence[SpecItem], progress: Progress = ignore
) -> tuple[Snapshot, BriefStatus | None]:
    """The same, and the status (40) that was read before it; None where there is none.

    Raises:
        LineError: no answer.
    """
    return _snapshot(plc, [item.item.element for item in items], lambda: items, None, progress)


def take_all(plc: Plc, progress: Progress = ignore) -> Snapshot:
    """Read all that the PLC has by its status (53); ``progress`` as for ``take_snapshot``.

    Raises:
        LineError: no answer.
        DataError: its answer to 53 has a layout that no paper describes.
    """
    system = plc.detailed_status().system
    stretches = everything(system)
    return _snapshot(plc, stretches, lambda: items_in(stretches), limits(system), progress)[0]


def _snapshot(
    plc: Plc,
    wanted: Sequence[Element | Stretch],
    items_of: Callable[[], Sequence[SpecItem]],
    within: Mapping[str, int] | None,
    progress: Progress,
) -> tuple[Snapshot, BriefStatus | None]:
    clock = plc.link.transport.clock
    time, began = utc(), clock()
    tells = Command.BRIEF_STATUS in plc.link.codec.commands
    status = brief_or_none(plc)
    reading = read_elements(plc, wanted, limits=within, progress=progress)
    items = items_of()  # not before all is read: there may be many thousands
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
            values[key] = value_of(raw, item.item.type, element.kind.bits, item.scale, item.offset)
        except DataError as error:
            errors[key] = error.message
    snapshot = Snapshot(
        time,
        plc.target,
        plc.link.station,
        plc.link.codec.name,
        None if status is None else status.flags.running,
        round(reading.ended - began, 3),
        reading.requests + tells,
        values,
        elements,
        errors,
        [item.item.key for item in items if item.item.element in reading.not_asked],
    )
    return snapshot, status


def _element(item: SpecItem, raw: int | None) -> dict[str, Any]:
    bits = item.item.element.kind.bits
    found: dict[str, Any] = {
        "element": str(item.item.element),
        "type": item.item.type.value,
        "raw": None if raw is None else raw_text(raw, bits),
    }
    for name in ("unit", "scale", "offset"):
        value = getattr(item, name)
        if value is not None:
            found[name] = value
    return found


def value_of(raw: int, kind: ValueType, bits: int, scale: float | None, offset: float | None) -> Value:
    """Raw bits as a value, scaled.

    Raises:
        DataError: the bits are no such value.
    """
    value = decode(raw, kind, bits)
    if scale is None and offset is None:
        return value
    # Twelve digits: 21.400000000000002 is 214 * 0.1, and nobody's measurement.
    number = float(f"{float(value) * (1.0 if scale is None else scale) + (offset or 0.0):.12g}")
    if not math.isfinite(number):
        raise DataError(f"{value} scaled is too large for a number")
    return number


def parse_snapshot(data: bytes, name: str, note: Callable[[str], None] = ignore) -> Snapshot:
    """Read a snapshot: a JSON document, or the last whole line of an NDJSON file.

    Args:
        data: the file's bytes.
        name: its name, for messages.
        note: gets a message if the last line is incomplete and an earlier one is used.

    Raises:
        DataError: it is none, or damaged; says what.
    """
    document = _document(data, name, note)
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        found = document.get("schema") if isinstance(document, dict) else None
        raise DataError(
            f"{name}: not a snapshot: expected schema {SCHEMA!r}, got {found!r:.80}",
            hint="check the file name",
            file=name,
        )
    for key, holds in _CHECKS.items():
        if key not in document or not holds(document[key]):
            raise DataError(f"{name}: {key} is missing or damaged", file=name)
    if set(document["values"]) != set(document["elements"]):
        key = min(set(document["values"]) ^ set(document["elements"]))
        raise DataError(f"{name}: {key!r} is in only one of values and elements", file=name)
    for key, part in document["elements"].items():
        _check(part, document["values"][key], f"{name}: element {key!r}")
    not_asked = document.get("not_asked", [])
    if not isinstance(not_asked, list) or not all(
        isinstance(key, str) and key in document["errors"] for key in not_asked
    ):
        raise DataError(f"{name}: not_asked is damaged", file=name)
    return Snapshot(**{key: document[key] for key in _CHECKS}, not_asked=not_asked)


def _document(data: bytes, name: str, note: Callable[[str], None]) -> object:
    try:
        return read_json(data)
    except ValueError as error:
        first = error
    lines = data.strip().split(b"\n")[-_LINES_LOOKED_AT:]
    for number, line in enumerate(reversed(lines)):
        try:
            document = read_json(line)
        except ValueError:
            continue
        if isinstance(document, dict) and "schema" in document:
            if number:
                taken = f"the snapshot of {document.get('time')} is used instead"
                note(f"{name}: the last line is incomplete: {taken}")
            return document
    raise DataError(
        f"{name}: not a snapshot, or a damaged one: {first}", hint="check the file name", file=name
    ) from first


def _finite(value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return -_LARGEST < value < _LARGEST


def _is_value(value: object) -> bool:
    return value is None or isinstance(value, bool | str) or _finite(value)


_CHECKS: Final[dict[str, Callable[[Any], bool]]] = {
    "time": lambda value: isinstance(value, str) and _TIME.fullmatch(value) is not None,
    "target": lambda value: isinstance(value, str),
    "station": lambda value: type(value) is int and 0 <= value <= 255,
    "protocol": lambda value: isinstance(value, str),
    "running": lambda value: value is None or isinstance(value, bool),
    "duration_s": lambda value: _finite(value) and value >= 0,
    "requests": lambda value: type(value) is int and value >= 0,
    "values": lambda value: isinstance(value, dict) and all(map(_is_value, value.values())),
    "elements": lambda value: isinstance(value, dict),
    "errors": lambda value: isinstance(value, dict) and all(isinstance(text, str) for text in value.values()),
}


def _check(part: object, value: Value | None, where: str) -> None:
    """Check what a snapshot says of one element, and that its value is what its raw bits say.

    Raises:
        DataError: it does not hold.
    """
    if not isinstance(part, dict):
        raise DataError(f"{where} is damaged: expected an object")
    raw, scale, offset = part.get("raw"), part.get("scale"), part.get("offset")
    try:
        element, kind = Element.parse(part["element"]), ValueType(part["type"])
    except (KeyError, TypeError, ValueError, AttributeError, UsageError) as error:
        raise DataError(f"{where} is damaged: element or type") from error
    bits, its_bits = element.kind.bits, kind.bits
    if its_bits not in {None, bits} or (its_bits is None and bits == 1):
        raise DataError(f"{where} is damaged: {element} is no {kind.value}")
    numbers = (scale is None or _finite(scale)) and (offset is None or _finite(offset))
    scaled = (scale, offset) != (None, None)
    texts = isinstance(part.get("unit", ""), str) and isinstance(part.get("comment", ""), str)
    if not numbers or not texts or (scaled and kind not in NUMBERS):
        raise DataError(f"{where} is damaged: unit, scale, offset or comment")
    if raw is None and "raw" in part:
        if value is None:
            return
        raise DataError(f"{where} is damaged: a value without raw bits")
    if not isinstance(raw, str) or not _HEX.fullmatch(raw) or int(raw, 16) >= 1 << bits:
        raise DataError(f"{where} is damaged: raw: expected {bits} bits in hex, got {raw!r:.40}")
    try:
        expected = value_of(int(raw, 16), kind, bits, scale, offset)
    except DataError:
        expected = None
    if expected != value or isinstance(expected, bool) != isinstance(value, bool):
        raise DataError(
            f"{where}: its value is {value!r:.40}, but its raw bits {raw} are {expected!r:.40}",
            hint="the raw bits are what is written back: change both, or use 'fatektool write'",
        )


def load_snapshot(path: Path, note: Callable[[str], None] = ignore) -> Snapshot:
    """Read a snapshot file, or the last whole line of an NDJSON one, however long that is.

    Args:
        path: the file.
        note: gets a message if the last line is incomplete and an earlier one is used.

    Raises:
        UsageError: there is no such file.
        DataError: it is none, or damaged.
    """
    if str(path) == STANDARD or is_pipe(path):
        return parse_snapshot(read_bounded(path, MAX_SNAPSHOT), str(path), note)
    try:
        with path.open("rb") as file:
            data = file.read(MAX_SNAPSHOT + 1)
            if len(data) > MAX_SNAPSHOT:  # years of lines: the end is what counts
                file.seek(-MAX_SNAPSHOT, os.SEEK_END)
                data = file.read(MAX_SNAPSHOT).partition(b"\n")[2]
    except (OSError, ValueError) as error:
        raise file_error("read", path, error) from error
    return parse_snapshot(data, str(path), note)


def raw_of(snapshot: Snapshot) -> dict[str, tuple[Element, int | None]]:
    """Element and raw bits by key."""
    return {
        key: (
            Element.parse(part["element"]),
            None if part["raw"] is None else int(part["raw"], 16),
        )
        for key, part in snapshot.elements.items()
    }
