from __future__ import annotations

import re
from contextlib import ExitStack
from typing import TYPE_CHECKING, NamedTuple

import pytest

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running
from tests.examples.container import Ended, run_in_container, why_no_container
from tests.program.samples import program
from tests.root import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.simulator.plc import SimulatedPlc

EXAMPLES = ROOT / "examples"
SHELL = re.compile(r"```sh\n(.*?)```", re.DOTALL)
NODE_EXPORTER = "mkdir -p /var/lib/prometheus/node-exporter\n"  # as Debian's package makes it


class Blocks(NamedTuple):
    """The commands of examples/README.md, in the order in which they stand there."""

    program: str
    user_by_systemd: str
    user_by_hand: str
    inventory: str
    cron: str
    systemd: str


@pytest.fixture(scope="session")
def blocks() -> Blocks:
    text = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    return Blocks(*SHELL.findall(text))


class Gateway:
    """A gateway computer: a container, a PLC at ``/dev/ttyUSB0`` and one behind TCP."""

    def __init__(self, folder: Path, target: str, serial_port: str, tcp: SimulatedPlc) -> None:
        self._folder = folder
        self._serial_port = serial_port
        self.target = target
        self.tcp_plc = tcp

    def run(self, *scripts: str, **programs: str) -> Ended:
        """Run scripts, as one, in this project's folder; the first command that fails ends them."""
        script = "\n".join(("set -e -o pipefail", "cd /opt/project", *scripts))
        return run_in_container(self._folder, script, programs=programs, serial_port=self._serial_port)

    def inventory(self, *more: str) -> str:
        """A command that writes the inventory: press behind TCP, oven at the serial port, and more."""
        tables = (
            "[defaults]\ntags = ['night']\nexpect = 'any'\n",
            f"[plc.press]\ntarget = '{self.target}'\n",
            "[plc.oven]\ntarget = '/dev/ttyUSB0'\n",
            *more,
        )
        return f"cat > /etc/fatektool/fatek.toml <<'END'\n{''.join(tables)}END\n"


@pytest.fixture
def gateway(tmp_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Gateway]:
    """A gateway computer; skips where no container can be run."""
    reason = why_no_container(tmp_path_factory.getbasetemp() / "container")
    if reason is not None:
        pytest.skip(reason)
    with ExitStack() as stack:
        simulations = [
            build_simulation(ladder_words=400, program=program(400, seed=seed).pages) for seed in (1, 2)
        ]
        servers = [Server(simulation) for simulation in simulations]
        target = servers[0].open_tcp().address
        serial_port = servers[1].open_pty(tmp_path / "ttyUSB0").address
        for server in servers:
            stack.enter_context(running(server))
        yield Gateway(tmp_path / "gateway", target, serial_port, simulations[0].plcs[1])
