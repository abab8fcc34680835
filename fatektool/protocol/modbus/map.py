"""Elements and their Modbus references, both ways: the standard map, and the user's own.

::

    0xxxx  coils               Y0 1     X0 1001   M0 2001   S0 6001   T0 9001   C0 9501
    1xxxx  discrete inputs     none but the user's own
    3xxxx  input registers     none but the user's own
    4xxxx  holding registers   R0 1     R5000 5001   D0 6001   RT0 9001   RC0 9501   DRC200 9701

A reference is written with five digits or six: 46012 and 406012 are the holding register at offset 6011, D11.
What is sent is the offset, one less than the reference and without its first digit.

C200 to C255 have 32 bits, two registers each: DRC200 is 409701 and 409702. The paper does not say which of
them is the low word; here it is the first, as in every 32-bit register of these PLCs. C0 to C199 have 16
bits.

With R3968 = A55AH, R3969 to R3971 map a range of M to coils, and R3978 to R3980 a range of R to holding
registers, *instead* of the standard map: R3968 itself then has no reference, unless the range contains it.
R3972 to R3974 map M to discrete inputs and R3975 to R3977 map R to input registers, with any value of R3968
(FBs link paper, section 13.3).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.errors import DataError, UsageError
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Sequence

CUSTOM: Final = 0xA55A
FIRST_REGISTER: Final = 3968
REGISTER_COUNT: Final = 13
LAST_OFFSET: Final = 0xFFFF

_WRITTEN: Final = re.compile(r"([0134])(\d{4,5})", re.ASCII)
_RANGE: Final = re.compile(r"([A-Za-z]+)(\d{1,5})(?:-(?:\1)?(\d{1,5}))?=(\d{5,6})", re.ASCII)


class ModbusArea(IntEnum):
    """The four kinds of Modbus reference, by their first digit."""

    COIL = 0
    DISCRETE_INPUT = 1
    INPUT_REGISTER = 3
    HOLDING_REGISTER = 4

    @property
    def words(self) -> str:
        """As text."""
        return self.name.lower().replace("_", " ")

    @property
    def of_bits(self) -> bool:
        """True for coils and discrete inputs."""
        return self in {ModbusArea.COIL, ModbusArea.DISCRETE_INPUT}

    @property
    def read_only(self) -> bool:
        """True for inputs."""
        return self in {ModbusArea.DISCRETE_INPUT, ModbusArea.INPUT_REGISTER}


@dataclass(frozen=True, slots=True)
class Reference:
    """One reference.

    Attributes:
        area: coil, discrete input, input register or holding register.
        offset: as sent, 0 to 65535.
    """

    area: ModbusArea
    offset: int

    @classmethod
    def parse(cls, text: str) -> Reference:
        """Parse a reference of five or six digits.

        Raises:
            UsageError: it is not a reference.
        """
        match = _WRITTEN.fullmatch(text.strip())
        if match is None or not 1 <= int(match[2]) <= LAST_OFFSET + 1:
            raise UsageError(
                f"{text!r} is not a Modbus reference: expected 0, 1, 3 or 4, then 0001 to 9999 or "
                f"00001 to 65536, such as 40001 or 400001"
            )
        return cls(ModbusArea(int(match[1])), int(match[2]) - 1)

    @property
    def five_digits(self) -> str | None:
        """The short form; None above 9999."""
        return f"{self.area:d}{self.offset + 1:04}" if self.offset < 9999 else None

    def __str__(self) -> str:
        return f"{self.area:d}{self.offset + 1:05}"


@dataclass(frozen=True, slots=True)
class MapStretch:
    """Consecutive elements with consecutive references.

    Attributes:
        area: of the references.
        offset: of the first.
        symbol: of the elements.
        first: the address of the first.
        count: how many there are.
        width: the references of each.
    """

    area: ModbusArea
    offset: int
    symbol: str
    first: int
    count: int
    width: int = 1

    def __str__(self) -> str:
        return f"{self.symbol}{self.first}-{self.symbol}{self.first + self.count - 1}"


@dataclass(frozen=True, slots=True)
class ReferenceRun:
    """The references of an element or a run of elements: the first, and their number."""

    area: ModbusArea
    offset: int
    count: int


class MappedElement(NamedTuple):
    """The element of a reference, or a half of one with 32 bits."""

    element: Element
    half: str | None


_STANDARD_BITS: Final = (
    MapStretch(ModbusArea.COIL, 0, "Y", 0, 256),
    MapStretch(ModbusArea.COIL, 1000, "X", 0, 256),
    MapStretch(ModbusArea.COIL, 2000, "M", 0, 2002),
    MapStretch(ModbusArea.COIL, 6000, "S", 0, 1000),
    MapStretch(ModbusArea.COIL, 9000, "T", 0, 256),
    MapStretch(ModbusArea.COIL, 9500, "C", 0, 256),
)
_STANDARD_REGISTERS: Final = (
    MapStretch(ModbusArea.HOLDING_REGISTER, 0, "R", 0, 4168),
    MapStretch(ModbusArea.HOLDING_REGISTER, 5000, "R", 5000, 999),
    MapStretch(ModbusArea.HOLDING_REGISTER, 6000, "D", 0, 2999),
    MapStretch(ModbusArea.HOLDING_REGISTER, 9000, "RT", 0, 256),
    MapStretch(ModbusArea.HOLDING_REGISTER, 9500, "RC", 0, 200),
    MapStretch(ModbusArea.HOLDING_REGISTER, 9700, "DRC", 200, 56, 2),
)
_OWN: Final = (  # R3969, R3972, …: area, symbol, last first address, most
    (ModbusArea.COIL, "M", 2001, 2001),
    (ModbusArea.DISCRETE_INPUT, "M", 2001, 2001),
    (ModbusArea.INPUT_REGISTER, "R", 3839, 3840),
    (ModbusArea.HOLDING_REGISTER, "R", 3839, 3840),
)


@dataclass(frozen=True, slots=True)
class ModbusMap:
    """Which elements have which references.

    Attributes:
        name: ``standard`` or ``custom``.
        stretches: the writable ones before those that can only be read.
    """

    name: str
    stretches: tuple[MapStretch, ...]

    def place(self, first: Element, count: int = 1, *, writes: bool = False) -> ReferenceRun:
        """The references of a run of elements.

        Args:
            first: the first of them.
            count: how many there are.
            writes: True for a write, for which inputs are not allowed.

        Raises:
            UsageError: one of them has no reference, or the references are not consecutive.
        """
        stretch, begin = self._one(first, writes=writes)
        last = first.after(count - 1)
        other, end = self._one(last, writes=writes)
        place = ReferenceRun(begin.area, begin.offset, end.offset + end.count - begin.offset)
        if stretch != other or (writes and place.count != count * begin.count):
            raise UsageError(f"{first} to {last} have no consecutive Modbus references")
        return place

    def stretch_of(self, element: Element, *, writes: bool = False) -> int:
        """The number of the stretch with this element.

        Raises:
            UsageError: it has no reference.
        """
        return self._one(element, writes=writes)[0]

    def element_at(self, reference: Reference) -> MappedElement | None:
        """The element of a reference; None if there is none."""
        for stretch in self.stretches:
            place, half = divmod(reference.offset - stretch.offset, stretch.width)
            if reference.area is stretch.area and 0 <= place < stretch.count:
                element = Element(stretch.symbol, stretch.first + place)
                return MappedElement(element, ("low word", "high word")[half] if stretch.width > 1 else None)
        return None

    @property
    def listed(self) -> str:
        """The elements in the map, for messages."""
        return " ".join(dict.fromkeys(map(str, self.stretches))) or "none"

    def _one(self, element: Element, *, writes: bool) -> tuple[int, ReferenceRun]:
        symbol, bits = element.symbol, element.kind.bits
        size = 1
        if "W" in symbol:
            symbol, size = symbol[-1], bits
        elif bits == 32 and symbol != "DRC":
            symbol, size = symbol[1:], 2
        readable = False
        for number, stretch in enumerate(self.stretches):
            at = element.address - stretch.first
            if stretch.symbol == symbol and 0 <= at <= stretch.count - size:
                if not (writes and stretch.area.read_only):
                    where = stretch.offset + at * stretch.width
                    return number, ReferenceRun(stretch.area, where, size * stretch.width)
                readable = True
        raise self._refused(element, readable=readable)

    def _refused(self, element: Element, *, readable: bool) -> UsageError:
        if readable:
            return UsageError(f"{element} can be read over Modbus, but not written", element=str(element))
        counter = element.symbol.removeprefix("D") == "RC" and self.name == STANDARD_NAME
        instead = f"{'RC' if element.symbol == 'DRC' else 'DRC'}{element.address}"
        if counter and element.address < 256:
            said = "C0 to C199 have 16 bits, C200 to C255 have 32"
            return UsageError(
                f"{element} has no Modbus reference: {said}", hint=f"use {instead}", element=str(element)
            )
        return UsageError(
            f"{element} has no Modbus reference: the {self.name} map has {self.listed}",
            hint="use --protocol facon on a port that is set to it" if self.name == STANDARD_NAME else None,
            element=str(element),
        )


STANDARD_NAME: Final = "standard"
STANDARD: Final = ModbusMap(STANDARD_NAME, _STANDARD_BITS + _STANDARD_REGISTERS)


def map_of_registers(words: Sequence[int]) -> ModbusMap:
    """The map in R3968 to R3980.

    A group with a value out of range maps nothing.

    Args:
        words: the thirteen registers.

    Raises:
        DataError: another number of registers.
    """
    if len(words) != REGISTER_COUNT:
        raise DataError(f"a Modbus map is R3968 to R3980: expected 13 registers, got {len(words)}")
    own = []
    for number, (area, symbol, last, most) in enumerate(_OWN):
        offset, first, count = words[1 + 3 * number : 4 + 3 * number]
        if first <= last and 1 <= count <= most:
            own.append(MapStretch(area, offset, symbol, first, min(count, LAST_OFFSET + 1 - offset)))
    return _composed(own, custom=words[0] == CUSTOM)


def parse_map(text: str) -> ModbusMap:
    """Parse a map: ``M1000-M1099=000001,R2000-R2199=400101``.

    Ranges of coils and holding registers replace the standard map, as with R3968 = A55AH; discrete inputs and
    input registers are added to it.

    Raises:
        UsageError: it is not a map.
    """
    own: list[MapStretch] = []
    for part in text.split(","):
        match = _RANGE.fullmatch(part.strip())
        if match is None:
            raise UsageError(
                f"Modbus map {part.strip()!r:.80}: expected ELEMENT-ELEMENT=REFERENCE, "
                f"such as M1000-M1099=000001,R2000-R2199=400101"
            )
        reference, symbol = Reference.parse(match[4]), match[1].upper()
        first = int(match[2])
        count = int(match[3] or first) - first + 1
        needed, last, most = next(row[1:] for row in _OWN if row[0] is reference.area)
        if symbol != needed or first > last or not 1 <= count <= most:
            raise UsageError(
                f"Modbus map {part.strip()!r}: {reference.area.words}: expected 1 to {most} of {needed}, "
                f"from {needed}0 to {needed}{last} on"
            )
        if reference.offset + count > LAST_OFFSET + 1:
            raise UsageError(f"Modbus map {part.strip()!r}: it continues after {reference.area:d}65536")
        if any(stretch.area is reference.area for stretch in own):
            raise UsageError(f"Modbus map {text!r:.80}: {reference.area.words}s are given twice")
        own.append(MapStretch(reference.area, reference.offset, symbol, first, count))
    return _composed(own, custom=any(not stretch.area.read_only for stretch in own))


def _composed(own: list[MapStretch], *, custom: bool) -> ModbusMap:
    inputs = tuple(stretch for stretch in own if stretch.area.read_only)
    if not custom:
        return ModbusMap(STANDARD_NAME, STANDARD.stretches + inputs)
    return ModbusMap("custom", tuple(stretch for stretch in own if not stretch.area.read_only) + inputs)
