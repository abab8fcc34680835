"""Elements and their Modbus references, both ways."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from fatektool.errors import UsageError
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus.map import ModbusArea, ModbusMap, Reference, ReferenceRun

_DIGITS: Final = re.compile(r"\d+", re.ASCII)
_FUNCTIONS: Final = {
    ModbusArea.COIL: ("01", "05", "0F"),
    ModbusArea.DISCRETE_INPUT: ("02",),
    ModbusArea.INPUT_REGISTER: ("04",),
    ModbusArea.HOLDING_REGISTER: ("03", "06", "10"),
}


@dataclass(frozen=True, slots=True)
class MapEntry:
    """An element, or a range of them, and where Modbus has it.

    Attributes:
        element: the first.
        place: area, offset and how many references.
        last_element: of a range; None for one element.
        half: which half of a 32-bit element a reference is, in words; None for all of it.
    """

    element: Element
    place: ReferenceRun
    last_element: Element | None = None
    half: str | None = None

    @property
    def reference(self) -> Reference:
        """The first reference."""
        return Reference(self.place.area, self.place.offset)

    @property
    def last_reference(self) -> Reference:
        """The last one; of one reference the same."""
        return Reference(self.place.area, self.place.offset + self.place.count - 1)

    @property
    def functions(self) -> tuple[str, ...]:
        """The functions that read and write there, in hex."""
        return _FUNCTIONS[self.place.area]


def find_entry(name: str, modbus_map: ModbusMap) -> MapEntry:
    """The entry of an element (``R100``) or of a reference (``406012``, ``46012``).

    Raises:
        UsageError: it is neither, or the map has no such element or reference.
    """
    if _DIGITS.fullmatch(name.strip()):
        reference = Reference.parse(name)
        found = modbus_map.element_at(reference)
        if found is None:
            ranges = ", ".join(f"{each.reference}-{each.last_reference}" for each in all_entries(modbus_map))
            raise UsageError(f"{reference}: no element of the PLC: the {modbus_map.name} map has {ranges}")
        return MapEntry(found.element, ReferenceRun(reference.area, reference.offset, 1), half=found.half)
    element = Element.parse(name)
    return MapEntry(element, modbus_map.place(element))


def all_entries(modbus_map: ModbusMap) -> list[MapEntry]:
    """The ranges of a map."""
    return [
        MapEntry(
            Element(each.symbol, each.first),
            ReferenceRun(each.area, each.offset, each.count * each.width),
            Element(each.symbol, each.first + each.count - 1),
        )
        for each in modbus_map.stretches
    ]
