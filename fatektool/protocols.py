"""The protocols by name, with the place of each part. There is no other list of them.

To add a protocol: write its codec, its explainer and its simulated slave, and add a row. To add a framing of
Modbus: write one file in ``protocol/modbus/`` and one in ``simulator/slaves/modbus/``, and add a row.

Parts are given as text, ``module:NAME``, for two reasons. A part is loaded when it is needed: a FACON line
does not wait for Modbus. And the client and the simulator both read this table, but neither imports the
other.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Final, NamedTuple, TypeVar, cast

if TYPE_CHECKING:
    from collections.abc import Iterator

P = TypeVar("P")


class Parts(NamedTuple):
    """The parts of one protocol.

    Attributes:
        trace_code: its number in a ``.pcap`` trace; never used again for another protocol.
        codec: a ``fatektool.protocol.codec.Codec``.
        explainer: makes a ``fatektool.protocol.explain.Explainer`` of that codec.
        slave: a ``fatektool.simulator.slaves.base.SlaveType``.
    """

    trace_code: int
    codec: str
    explainer: str
    slave: str


_MODBUS_EXPLAINER: Final = "fatektool.protocol.modbus.explain:ModbusExplainer"

PROTOCOLS: Final[dict[str, Parts]] = {
    "facon": Parts(
        1,
        "fatektool.protocol.fatek.facon.codec:FACON",
        "fatektool.protocol.fatek.facon.explain:FaconExplainer",
        "fatektool.simulator.slaves.facon.slave:FACON",
    ),
    "mseries": Parts(
        2,
        "fatektool.protocol.fatek.mseries.codec:MSERIES",
        "fatektool.protocol.fatek.mseries.explain:MseriesExplainer",
        "fatektool.simulator.slaves.mseries.slave:MSERIES",
    ),
    "modbus-rtu": Parts(
        3,
        "fatektool.protocol.modbus.rtu:RTU",
        _MODBUS_EXPLAINER,
        "fatektool.simulator.slaves.modbus.rtu:RTU",
    ),
    "modbus-ascii": Parts(
        4,
        "fatektool.protocol.modbus.ascii:ASCII",
        _MODBUS_EXPLAINER,
        "fatektool.simulator.slaves.modbus.ascii:ASCII",
    ),
    "modbus-tcp": Parts(
        5,
        "fatektool.protocol.modbus.tcp:TCP",
        _MODBUS_EXPLAINER,
        "fatektool.simulator.slaves.modbus.tcp:TCP",
    ),
}
DEFAULT: Final = "facon"


class Loaded(Mapping[str, P]):
    """One part of every protocol, by the protocol's name, in the order of the table.

    The names are known without the parts: only ``[]`` loads one.

    Args:
        column: ``codec``, ``explainer`` or ``slave``.
    """

    def __init__(self, column: str) -> None:
        self._column = Parts._fields.index(column)

    def __getitem__(self, name: str) -> P:
        module, _, part = str(PROTOCOLS[name][self._column]).partition(":")
        return cast("P", getattr(importlib.import_module(module), part))

    def __contains__(self, name: object) -> bool:
        return name in PROTOCOLS

    def __iter__(self) -> Iterator[str]:
        return iter(PROTOCOLS)

    def __len__(self) -> int:
        return len(PROTOCOLS)
