"""The values that a user assigns: ``R12=4261``, ``Y0=on``, ``D4:f32=1.5``, ``R0:3=1,2,3``, ``R0-R9=0``.

The left side is a selection. The right side is one value for all its elements, or one for each, with commas;
or a text, ``R0-R9:str=PRESS 4``, of which each register gets two characters and the rest 0.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.errors import LineError, PlcBusy, UsageError
from fatektool.jobs.elements.selection import overlapping, parse_item
from fatektool.jobs.elements.writes import write_elements
from fatektool.protocol.texts import divided
from fatektool.protocol.values import TEXTS, Value, ValueType, encode

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from fatektool.client import Plc
    from fatektool.jobs.elements.selection import Item
    from fatektool.jobs.elements.writes import NotTaken


def parse_assignments(texts: Iterable[str]) -> list[tuple[Item, int]]:
    """Read assignments: items with raw, unsigned values.

    Raises:
        UsageError: a text is not an assignment, a value does not fit, or two targets overlap.
    """
    return _apart(pair for text in texts for pair in parse_assignment(text))


def parse_assignment(text: str) -> list[tuple[Item, int]]:
    """Read one assignment.

    Raises:
        UsageError: it is none.
    """
    left, sign, right = text.partition("=")
    if not sign or not right.strip():
        raise UsageError(f"{text!r}: expected ELEMENT=VALUE, such as R12=4261, Y0=on or D4:f32=1.5")
    values = [right] if _type(left) in TEXTS else right.split(",")
    return _assigned(left, values, repr(text))


def assigned(values: Mapping[str, Value | Sequence[Value]]) -> list[tuple[Item, int]]:
    """The same for values by selection, as a program has them: ``{"R12": 5, "Y0": True, "R0:3": [1, 2, 3]}``.

    Raises:
        UsageError: a key is no selection, a value does not fit, or two targets overlap.
    """
    found = []
    for left, value in values.items():
        several = [value] if isinstance(value, Value) else value
        if not isinstance(several, list | tuple):
            raise UsageError(f"{left}: expected a number, a bool, text or a list of these, got {value!r:.80}")
        found += _assigned(left, [_text(left, each) for each in several], left)
    return _apart(found)


def _text(left: str, value: Value) -> str:
    """A value of a program as a user would write it."""
    in_hex = _type(left) is ValueType.HEX
    return f"{value:X}" if in_hex and isinstance(value, int) else str(value)


def _type(left: str) -> ValueType | None:
    """The type that a selection names; None if it names none."""
    word = left.rpartition(":")[2].strip().lower()
    return ValueType(word) if word in {kind.value for kind in ValueType} else None


def _apart(pairs: Iterable[tuple[Item, int]]) -> list[tuple[Item, int]]:
    found = list(pairs)
    both = overlapping(item.element for item, _ in found)
    if both is not None:
        one, other = both
        raise UsageError(f"{one} and {other} overlap: expected each discrete and register once")
    return found


def _assigned(left: str, values: list[str], name: str) -> list[tuple[Item, int]]:
    items = parse_item(left)
    kind = _type(left)
    if len(values) == 1 and kind in TEXTS:
        values = divided(values[0], [item.element.kind.bits for item in items])
    elif len(values) == 1:
        values = values * len(items)
    if len(values) != len(items):
        expected = "1 value" if len(items) == 1 else f"1 value or {len(items)}"
        raise UsageError(f"{name}: expected {expected}, got {len(values)}")
    return [(item, _encoded(item, value, kind)) for item, value in zip(items, values, strict=True)]


def _encoded(item: Item, value: str, kind: ValueType | None) -> int:
    try:
        return encode(value, kind, item.element.kind.bits)
    except UsageError as error:
        raise UsageError(f"{item.key}: {error.message}", element=item.key) from error


def write_assignments(plc: Plc, pairs: Sequence[tuple[Item, int]]) -> list[NotTaken]:
    """Write them, read all back, and report what did not take.

    Raises:
        UsageError: the protocol cannot write one of them; nothing was sent.
        LineError: no answer; the hint says if some may be written.
    """
    try:
        return write_elements(plc, [(item.element, raw) for item, raw in pairs])
    except (LineError, PlcBusy) as error:
        if plc.link.counters.writes:
            left = _left(len(pairs))
            error.hint = f"{error.hint}; {left}" if error.hint else left
        raise


def _left(count: int) -> str:
    """What is to be known of the values when the line failed after the first was sent."""
    if count == 1:
        return "the value may have been written: read it, or write it again"
    return f"some of the {count} values may have been written: read them, or write them again"
