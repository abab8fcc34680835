"""Simulated PLCs on a line in memory, each with a client: the one place in which the tests build such a pair.

- ``simulated``: any PLC of ``build_simulation``, any protocol.
- ``Bench``: one FACON PLC with a program, and a tap on the wire that counts, looks and forges.
- ``Rig``: a PLC behind a bad line, everything fixed by a seed: faults, nonces, memory, clock.

PLCs in files, processes and on sockets are in ``tests/plant.py`` and ``tests/cli/running.py``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from fatektool.address import default_format
from fatektool.client import Plc
from fatektool.exchange.link import Link
from fatektool.protocol.elements import Element
from fatektool.protocol.registry import codec_named
from fatektool.simulator.build import build_simulation
from fatektool.transport.base import LineSettings
from fatektool.transport.memory import MemoryTransport
from tests.program.samples import changed, program

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from fatektool.program.image import Program
    from fatektool.simulator.build import Simulation
    from fatektool.simulator.plc import SimulatedPlc
    from fatektool.transport.memory import Peer


def client_on(
    line: Peer, protocol: str = "facon", *, target: str = "sim:", retries: int = 3, timeout_s: float = 0.5
) -> Plc:
    """A client for station 1 on a line in memory, on the line's clock; its nonces are numbers."""
    codec = codec_named(protocol)
    nonces = (b"%08X" % number for number in range(1 << 32))
    link = Link(
        MemoryTransport(line, target),
        codec,
        1,
        LineSettings(format=default_format(codec)),
        timeout_s=timeout_s,
        retries=retries,
        nonces=lambda: next(nonces),
    )
    return Plc(link, target)


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
    plc = client_on(simulation.line(), protocol, retries=retries, timeout_s=timeout_s)
    return Simulated(plc, simulation)


# --- a tap on the wire ---------------------------------------------------------------------------------

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
        self.last = b""
        self.before: Callable[[Seen], object] = lambda _seen: None
        self.after: Callable[[Seen], object] = lambda _seen: None
        self.forge: Callable[[Seen, bytes], bytes] = lambda _seen, answer: answer

    def receive(self, data: bytes, now: float) -> list[tuple[float, bytes]]:
        command = data[COMMAND].decode()
        self.last = bytes(data)
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
        self.plc = client_on(self.tap, target="bench", retries=self.retries)
        return self.plc

    @property
    def pages(self) -> tuple[bytes, ...]:
        """What the PLC really holds."""
        return tuple(self.device.pages)


# --- a bad line ----------------------------------------------------------------------------------------

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
        self.plc = client_on(self.simulation.line(), protocol, target="rig", retries=retries)
        self.link = self.plc.link
        self.codec = self.link.codec
        self.transport = self.link.transport
        self.line = LineSettings(format=default_format(self.codec))

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
        return self.link.transport.clock()

    def most_s(self, requests: int) -> float:
        """The longest that so many requests can take, whatever the line does.

        Each is asked at most so often, each time behind a fence that is put up as often, and behind each of
        these a question that tells an echo; all of it once more for what must be read again.
        """
        link = self.link
        one_try_s = 2 * LONGEST_FRAME * link.byte_time_s + _MOST_PATIENCE * link.timeout_s
        tries = link.retries + 1
        return 2 * requests * tries * (1 + 2 * tries) * one_try_s
