"""Simulated PLCs with random contents everywhere, and what they hold."""

from __future__ import annotations

from dataclasses import replace
from random import Random
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.program.data.uses import SYMBOLS, Use, use_of
from fatektool.simulator.build import build_simulation
from fatektool.simulator.models import MODELS
from fatektool.simulator.plc import SimulatedPlc
from tests.program.samples import program
from tests.rigs import Tap, client_on

if TYPE_CHECKING:
    from fatektool.client import Plc
    from fatektool.program.image import Program
    from fatektool.simulator.build import Simulation

SMALL: Final = replace(
    MODELS["fbe-28mc"],
    ladder_words=128,
    discrete_inputs=8,
    discrete_outputs=8,
    m_relays=24,
    s_relays=8,
    r_registers=24,
    d_registers=8,
    timers=4,
    counters=4,
    f_registers=5,
)
"""All kinds, so few of each that a fault can be put at every request."""

IMAGE, OTHER_IMAGE = program(128, seed=1), program(128, seed=2)
Held = dict[str, tuple[int, ...]]


class Filled(NamedTuple):
    """A PLC with random contents, its client, and what goes over its wire."""

    plc: Plc
    device: SimulatedPlc
    tap: Tap
    simulation: Simulation


def filled(
    seed: int = 1, image: Program = IMAGE, *, faults: tuple[str, ...] = (), retries: int = 3
) -> Filled:
    """A small PLC; all that it holds depends on the seed."""
    simulation = build_simulation(ladder_words=128, program=image.pages, faults=faults, seed=seed)
    device = SimulatedPlc(1, SMALL, pages=list(image.pages))
    simulation.plcs[1] = device
    fill_at_random(device, seed)
    tap = Tap(simulation)
    return Filled(client_on(tap, target="bench", retries=retries), device, tap, simulation)


def fill_at_random(device: SimulatedPlc, seed: int) -> None:
    """Random values, states and terminals; some discretes disabled."""
    random = Random(seed)  # noqa: S311  # the same each time
    memory = device.memory
    for table in memory.registers.values():
        for at in range(len(table)):
            table[at] = random.randrange(0x10000)
    for symbol, states in memory.status.items():
        for at in range(len(states)):
            states[at] = random.randrange(2)
            memory.disabled[symbol][at] = random.random() < 0.1
    memory.inputs[:] = memory.status["X"]
    memory.revision += 1


ALWAYS: Final = {"R": (12, 3840, 3904, 4128, 4146), "M": (800, 1912)}
"""Filled in any case: one of each use."""


def fill_some(device: SimulatedPlc, seed: int, count: int = 12) -> None:
    """Random values in a few places of each kind, and a disabled discrete of each."""
    random = Random(seed)  # noqa: S311  # the same each time
    memory = device.memory
    for symbol, table in (*memory.registers.items(), *memory.status.items()):
        most = 2 if symbol in memory.status else 0x10000
        places = random.sample(range(len(table)), min(count, len(table)))
        for at in (*places, *ALWAYS.get(symbol, ())):
            table[at] = random.randrange(1, most) if at in ALWAYS.get(symbol, ()) else random.randrange(most)
        if symbol in memory.disabled:
            memory.disabled[symbol][places[0]] = 1
    memory.inputs[:] = memory.status["X"]
    memory.revision += 1


def values_of(device: SimulatedPlc, *uses: Use) -> Held:
    """What a PLC holds of some uses; an element of another one is -1."""
    memory = device.memory
    tables = {**memory.registers, **memory.status}
    return {
        symbol: tuple(
            value if not uses or use_of(symbol, at) in uses else -1 for at, value in enumerate(tables[symbol])
        )
        for symbol in SYMBOLS
    }


def disabled_of(device: SimulatedPlc) -> dict[str, bool]:
    """The disabled discretes, True for on."""
    memory = device.memory
    return {
        f"{symbol}{at}": bool(memory.status[symbol][at])
        for symbol in "XYMSTC"
        for at, flag in enumerate(memory.disabled[symbol])
        if flag
    }
