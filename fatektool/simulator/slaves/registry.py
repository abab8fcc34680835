"""The protocols that a simulator speaks, by the names that a user knows.

To add one, write a slave (see ``slave``) and give it a line here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from fatektool.simulator.line import BITS_PER_CHAR
from fatektool.simulator.models import DEFAULT_MODEL
from fatektool.simulator.slaves.facon.slave import FaconSlave
from fatektool.simulator.slaves.modbus.frame import AsciiFraming, RtuFraming, TcpFraming
from fatektool.simulator.slaves.modbus.slave import ModbusSlave
from fatektool.simulator.slaves.mseries.slave import MSeriesSlave

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fatektool.simulator.plc import SimulatedPlc
    from fatektool.simulator.slaves.base import Slave
    from fatektool.simulator.slaves.modbus.frame import Framing


class MakeSlave(Protocol):
    """Makes a new slave for a line, over the PLCs that all lines share."""

    def __call__(self, plcs: Mapping[int, SimulatedPlc], *, error_character: bool = True) -> Slave:
        """See ``FaconSlave`` for the error character; other protocols leave no doubt about theirs."""


class Spoken(NamedTuple):
    """One protocol.

    Attributes:
        make_slave: a new slave.
        model: a name of ``MODELS``: what speaks it, if nothing else is said.
        bits_per_char: of the format of its lines, if nothing else is said: 10 for 7E1, 11 for 8E1.
    """

    make_slave: MakeSlave
    model: str
    bits_per_char: float


def _mseries(plcs: Mapping[int, SimulatedPlc], *, error_character: bool = True) -> MSeriesSlave:
    del error_character
    return MSeriesSlave(plcs)


def _modbus(make_framing: Callable[[], Framing]) -> MakeSlave:
    def make(plcs: Mapping[int, SimulatedPlc], *, error_character: bool = True) -> ModbusSlave:
        del error_character
        return ModbusSlave(plcs, make_framing())

    return make


SLAVES: dict[str, Spoken] = {
    "facon": Spoken(FaconSlave, DEFAULT_MODEL, BITS_PER_CHAR),
    "mseries": Spoken(_mseries, "m-series", 11),
    "modbus-rtu": Spoken(_modbus(RtuFraming), "fbs-20mc", 11),
    "modbus-ascii": Spoken(_modbus(AsciiFraming), "fbs-20mc", 10),
    "modbus-tcp": Spoken(_modbus(TcpFraming), "fbs-20mc", 11),
}
DEFAULT_PROTOCOL = "facon"
