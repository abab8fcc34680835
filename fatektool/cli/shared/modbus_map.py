"""``--modbus-map``: which elements have which Modbus references, for the commands that name elements."""

from __future__ import annotations

from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fatektool.cli.shared.options import ConnectionOption

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.cli.shared.connection import Connection

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
        of_entry = None if connection.entry is None else connection.entry.modbus_map
        if modbus_map is not None or of_entry is not None:
            from fatektool.jobs.snapshots.modbus_map import with_entry_map, with_named_map

            address = connection.address
            if modbus_map is None:
                address = with_entry_map(address, of_entry)
            else:
                address = with_named_map(address, modbus_map)
            connection = connection._replace(address=address)
        return function(*args, connection=connection, **rest)

    return with_map  # type: ignore[return-value]  # click's decorators hand back what they get


def map_alone_option(function: F) -> F:
    """``--modbus-map`` for a command without a PLC; the command gets ``modbus_map``."""

    @click.option("--modbus-map", metavar="standard|MAP|FILE", help=_FORMS)
    @wraps(function)
    def with_map(*args: Any, modbus_map: str | None, **rest: Any) -> Any:
        from fatektool.jobs.snapshots.modbus_map import read_map

        chosen = read_map("standard" if modbus_map is None else modbus_map)
        return function(*args, modbus_map=chosen, **rest)

    return with_map  # type: ignore[return-value]  # as above
