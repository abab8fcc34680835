"""A PLC on the bench: simulator, line in memory, and a tap on the wire that counts, looks and forges."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fatektool.client import Plc
from fatektool.exchange.link import Link
from fatektool.protocol.fatek.facon.codec import FACON
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.program.image import Program
    from fatektool.simulator.build import Simulation
    from fatektool.simulator.plc import SimulatedPlc

STATION = slice(1, 3)
COMMAND = slice(3, 5)
PAGE = slice(5, 9)

READ_PAGE, WRITE_PAGE, DETAILED_STATUS, RUN_STOP = "4F", "50", "53", "41"


def framed(body: bytes) -> bytes:
    """A frame of station, command and data: built here, not by the code under test."""
    start = b"\x02" + body
    return start + b"%02X\x03" % (sum(start) % 256)


class Seen(NamedTuple):
    """A request on the wire: the number-th of its command, counted from 1."""

    command: str
    number: int
    page: int | None
    passes: int  # detailed statuses asked for so far: each pass begins with one


class Tap:
    """Stands between client and simulator.

    ``before`` is called before a request is passed on, ``after`` when it was executed, and ``forge`` may
    change what comes back.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._line = simulation.line()
        self.count: dict[str, int] = {}
        self.pages_written: list[int] = []
        self.before: Callable[[Seen], object] = lambda _seen: None
        self.after: Callable[[Seen], object] = lambda _seen: None
        self.forge: Callable[[Seen, bytes], bytes] = lambda _seen, answer: answer

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        command = data[COMMAND].decode()
        number = self.count[command] = self.count.get(command, 0) + 1
        page = int(data[PAGE], 16) if command in {READ_PAGE, WRITE_PAGE} else None
        seen = Seen(command, number, page, self.count.get(DETAILED_STATUS, 0))
        self.before(seen)
        if page is not None and command == WRITE_PAGE:
            self.pages_written.append(page)
        pieces = self._line.receive(data, now)
        self.after(seen)
        return [(due, self.forge(seen, piece)) for due, piece in pieces]


class Bench:
    """One simulated PLC with one client."""

    def __init__(
        self,
        program: Program,
        *,
        faults: tuple[str, ...] = (),
        seed: int = 0,
        program_commands: bool = True,
        retries: int = 3,
    ) -> None:
        self.simulation = build_simulation(
            ladder_words=program.ladder_words,
            program=program.pages,
            faults=faults,
            seed=seed,
            program_commands=program_commands,
        )
        self.device: SimulatedPlc = self.simulation.plcs[1]
        self.retries = retries
        self.tap = Tap(self.simulation)
        self.plc = self.client()

    def client(self) -> Plc:
        """Another client, as after a restart, on a line of its own."""
        self.tap = Tap(self.simulation)
        transport = MemoryTransport(self.tap, "bench")
        nonces = (b"%08X" % number for number in range(1 << 32))
        link = Link(transport, FACON, 1, LineSettings(), retries=self.retries, nonces=lambda: next(nonces))
        self.plc = Plc(link, "bench")
        return self.plc

    @property
    def pages(self) -> tuple[bytes, ...]:
        """What the PLC really holds."""
        return tuple(self.device.pages)
