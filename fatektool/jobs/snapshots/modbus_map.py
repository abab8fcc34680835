"""A Modbus map as a user names it: the standard one, one in words, or a snapshot of its registers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.errors import UsageError

if TYPE_CHECKING:
    from fatektool.address import PlcAddress
    from fatektool.protocol.modbus.map import ModbusMap


def with_entry_map(address: PlcAddress, named: str | None) -> PlcAddress:
    """An address with the map that is named for it, where its protocol is Modbus.

    Args:
        address: of a PLC.
        named: ``standard``, ``custom``, a map, or a file; None for none.

    Raises:
        UsageError: it is no map, or no such file.
        DataError: the file is no snapshot, or does not hold the thirteen registers.
    """
    if named is None or not address.protocol.startswith("modbus"):
        return address
    return with_named_map(address, named)


def with_named_map(address: PlcAddress, named: str) -> PlcAddress:
    """The same whatever its protocol is, as a user named the map for this PLC; errors are the same."""
    return address.changed(modbus_map="custom" if named == "custom" else read_map(named))


def read_map(text: str) -> ModbusMap:
    """A map as ``--modbus-map`` names it, but for 'custom', which takes a PLC.

    Raises:
        UsageError: it is none, or no such file.
        DataError: the file is no snapshot, or does not hold the thirteen registers.
    """
    from fatektool.protocol.modbus.map import (
        FIRST_REGISTER,
        REGISTER_COUNT,
        STANDARD,
        map_of_registers,
        parse_map,
    )

    if text == "standard":
        return STANDARD
    if "=" in text:
        return parse_map(text)
    if text == "custom":
        raise UsageError(
            "--modbus-map custom asks the PLC, and this command has none", hint="give the map, or a snapshot"
        )
    from pathlib import Path

    from fatektool.jobs.snapshots.snapshot import load_snapshot, raw_of

    held = {element: raw for element, raw in raw_of(load_snapshot(Path(text))).values() if raw is not None}
    words = [
        raw
        for address in range(FIRST_REGISTER, FIRST_REGISTER + REGISTER_COUNT)
        for element, raw in held.items()
        if (element.symbol, element.address) == ("R", address)
    ]
    return map_of_registers(words)
