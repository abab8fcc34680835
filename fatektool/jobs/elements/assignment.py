"""What a user wants written: ``R12=4261``, ``Y0=on``, ``D4:f32=1.5``, ``R0:3=1,2,3``, ``R0-R9=0``.

The left side is a selection. The right side is one value for all of it, or as many as it has, with commas.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.errors import UsageError
from fatektool.jobs.elements.selection import overlapping, parse_item
from fatektool.protocol.values import ValueType, encode

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.jobs.elements.selection import Item


def parse_assignments(texts: Iterable[str]) -> list[tuple[Item, int]]:
    """Read what a user wants written: items with raw, unsigned values.

    Raises:
        UsageError: a text is no assignment, a value does not fit, or two targets overlap.
    """
    found = [pair for text in texts for pair in parse_assignment(text)]
    both = overlapping(item.element for item, _ in found)
    if both is not None:
        one, other = both
        raise UsageError(f"{one} and {other} overlap: expected each discrete and register once")
    return found


def parse_assignment(text: str) -> list[tuple[Item, int]]:
    """Read one assignment.

    Raises:
        UsageError: it is none.
    """
    left, sign, right = text.partition("=")
    if not sign or not right.strip():
        raise UsageError(f"{text!r}: expected ELEMENT=VALUE, such as R12=4261, Y0=on or D4:f32=1.5")
    items = parse_item(left)
    values = right.split(",")
    if len(values) == 1:
        values *= len(items)
    if len(values) != len(items):
        expected = "1 value" if len(items) == 1 else f"1 value or {len(items)}"
        raise UsageError(f"{text!r}: expected {expected}, got {len(values)}")
    typed = left.rpartition(":")[2].strip().lower() in {kind.value for kind in ValueType}
    return [(item, _encoded(item, value, typed=typed)) for item, value in zip(items, values, strict=True)]


def _encoded(item: Item, value: str, *, typed: bool) -> int:
    try:
        return encode(value, item.type if typed else None, item.element.kind.bits)
    except UsageError as error:
        raise UsageError(f"{item.key}: {error.message}", element=item.key) from error
