"""The items of a snapshot with names, types, scales, units, from a TOML file or the command line.

::

    interval_s = 60                      # optional: the interval of 'watch', unless --interval is given

    [[item]]
    element = "R12"                      # as on the command line: R12, D4:f32, R0-R9, M0:16
    name = "pressure"                    # optional; a range gets pressure[0], pressure[1], …
    type = "i16"                         # optional, instead of after a colon
    scale = 0.1                          # optional: value = raw * scale + offset
    offset = -20.0
    unit = "bar"
    groups = ["hydraulics", "daily"]     # optional; --group picks. group = "hydraulics" for one
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import DataError, UsageError
from fatektool.files.atomic import read_bounded
from fatektool.files.plain_text import plain_text
from fatektool.files.strict_toml import read_toml
from fatektool.jobs.elements.extent import limits
from fatektool.jobs.elements.selection import Item, parse_item
from fatektool.protocol.elements import Element, Stretch
from fatektool.protocol.values import NUMBERS, default_type

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from fatektool.protocol.status import System

_KEYS: Final = {"element", "name", "type", "scale", "offset", "unit", "group", "groups"}
MAX_SPEC: Final = 1 << 20
MAX_ITEMS: Final = 100_000
_LONGEST_INTERVAL_S: Final = 86400.0
_LARGEST: Final = 1e300


@dataclass(frozen=True, slots=True)
class SpecItem:
    """One item of a snapshot.

    Attributes:
        item: key, element and type.
        scale: value = raw * scale + offset; None for the bare number.
        offset: see ``scale``.
        unit: in words, if there is one.
        groups: the groups it belongs to.
    """

    item: Item
    scale: float | None = None
    offset: float | None = None
    unit: str | None = None
    groups: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Spec:
    """What is read, and how often.

    Attributes:
        items: in the file's order.
        interval_s: the interval of ``watch``; None if the file has none.
    """

    items: list[SpecItem]
    interval_s: float | None = None


def items_of(selections: Iterable[Item]) -> list[SpecItem]:
    """Bare items, from the command line."""
    return [SpecItem(item) for item in selections]


def load_spec(path: Path, groups: Iterable[str] = ()) -> Spec:
    """Read a specification file.

    Args:
        path: the file.
        groups: only items of these groups; all if empty.

    Raises:
        UsageError: there is no such file.
        DataError: invalid TOML, a wrong key or value; says which item.
    """
    return parse_spec(read_bounded(path, MAX_SPEC), str(path), groups)


def parse_spec(data: bytes, name: str, groups: Iterable[str] = ()) -> Spec:
    """Read a specification.

    Args:
        data: the file's bytes.
        name: its name, for messages.
        groups: only items of these groups; all if empty.

    Raises:
        DataError: invalid TOML, a wrong key or value; says which item.
    """
    try:
        document = read_toml(plain_text(data))
    except ValueError as error:  # UnicodeDecodeError and TOMLDecodeError among them
        raise DataError(f"{name}: invalid TOML: {error}") from error
    unknown = set(document) - {"item", "interval_s"}
    entries = document.get("item")
    if unknown or not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        what = f"unknown key {min(unknown)!r}" if unknown else "no [[item]]"
        raise DataError(f"{name}: {what}: expected [[item]] tables with element = …")
    interval_s = _number(document, "interval_s", name)
    if interval_s is not None and not 0 < interval_s <= _LONGEST_INTERVAL_S:
        raise DataError(f"{name}: interval_s: expected 0 to {_LONGEST_INTERVAL_S:g}, got {interval_s:g}")
    wanted = set(groups)
    found: dict[str, SpecItem] = {}
    for number, entry in enumerate(entries, 1):
        for item in _items(entry, f"{name}: item {number}"):
            if wanted and wanted.isdisjoint(item.groups):
                continue
            if found.setdefault(item.item.key, item) != item:
                raise DataError(
                    f"{name}: item {number}: {item.item.key!r} is used twice: give it another name"
                )
            if len(found) > MAX_ITEMS:
                raise DataError(f"{name}: expected at most {MAX_ITEMS} elements")
    if wanted and not found:
        raise DataError(f"{name}: no item is in group {', '.join(sorted(wanted))}")
    return Spec(list(found.values()), interval_s)


def _items(entry: dict[str, Any], where: str) -> list[SpecItem]:
    unknown = set(entry) - _KEYS
    if unknown:
        raise DataError(f"{where}: unknown key {min(unknown)!r}: expected one of {', '.join(sorted(_KEYS))}")
    text = _text(entry, "element", where)
    if text is None:
        raise DataError(f'{where}: expected element = "R12"')
    kind = _text(entry, "type", where)
    try:
        items = parse_item(f"{text}:{kind}" if kind else text)
    except UsageError as error:
        raise DataError(f"{where}: {error.message}", hint=error.hint) from error
    name = _text(entry, "name", where)
    groups = (*_groups(entry, "group", where), *_groups(entry, "groups", where))
    made = []
    for place, item in enumerate(items):
        key = item.key if name is None else name if len(items) == 1 else f"{name}[{place}]"
        spec = SpecItem(
            replace(item, key=key),
            _number(entry, "scale", where),
            _number(entry, "offset", where),
            _text(entry, "unit", where),
            groups,
        )
        if (spec.scale, spec.offset) != (None, None) and item.type not in NUMBERS:
            raise DataError(f"{where}: scale and offset are for numbers, {item.key} is {item.type.value}")
        if spec.scale == 0:
            raise DataError(f"{where}: scale: expected a number other than 0")
        made.append(spec)
    return made


def _text(entry: dict[str, Any], key: str, where: str) -> str | None:
    value = entry.get(key)
    if value is None:
        return None
    if not isinstance(value, str) or not value or not value.isprintable():
        raise DataError(f"{where}: {key}: expected a text on one line, got {_short(value)}")
    return value


def _groups(entry: dict[str, Any], key: str, where: str) -> tuple[str, ...]:
    value = entry.get(key, [])
    names = [value] if isinstance(value, str) else value
    if not isinstance(names, list) or not all(isinstance(name, str) and name for name in names):
        raise DataError(f"{where}: {key}: expected a text or a list of texts, got {_short(value)}")
    return tuple(names)


def _number(entry: dict[str, Any], key: str, where: str) -> float | None:
    value = entry.get(key)
    if value is None:
        return None
    number = not isinstance(value, bool) and isinstance(value, int | float)
    if not number or not -_LARGEST < value < _LARGEST:  # NaN is in no range
        raise DataError(f"{where}: {key}: expected a number, got {_short(value)}")
    return float(value)


def _short(value: object) -> str:
    try:
        return f"{value!r:.60}"
    except (ValueError, RecursionError):  # a whole number of thousands of digits
        return "a very long number"


def everything(system: System) -> list[Stretch]:
    """All elements that the PLC has by 53: discretes, registers, timers and counters.

    L relays cannot be read over the link.
    """
    firsts = [(Element(symbol, 0), count) for symbol, count in limits(system).items()]
    return [Stretch(first, min(count, first.kind.last + 1)) for first, count in firsts if count]


def items_in(stretches: Iterable[Stretch]) -> list[SpecItem]:
    """An item for every element of some stretches, with the default type of its kind."""
    return [
        SpecItem(Item(str(element), element, kind))
        for stretch in stretches
        for kind in (default_type(stretch.first.kind),)
        for element in stretch
    ]
