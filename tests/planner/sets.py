"""Sets of elements to plan for: random but repeatable, and strategies that shrink."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypothesis import strategies as st

from fatektool.errors import UsageError
from fatektool.protocol.elements import KINDS, Element
from tests.planner.exhaustive import places_of

if TYPE_CHECKING:
    from collections.abc import Iterable
    from random import Random

    from fatektool.protocol.codec import Codec

FAMILIES: list[list[str]] = [
    ["R"],
    ["R", "R", "DR"],
    ["M"],
    ["M", "M", "WM", "DWM"],
    ["R", "M"],
    ["R", "D", "DR", "X", "WY", "Y"],
    ["RT", "DRT", "T", "WT"],
    ["RC", "DRC", "R"],
    list(KINDS),
]
"""Kinds that are asked for together; one given twice is asked for more often."""
SPANS = (12, 30, 60, 150, 400)
TURNAROUNDS = (0.0, 10.0, 115.0, 1000.0)


def named(text: str) -> list[Element]:
    """``R0 R5-R9 DWM8`` as elements."""
    found: list[Element] = []
    for word in text.split():
        first, _, last = word.partition("-")
        element = Element.parse(first)
        count = (Element.parse(last).address - element.address) // element.kind.stride if last else 0
        found += [element.after(place) for place in range(count + 1)]
    return found


def at(symbol: str, address: int) -> Element:
    """The element at an address, or the one below that is a multiple of the kind's step."""
    kind = KINDS[symbol]
    address = min(address, kind.last)
    return Element(symbol, address - address % kind.step)


def small_set(random: Random, most: int = 9) -> list[Element]:
    """A few elements, somewhere close together."""
    kinds = random.choice(FAMILIES)
    span = random.choice(SPANS)
    base = random.choice((0, 0, 0, 1000, 9999 - span))
    return [at(random.choice(kinds), base + random.randrange(span)) for _ in range(random.randint(1, most))]


def side_by_side(random: Random, most: int) -> list[Element]:
    """Elements one behind the other, of one line or two, with gaps now and then."""
    kinds = random.choice((["R"], ["R", "R", "DR"], ["DR"], ["M"], ["M", "WM"], ["M", "M", "WM", "DWM"]))
    gaps = random.choice((0.0, 0.1, 0.4))
    found: list[Element] = []
    address = random.randrange(20)
    for _ in range(random.randint(1, most)):
        kind = KINDS[random.choice(kinds)]
        address += -address % kind.step
        found.append(Element(kind.symbol, address))
        address += kind.stride if kind.symbol != "DR" else 2
        address += (random.random() < gaps) * random.randint(1, 20)
    return found


def scattered(random: Random, symbol: str, within: int, count: int) -> list[Element]:
    """So many elements of one kind, each once."""
    step = KINDS[symbol].step
    return [Element(symbol, step * n) for n in random.sample(range(within // step), count)]


def sayable(elements: Iterable[Element], codec: Codec, *, writes: bool = False) -> list[Element]:
    """Those that a protocol has; Modbus writes 32-bit counters one at a time, which is no search."""
    found = []
    for element in elements:
        try:
            codec.neighbourhood(element, writes=writes)
        except UsageError:
            continue
        if not (writes and element.symbol == "DRC" and not codec.mixed_words(writes=True)):
            found.append(element)
    return found


def apart(elements: Iterable[Element]) -> list[Element]:
    """Those that share nothing with one before them."""
    taken: set[tuple[str, int]] = set()
    found = []
    for element in elements:
        here = places_of([element])
        if element.symbol in {"DRT", "DRC"}:  # two of the single ones
            here = {(element.symbol[1:], element.address + half) for half in (0, 1)}
        if not here & taken:
            taken |= here
            found.append(element)
    return found


@st.composite
def element_sets(draw: st.DrawFn, most: int = 9, areas: dict[str, int] | None = None) -> list[Element]:
    """A few elements, with a habit of being close together.

    Args:
        draw: of hypothesis.
        most: how many there may be.
        areas: how many of each kind of discrete and register there are; by default as many as can be written.
    """
    kinds = draw(st.sampled_from(FAMILIES))
    span = draw(st.sampled_from(SPANS))
    base = draw(st.sampled_from((0, 8, 1000, 9999 - span))) if areas is None else 0
    found = []
    for _ in range(draw(st.integers(1, most))):
        symbol = draw(st.sampled_from(kinds))
        address = base + draw(st.integers(0, span - 1))
        if areas is not None:
            area = {True: symbol[-1], False: symbol.removeprefix("D") or "D"}["W" in symbol]
            width = KINDS[symbol].bits if "W" in symbol else 2
            address = min(address, areas[area] - width)
        found.append(at(symbol, address))
    return found
