"""Simulated PLCs for tests: a client on an in-memory line, on a clock of its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fatektool.client import Plc
from fatektool.exchange.link import Link
from fatektool.protocol.registry import CODECS
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport

if TYPE_CHECKING:
    from fatektool.simulator.build import Simulation
    from fatektool.simulator.plc import SimulatedPlc


@dataclass(frozen=True)
class Simulated:
    """A client and the PLC it talks to."""

    plc: Plc
    simulation: Simulation

    @property
    def device(self) -> SimulatedPlc:
        return self.simulation.plcs[1]


def simulated(
    *, protocol: str = "facon", retries: int = 3, timeout_s: float = 0.5, **options: Any
) -> Simulated:
    """A PLC of ``build_simulation(**options)`` and a client for its station 1."""
    simulation = build_simulation(protocol=protocol, **options)
    line = LineSettings()
    transport = MemoryTransport(simulation.line())
    link = Link(transport, CODECS[protocol], 1, line, timeout_s=timeout_s, retries=retries)
    return Simulated(Plc(link, "sim:"), simulation)
