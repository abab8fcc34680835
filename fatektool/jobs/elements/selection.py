"""The elements that a user selects: ``R12``, ``R0-R99``, ``X0:16``, ``D4:f32``, ``R12:3:i16``.

::

    ELEMENT[-ELEMENT | :COUNT][:TYPE]

A range or count gives an item for each element. A type of 32 bits over a register or word of 16 takes the two
of them that begin there: ``D4:f32`` is the float in D4 and D5.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError
from fatektool.protocol.elements import KINDS, Element
from fatektool.protocol.values import ValueType, default_type

if TYPE_CHECKING:
    from collections.abc import Iterable

_WRITTEN: Final = re.compile(
    r"(?P<first>[A-Za-z]+[0-9]+)(?:-(?P<last>[A-Za-z]*[0-9]+)|:(?P<count>[0-9]+))?(?::(?P<type>[A-Za-z0-9]+))?",
    re.ASCII,
)
_MOST: Final = 100_000


@dataclass(frozen=True, slots=True)
class Item:
    """One selected element.

    Attributes:
        key: its name in output: the element as the user wrote it, short.
        element: what is read; of 32 bits for a type of 32 bits.
        type: how its bits are read.
    """

    key: str
    element: Element
    type: ValueType


def parse_items(texts: Iterable[str]) -> list[Item]:
    """Read the selections of a user; the same item twice is one.

    Raises:
        UsageError: a text is not a selection; says what was expected.
    """
    found: dict[str, Item] = {}
    for text in texts:
        for item in parse_item(text):
            known = found.setdefault(item.key, item)
            if known != item:
                raise UsageError(f"{item.key} is selected twice, as {known.type.value} and {item.type.value}")
            if len(found) > _MOST:
                raise UsageError(f"expected at most {_MOST} elements")
    return list(found.values())


def parse_item(text: str) -> list[Item]:
    """Read one selection.

    Raises:
        UsageError: it is none.
    """
    match = _WRITTEN.fullmatch(text.strip())
    if match is None:
        raise UsageError(
            f"{text!r}: expected an element, optionally with a range or count and a type, "
            f"such as R12, R0-R99, X0:16, D4:f32"
        )
    first = Element.parse(match["first"])
    kind = _type(match["type"], text)
    wide = kind is not None and kind.bits == 32 and first.kind.bits == 16
    stride = 2 * first.kind.stride if wide else first.kind.stride
    count = _count(text, first, match["last"], match["count"], stride)
    items = []
    for place in range(count):
        named = Element(first.symbol, first.address + place * stride)
        items.append(_item(named, kind, wide=wide))
    return items


def _item(named: Element, kind: ValueType | None, *, wide: bool) -> Item:
    element = Element(f"D{named.symbol}", named.address) if wide else named
    bits = element.kind.bits
    if kind is not None and not _fits(kind, bits):
        fitting = ", ".join(kind.value for kind in ValueType if _fits(kind, bits))
        width = "1 bit" if bits == 1 else f"{bits} bits"
        raise UsageError(f"{named}: {kind.value} does not fit {width}: expected {fitting}")
    return Item(str(named), element, kind or default_type(element.kind))


def _fits(kind: ValueType, bits: int) -> bool:
    return kind.bits == bits or (kind.bits is None and bits > 1)


def _type(text: str | None, whole: str) -> ValueType | None:
    if text is None:
        return None
    try:
        return ValueType(text.lower())
    except ValueError:
        names = ", ".join(kind.value for kind in ValueType)
        raise UsageError(f"{whole!r}: unknown type {text!r}: expected one of {names}") from None


def _count(text: str, first: Element, last: str | None, count: str | None, stride: int) -> int:
    if count is not None:
        number = int(count.lstrip("0")[:9] or "0")
        if not 1 <= number <= _MOST:
            raise UsageError(f"{text!r}: count: expected 1 to {_MOST}, got {count}")
        return number
    if last is None:
        return 1
    end = Element.parse(last if last[0].isalpha() else f"{first.symbol}{last}")
    if end.symbol != first.symbol or end.address < first.address:
        raise UsageError(f"{text!r}: expected a range of one kind, from the lower to the higher address")
    if (end.address - first.address) % stride:
        below = end.address - (end.address - first.address) % stride
        raise UsageError(
            f"{text!r}: {end} is not reached from {first} in steps of {stride}",
            hint=f"the nearest below is {first.symbol}{below}",
        )
    return (end.address - first.address) // stride + 1


def overlapping(elements: Iterable[Element]) -> tuple[Element, Element] | None:
    """Two of these elements that share a discrete or register; None if none do."""
    owner: dict[tuple[str, int], Element] = {}
    for element in elements:
        places = places_of(element)
        for place in places:
            if place in owner:
                return owner[place], element
        owner |= dict.fromkeys(places, element)
    return None


def places_of(element: Element) -> list[tuple[str, int]]:
    """The discretes or registers that an element is made of, the lowest first."""
    from fatektool.planner.atoms import atoms_of

    atoms = atoms_of(element)
    symbol = atoms[0][0]
    if KINDS[symbol].bits == 32:  # a counter's double register is two of the single ones
        return [(symbol[1:], element.address), (symbol[1:], element.address + 1)]
    return atoms
