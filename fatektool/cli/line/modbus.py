"""``modbus map``: elements and their Modbus references, both ways; no PLC."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

import click

from fatektool.cli.shared.modbus_map import map_alone_option
from fatektool.cli.shared.options import voice_options
from fatektool.cli.shared.output import Voice, table
from fatektool.errors import UsageError
from fatektool.protocol.elements import Element
from fatektool.protocol.modbus.map import Area, ModbusMap, Place, Reference

if TYPE_CHECKING:
    from collections.abc import Iterator

_DIGITS: Final = re.compile(r"\d+", re.ASCII)


@click.group("modbus", epilog="Example: fatektool modbus map R100 406012")
def modbus_command() -> None:
    """What Modbus calls the elements of a PLC."""


@modbus_command.command("map", epilog="Example: fatektool modbus map R100 X16 DRC200 406012 00001")
@click.argument("names", nargs=-1, metavar="ELEMENT|REFERENCE…")
@map_alone_option
@voice_options
def map_command(names: tuple[str, ...], voice: Voice, *, modbus_map: ModbusMap) -> None:
    """Show which reference an element has, and which element stands behind a reference.

    References have five digits or six: 46012 is 406012. Without a name the whole map is shown.
    """
    if not names:
        voice.show(_document(modbus_map, _stretches(modbus_map)), table(_whole(modbus_map)))
        return
    entries = [_entry(name, modbus_map) for name in names]
    rows = [(entry["element"], _references(entry)) for entry in entries]
    voice.show(_document(modbus_map, entries), table(rows))


def _entry(name: str, modbus_map: ModbusMap) -> dict[str, Any]:
    if _DIGITS.fullmatch(name.strip()):
        reference = Reference.parse(name)
        found = modbus_map.element_at(reference)
        if found is None:
            raise UsageError(
                f"{reference}: no element of the PLC: the {modbus_map.name} map has "
                f"{', '.join(row[1] for row in _whole(modbus_map))}"
            )
        return _described(found.element, Place(reference.area, reference.offset, 1), half=found.half)
    element = Element.parse(name)
    return _described(element, modbus_map.place(element))


def _described(
    element: Element, place: Place, *, last: Element | None = None, half: str | None = None
) -> dict[str, Any]:
    first, end = (Reference(place.area, offset) for offset in (place.offset, place.offset + place.count - 1))
    return {
        "element": str(element),
        "last_element": None if last is None else str(last),
        "half": half,
        "area": place.area.words,
        "reference": str(first),
        "reference5": first.five_digits,
        "last_reference": str(end),
        "offset": place.offset,
        "count": place.count,
        "functions": _functions(place),
    }


def _functions(place: Place) -> list[str]:
    """Those that read and write there."""
    return {
        Area.COIL: ["01", "05", "0F"],
        Area.DISCRETE_INPUT: ["02"],
        Area.INPUT_REGISTER: ["04"],
        Area.HOLDING_REGISTER: ["03", "06", "10"],
    }[place.area]


def _stretches(modbus_map: ModbusMap) -> list[dict[str, Any]]:
    return [
        _described(
            Element(each.symbol, each.first),
            Place(each.area, each.offset, each.count * each.width),
            last=Element(each.symbol, each.first + each.count - 1),
        )
        for each in modbus_map.stretches
    ]


def _whole(modbus_map: ModbusMap) -> Iterator[tuple[str, str]]:
    for entry in _stretches(modbus_map):
        yield f"{entry['element']}-{entry['last_element']}", f"{entry['reference']}-{entry['last_reference']}"


def _references(entry: dict[str, Any]) -> str:
    short = f" ({entry['reference5']})" if entry["reference5"] else ""
    several = f" to {entry['last_reference']}" if entry["count"] > 1 else ""
    half = f", {entry['half']}" if entry["half"] else ""
    return f"{entry['reference']}{several}{short}{half}, {entry['area']}, offset {entry['offset']}"


def _document(modbus_map: ModbusMap, entries: list[dict[str, Any]]) -> dict[str, Any]:
    return {"schema": "fatektool.modbus-map/1", "map": modbus_map.name, "entries": entries}
