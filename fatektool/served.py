"""Simulated PLCs on a TCP port, in a thread of this process: for tests of your own program."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fatektool.protocols import DEFAULT

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from fatektool.simulator.plc import SimulatedPlc


@dataclass(frozen=True, slots=True)
class SimulatedTarget:
    """Simulated PLCs with an address.

    Attributes:
        target: their address: ``tcp://127.0.0.1:41234``.
        host: the host in it.
        port: the port in it.
        plcs: the PLCs by station: ``plcs[1].read_words("R", 0, 1)``, ``plcs[1].running``.
    """

    target: str
    host: str
    port: int
    plcs: Mapping[int, SimulatedPlc]


@contextmanager
def simulate(
    stations: Iterable[int] = (1,),
    model: str | None = None,
    *,
    protocol: str = DEFAULT,
    faults: Iterable[str] = (),
    seed: int = 0,
    baud: float | None = None,
) -> Iterator[SimulatedTarget]:
    """Serve simulated PLCs on a free TCP port for as long as the ``with`` statement lasts.

    Args:
        stations: 1 to 254, each once.
        model: as of ``fatektool simulate --model``; None for the protocol's usual one.
        protocol: ``facon``, ``mseries``, ``modbus-rtu``, ``modbus-ascii`` or ``modbus-tcp``.
        faults: injected faults, as ``"KIND=P"``: ``"drop=0.1"`` loses every tenth answer.
        seed: of the faults: the same seed, the same faults.
        baud: bits per second of the line; None for no wire time.

    Raises:
        UsageError: an argument has a wrong value.
        LineError: no TCP port is free.
    """
    from fatektool.simulator.build import build_simulation
    from fatektool.simulator.listen.servers import Server, running

    simulation = build_simulation(stations, model, protocol=protocol, faults=faults, seed=seed, baud=baud)
    server = Server(simulation)
    target = server.open_tcp().address
    host, _, port = target.removeprefix("tcp://").rpartition(":")
    with running(server):
        yield SimulatedTarget(target, host, int(port), simulation.plcs)
