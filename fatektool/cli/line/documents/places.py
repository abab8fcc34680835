"""The JSON documents of ``ports`` and ``modbus map``."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.jobs.modbus_map import MapEntry
    from fatektool.jobs.serial_ports import SerialPort
    from fatektool.protocol.modbus.map import ModbusMap


def ports_document(ports: Iterable[SerialPort]) -> dict[str, Any]:
    """``fatektool.ports/1``."""
    return {"schema": "fatektool.ports/1", "ports": [asdict(port) for port in ports]}


def map_document(modbus_map: ModbusMap, entries: Iterable[MapEntry]) -> dict[str, Any]:
    """``fatektool.modbus-map/1``: some entries of a map, or all."""
    return {
        "schema": "fatektool.modbus-map/1",
        "map": modbus_map.name,
        "entries": [
            {
                "element": str(each.element),
                "last_element": None if each.last_element is None else str(each.last_element),
                "half": each.half,
                "area": each.place.area.words,
                "reference": str(each.reference),
                "reference5": each.reference.five_digits,
                "last_reference": str(each.last_reference),
                "offset": each.place.offset,
                "count": each.place.count,
                "functions": list(each.functions),
            }
            for each in entries
        ],
    }
