"""The values of elements, each of the type that the user asked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.callbacks import ignore
from fatektool.errors import DataError
from fatektool.jobs.elements.reads import read_elements
from fatektool.protocol.values import Value, decode, raw_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from fatektool.client import Plc
    from fatektool.jobs.elements.selection import Item
    from fatektool.jobs.progress import Progress


@dataclass(frozen=True, slots=True)
class ItemValues:
    """What was read.

    Attributes:
        items: what was asked for, in the order asked for.
        values: by key; None where there is an error.
        raw: by key: the bits in hex; None if they were not read.
        errors: by key: why there is no value.
        not_asked: keys of ``errors`` that the PLC was not asked for.
        requests: how many requests it took.
    """

    items: list[Item]
    values: dict[str, Value | None]
    raw: dict[str, str | None]
    errors: dict[str, str]
    not_asked: list[str]
    requests: int


def comments_of(items: Iterable[Item], comments: Mapping[str, str]) -> dict[str, str]:
    """The comments of items by key, of those that have one.

    Args:
        items: elements and types.
        comments: element -> comment, of a project.
    """
    if not comments:
        return {}
    from fatektool.project.comments import comment_of

    found = ((item.key, comment_of(str(item.element), comments)) for item in items)
    return {key: comment for key, comment in found if comment is not None}


def value_of(item: Item, raw: int | None) -> Value | None:
    """Raw bits as the type of an item; in hex if they are no such value."""
    if raw is None:
        return None
    try:
        return decode(raw, item.type, item.element.kind.bits)
    except DataError:
        return f"{raw:X}"


def read_items(plc: Plc, items: Sequence[Item], progress: Progress = ignore) -> ItemValues:
    """Read elements and decode each by its type.

    Args:
        plc: the PLC.
        items: elements and types.
        progress: called after each answer, with the number of elements.

    Raises:
        LineError: no answer.
    """
    reading = read_elements(plc, [item.element for item in items], progress=progress)
    values: dict[str, Value | None] = {}
    raw: dict[str, str | None] = {}
    errors: dict[str, str] = {}
    for item in items:
        key, bits = item.key, item.element.kind.bits
        values[key] = raw[key] = None
        if item.element in reading.errors:
            errors[key] = reading.errors[item.element]
            continue
        found = reading.values[item.element]
        raw[key] = raw_text(found, bits)
        try:
            values[key] = decode(found, item.type, bits)
        except DataError as error:
            errors[key] = error.message
    not_asked = [item.key for item in items if item.element in reading.not_asked]
    return ItemValues(list(items), values, raw, errors, not_asked, reading.requests)
