"""``modbus map``: elements and their Modbus references, both ways; no PLC."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fatektool.cli.line.documents.places import map_document
from fatektool.cli.shared.modbus_map import map_alone_option
from fatektool.cli.shared.options import voice_options
from fatektool.cli.shared.output import Voice, table
from fatektool.jobs.modbus_map import all_entries, find_entry

if TYPE_CHECKING:
    from fatektool.jobs.modbus_map import MapEntry
    from fatektool.protocol.modbus.map import ModbusMap


@click.group("modbus", epilog="Example: fatektool modbus map R100 406012")
def modbus_command() -> None:
    """Elements of a PLC and their Modbus references."""


@modbus_command.command("map", epilog="Example: fatektool modbus map R100 X16 DRC200 406012 00001")
@click.argument("names", nargs=-1, metavar="ELEMENT|REFERENCE…")
@map_alone_option
@voice_options
def map_command(names: tuple[str, ...], voice: Voice, *, modbus_map: ModbusMap) -> None:
    """Show the Modbus reference of an element, or the element of a reference.

    References have five digits or six: 46012 is 406012. Without a name the whole map is shown.
    """
    if names:
        found = [find_entry(name, modbus_map) for name in names]
        rows = [(str(each.element), _references(each)) for each in found]
    else:
        found = all_entries(modbus_map)
        rows = [
            (f"{each.element}-{each.last_element}", f"{each.reference}-{each.last_reference}")
            for each in found
        ]
    voice.show(map_document(modbus_map, found), table(rows))


def _references(entry: MapEntry) -> str:
    place, short = entry.place, entry.reference.five_digits
    digits = f" ({short})" if short else ""
    several = f" to {entry.last_reference}" if place.count > 1 else ""
    half = f", {entry.half}" if entry.half else ""
    return f"{entry.reference}{several}{digits}{half}, {place.area.words}, offset {place.offset}"
