"""A Modbus protocol over another map than the standard one, such as the PLC's own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.errors import PlcError, PlcRefused, UsageError

if TYPE_CHECKING:
    from fatektool.exchange.link import Link
    from fatektool.protocol.codec import Codec
    from fatektool.protocol.modbus.map import ModbusMap


def mapped(codec: Codec, modbus_map: ModbusMap | None) -> Codec:
    """The same protocol with another Modbus map; None for the standard one.

    Raises:
        UsageError: it has none.
    """
    from fatektool.protocol.modbus.codec import ModbusCodec
    from fatektool.protocol.modbus.map import STANDARD

    if not isinstance(codec, ModbusCodec):
        raise UsageError(f"a Modbus map is for a Modbus protocol, not for {codec.name}")
    return codec.mapped(STANDARD if modbus_map is None else modbus_map)


def map_in_plc(link: Link) -> ModbusMap:
    """The map that the PLC's registers R3968 to R3980 describe, read over Modbus.

    With R3968 = A55AH the standard references are not valid, that of R3968 included, unless the PLC's own map
    has the same ones. So what is read there is used only if it describes a map that has R3968 at that
    reference.

    Raises:
        PlcError: they cannot be read, or the PLC uses another map.
        LineError: no answer.
    """
    from fatektool.protocol.commands import ReadRegisters
    from fatektool.protocol.elements import Element
    from fatektool.protocol.modbus.map import (
        FIRST_REGISTER,
        REGISTER_COUNT,
        STANDARD_NAME,
        map_of_registers,
    )

    first = Element("R", FIRST_REGISTER)
    hint = "'fatektool snapshot R3968-R3980 -o map.json' on a FACON port, then --modbus-map map.json"
    try:
        words: tuple[int, ...] = link.ask(ReadRegisters(first, REGISTER_COUNT))
        found = map_of_registers(words)
    except PlcRefused as error:
        raise PlcError(f"--modbus-map custom: R3968 cannot be read: {error.message}", hint=hint) from error
    try:
        here = found.place(first, REGISTER_COUNT).offset == FIRST_REGISTER
    except UsageError:
        here = False
    if found.name == STANDARD_NAME or not here:
        raise PlcError(
            "--modbus-map custom: the PLC shows no map of its own at the reference of R3968",
            hint=f"omit the option; if the PLC has a map of its own, {hint}",
        )
    return found
