"""Gateways with PLCs behind them, and an inventory of them all."""

from __future__ import annotations

import json
import socket
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running
from tests.cli.running import NEW, OLD

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.simulator.build import Simulation


class Hall:
    """A hall of PLCs: ``press`` alone, ``oven`` and ``pump`` behind one gateway, each with its own memory."""

    def __init__(self, press: Simulation, oven: Simulation, targets: tuple[str, str]) -> None:
        self.press, self.oven, self.pump = press.plcs[1], oven.plcs[1], oven.plcs[2]
        self.targets = targets
        self.write()

    def write(self, **more: str) -> None:
        """Write ``fatek.toml``; ``more`` are lines for a PLC, or whole tables of others."""
        one, other = self.targets
        tables = {
            "press": f'target = "{one}"\ntags = ["night"]\n',
            "oven": f'target = "{other}"\n',
            "pump": f'target = "{other}"\nstation = 2\n',
        }
        for name, lines in more.items():
            tables[name] = tables.get(name, "") + lines
        text = '[defaults]\ntimeout_s = 3.0\nretries = 0\nexpect = "any"\n'
        text += "".join(f"\n[plc.{name}]\n{lines}" for name, lines in tables.items())
        Path("fatek.toml").write_text(text, encoding="utf-8")


@contextmanager
def hall() -> Iterator[Hall]:
    """The hall, served by two threads of this process."""
    with ExitStack() as stack:
        simulations, targets = [], []
        for stations, image in (([1], OLD), ([1, 2], NEW)):
            simulation = build_simulation(stations, ladder_words=400, program=image.pages)
            server = Server(simulation)
            targets.append(server.open_tcp().address)
            stack.enter_context(running(server))
            simulations.append(simulation)
        yield Hall(simulations[0], simulations[1], (targets[0], targets[1]))


@contextmanager
def deaf_door() -> Iterator[str]:
    """A door that takes connections and never answers."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        yield f"tcp://127.0.0.1:{listening.getsockname()[1]}"


def plcs_of(document: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """A fleet document's PLCs by name."""
    return {plc["name"]: plc for plc in document["plcs"]}


def saved(name: str) -> dict[str, Any]:
    """A JSON file."""
    found: dict[str, Any] = json.loads(Path(name).read_text(encoding="utf-8"))
    return found
