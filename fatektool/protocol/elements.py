"""Elements of a PLC: ``R12``, ``WY8``, ``DR2`` and back.

An element is a kind and an address. The kinds fall into three widths (FACON paper, section 4.1)::

    1 bit    X Y M S T C                    a discrete
    16 bits  WX WY WM WS WT WC              16 discretes, address a multiple of 8, next one 16 on
             RT RC R D F                    a register, next one 1 on
    32 bits  DWX DWY DWM DWS DWT DWC        32 discretes, address a multiple of 8, next one 32 on
             DRT DRC DR DD DF               two registers, low word first, next one 2 on

Addresses are decimal. The ranges are the largest of all models: a PLC answers error A above its own.
F and DF are only in the M-series paper (section 2.4); FACON writes them like R and DR.
"""

from __future__ import annotations

import re
from functools import partial, total_ordering
from typing import TYPE_CHECKING, Final

from fatektool.errors import UsageError
from fatektool.value import Value, frozen

if TYPE_CHECKING:
    from collections.abc import Iterator


@frozen
class ElementKind(Value):
    """A kind of element.

    Attributes:
        symbol: one to three capital letters.
        bits: width of one element: 1, 16 or 32.
        stride: the distance between the addresses of consecutive elements.
        step: an address is a multiple of this.
        last: the largest address of any model.
        digits: the digits of an address in FACON.
    """

    symbol: str
    bits: int
    stride: int
    step: int
    last: int
    digits: int

    @property
    def words(self) -> int:
        """Words that one element counts in the limits of 46 to 49: a discrete 1, 32 bits 2."""
        return 2 if self.bits == 32 else 1


def _kinds() -> dict[str, ElementKind]:
    kinds: dict[str, ElementKind] = {}
    for symbol in "XYMSTC":
        kinds[symbol] = ElementKind(symbol, 1, 1, 1, 9999, 4)
        kinds[f"W{symbol}"] = ElementKind(f"W{symbol}", 16, 16, 8, 9984, 4)
        kinds[f"DW{symbol}"] = ElementKind(f"DW{symbol}", 32, 32, 8, 9968, 4)
    for symbol, last, digits in (
        ("RT", 9999, 4),
        ("RC", 9999, 4),
        ("R", 65535, 5),
        ("D", 65535, 5),
        ("F", 65535, 5),
    ):
        kinds[symbol] = ElementKind(symbol, 16, 1, 1, last, digits)
        kinds[f"D{symbol}"] = ElementKind(f"D{symbol}", 32, 2, 1, last - 1, digits)
    return kinds


KINDS: Final[dict[str, ElementKind]] = _kinds()

_WRITTEN = re.compile(r"([A-Za-z]{1,3})([0-9]{1,12})", re.ASCII)


@total_ordering
@frozen
class Element(Value):
    """One element: ``Element("R", 12)``, written ``R12``.

    Raises:
        UsageError: an unknown symbol, an address past the largest of any model, or one that is not a
            multiple of the kind's step.
    """

    symbol: str
    address: int

    def __post_init__(self) -> None:
        kind = KINDS.get(self.symbol)
        if kind is None:
            raise UsageError(
                f"unknown element kind {self.symbol!r}: expected one of {' '.join(KINDS)}",
                element=f"{self.symbol}{self.address}",
            )
        if not 0 <= self.address <= kind.last:
            raise UsageError(
                f"element {self}: address out of range: expected 0 to {kind.last}, got {self.address}",
                element=str(self),
            )
        if self.address % kind.step:
            below = self.address - self.address % kind.step
            raise UsageError(
                f"element {self}: expected an address that is a multiple of {kind.step}, got {self.address}",
                hint=f"{self.symbol}{below} contains {self.symbol[-1]}{self.address}",
                element=str(self),
            )

    # Of its own, as elements are compared and sorted by the thousand.
    def __eq__(self, other: object) -> bool:
        return type(other) is Element and self.address == other.address and self.symbol == other.symbol

    def __hash__(self) -> int:
        return hash((self.symbol, self.address))

    def __lt__(self, other: Element) -> bool:
        return (self.symbol, self.address) < (other.symbol, other.address)

    @property
    def kind(self) -> ElementKind:
        """The element's kind."""
        return KINDS[self.symbol]

    def __str__(self) -> str:
        return f"{self.symbol}{self.address}"

    def after(self, count: int) -> Element:
        """The element ``count`` places on: ``WY8`` after 1 is ``WY24``, ``DR0`` after 1 is ``DR2``."""
        return Element(self.symbol, self.address + count * self.kind.stride)

    @classmethod
    def of(cls, element: Element | str) -> Element:
        """An element, given as one or as its text.

        Raises:
            UsageError: it is none.
        """
        if isinstance(element, Element):
            return element
        if not isinstance(element, str):
            raise UsageError(f"expected an element such as 'R12', got {element!r:.80}")
        return cls.parse(element)

    @classmethod
    def parse(cls, text: str) -> Element:
        """Parse an element: ``R12``, ``x0016``, ``DWM0``.

        Raises:
            UsageError: it is not an element.
        """
        match = _WRITTEN.fullmatch(text.strip())
        if match is None:
            raise UsageError(
                f"{text!r} is not an element: expected symbol and decimal address such as R12, X16 or DWM0",
                element=text,
            )
        return cls(match[1].upper(), int(match[2]))


@frozen
class Stretch(Value):
    """Consecutive elements of one kind, a number of them from a first one: such as all registers R of a PLC.

    Raises:
        UsageError: the last one does not exist, or there is none.
    """

    first: Element
    count: int

    def __post_init__(self) -> None:
        if self.count < 1:
            raise UsageError(f"from {self.first}: expected 1 element or more, got {self.count}")
        self.first.after(self.count - 1)

    @property
    def last(self) -> Element:
        """The last element."""
        return self.first.after(self.count - 1)

    def __iter__(self) -> Iterator[Element]:
        symbol, address, stride = self.first.symbol, self.first.address, self.first.kind.stride
        return map(partial(Element, symbol), range(address, address + self.count * stride, stride))
