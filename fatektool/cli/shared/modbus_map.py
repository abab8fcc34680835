"""``--modbus-map``: which elements have which Modbus references, for the commands that name elements."""

from __future__ import annotations

from functools import wraps
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import click

from fatektool.cli.shared.options import ConnectionOption
from fatektool.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.cli.shared.connection import Connection
    from fatektool.protocol.modbus.map import ModbusMap

F = TypeVar("F", bound="Callable[..., Any]")

_METAVAR = "standard|custom|MAP|FILE"
_FORMS = "MAP is M1000-M1099=000001,R2000-R2199=400101; FILE is a snapshot with R3968-R3980."


def modbus_map_option(function: F) -> F:
    """``--modbus-map``, beside the connection's options; it becomes part of ``connection``."""

    @click.option(
        "--modbus-map",
        cls=ConnectionOption,
        metavar=_METAVAR,
        help=f"For a PLC with R3968 = A55AH; 'custom' asks it for R3968-R3980. {_FORMS}",
    )
    @wraps(function)
    def with_map(*args: Any, connection: Connection, modbus_map: str | None, **rest: Any) -> Any:
        if modbus_map is not None:
            chosen: ModbusMap | Literal["custom"]
            chosen = "custom" if modbus_map == "custom" else read_map(modbus_map)
            connection = connection._replace(address=connection.address.changed(modbus_map=chosen))
        return function(*args, connection=connection, **rest)

    return with_map  # type: ignore[return-value]  # click's decorators hand back what they get


def map_alone_option(function: F) -> F:
    """``--modbus-map`` for a command without a PLC; the command gets ``modbus_map``."""

    @click.option("--modbus-map", metavar="standard|MAP|FILE", help=_FORMS)
    @wraps(function)
    def with_map(*args: Any, modbus_map: str | None, **rest: Any) -> Any:
        chosen = read_map("standard" if modbus_map is None else modbus_map)
        return function(*args, modbus_map=chosen, **rest)

    return with_map  # type: ignore[return-value]  # as above


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
