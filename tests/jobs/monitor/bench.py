"""A monitor over a line in memory, with all that crosses it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fatektool.jobs.monitor.live import LiveNetwork, Monitor
from fatektool.project.program_file import ProgramFile
from fatektool.simulator.build import build_simulation
from tests.cli.programs.monitor.plant import IMAGE
from tests.program.samples import backup
from tests.project.files import program_of
from tests.rigs import client_on

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from fatektool.program.image import Program
    from fatektool.simulator.line import SimulatedLine
    from fatektool.simulator.plc import SimulatedPlc
    from fatektool.transport.memory import MemoryTransport

SILENCE: list[tuple[float, bytes]] = []


class Wire:
    """A line whose requests are kept.

    Attributes:
        asked: the requests.
        answered: how many bytes came back.
        silent_to: requests that get no answer.
    """

    def __init__(self, line: SimulatedLine) -> None:
        self._line = line
        self.asked: list[bytes] = []
        self.answered = 0
        self.silent_to: Callable[[bytes], bool] = lambda _: False

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        self.asked.append(data)
        if self.silent_to(data):
            return SILENCE
        pieces = self._line.receive(data, now)
        self.answered += sum(len(piece) for _, piece in pieces)
        return pieces

    def bodies(self) -> list[bytes]:
        """Command and data of all requests since the last call."""
        found = [frame[3:-3] for frame in self.asked]
        self.asked, self.answered = [], 0
        return found


class Monitored:
    """The PLC of ``plant``, in RUN, with a monitor of some of its networks.

    Args:
        shown: the numbers of the networks; None for all.
        program: what the PLC has; that of the file by default.
        protocol: of the line.
        retries: further tries of one exchange.
        options: of ``build_simulation``.
    """

    def __init__(
        self,
        shown: Iterable[int] | None = None,
        *,
        program: Program | None = None,
        protocol: str = "facon",
        retries: int = 3,
        **options: Any,
    ) -> None:
        there = program_of(IMAGE) if program is None else program
        self.simulation = build_simulation(
            protocol=protocol, ladder_words=there.ladder_words, program=there.pages, **options
        )
        self.wire = Wire(self.simulation.line())
        self.plc = client_on(self.wire, protocol, retries=retries)
        self.device.running = True
        self.file = ProgramFile("press.json", program_of(IMAGE), backup=backup(program_of(IMAGE)))
        numbers = range(len(self.file.networks)) if shown is None else shown
        self.networks = [LiveNetwork(self.file.networks[number]) for number in numbers]
        self.monitor = Monitor(self.plc, self.file, self.networks)

    @property
    def device(self) -> SimulatedPlc:
        return self.simulation.plcs[1]

    @property
    def transport(self) -> MemoryTransport:
        return self.plc.link.transport  # type: ignore[return-value]  # client_on made it
