"""A PLC behind a bad line and a client with everything fixed by a seed: faults, nonces, memory, clock."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fatektool.address import default_format
from fatektool.client import Plc
from fatektool.exchange.link import Link
from fatektool.protocol.elements import Element
from fatektool.protocol.registry import codec_named
from fatektool.simulator.build import Simulation, build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from tests.program.samples import changed, program

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fatektool.program.image import Program
    from fatektool.simulator.plc import SimulatedPlc

WORDS = 256
OLD, NEW = program(WORDS, seed=1), program(WORDS, seed=2)
NEAR = changed(OLD, 2)
PAGES = len(OLD.pages)
LONGEST_FRAME = 512
SLOW_S = 0.8
_MOST_PATIENCE = 4

REGISTERS = {Element("R", place): 0x1000 + 257 * place for place in range(100)}
DISCRETES = {Element("M", place): place % 3 == 0 for place in range(40)}


def fill(device: SimulatedPlc) -> None:
    """Values of which no two neighbours are alike."""
    device.running = False
    device.battery_low = True
    device.write_words("R", 0, list(REGISTERS.values()))
    for element, value in DISCRETES.items():
        device.write_discretes("M", element.address, bytes([value]))


class Rig:
    """A simulated PLC of five pages, station 1, on a line in memory.

    Args:
        protocol: facon or mseries.
        faults: ``KIND=P`` strings.
        seed: of the faults.
        image: the program in it.
        retries: further tries of one exchange.
        baud: paces the line; None for a wire that takes no time.
        stations: whom the line has.
    """

    def __init__(
        self,
        protocol: str = "facon",
        faults: Iterable[str] = (),
        seed: int = 0,
        *,
        image: Program = OLD,
        retries: int = 3,
        baud: float | None = None,
        stations: Iterable[int] = (1,),
    ) -> None:
        self.simulation: Simulation = build_simulation(
            stations,
            protocol=protocol,
            ladder_words=image.ladder_words,
            program=image.pages,
            faults=faults,
            seed=seed,
            baud=baud,
            slow_s=SLOW_S,
        )
        for device in self.simulation.plcs.values():
            fill(device)
        self.transport = MemoryTransport(self.simulation.line(), "rig")
        self.codec = codec_named(protocol)
        self.line = LineSettings(format=default_format(self.codec))
        nonces = (b"%08X" % number for number in range(1 << 32))
        self.link = Link(
            self.transport, self.codec, 1, self.line, retries=retries, nonces=lambda: next(nonces)
        )
        self.plc = Plc(self.link, "rig")

    @property
    def device(self) -> SimulatedPlc:
        return self.simulation.plcs[1]

    @property
    def pages(self) -> tuple[bytes, ...]:
        return tuple(self.device.pages)

    @property
    def modbus(self) -> bool:
        return self.codec.name.startswith("modbus")

    @property
    def now(self) -> float:
        return self.transport.clock()

    def most_s(self, requests: int) -> float:
        """The longest that so many requests can take, whatever the line does.

        Each is asked at most so often, each time behind a fence that is put up as often, and behind each of
        these a question that tells an echo; all of it once more for what must be read again.
        """
        link = self.link
        one_try_s = 2 * LONGEST_FRAME * link.byte_time_s + _MOST_PATIENCE * link.timeout_s
        tries = link.retries + 1
        return 2 * requests * tries * (1 + 2 * tries) * one_try_s
