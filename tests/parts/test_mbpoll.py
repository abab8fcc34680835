"""mbpoll, another's Modbus client, reads and writes the simulated PLC: over TCP, and RTU on a pty."""

from __future__ import annotations

import re
import subprocess
from typing import TYPE_CHECKING

import pytest

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.pty import PTY_SUPPORTED
from fatektool.simulator.listen.servers import Server, running
from tests.parts.programs import command, needs

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from fatektool.simulator.plc import SimulatedPlc

STATION = 7
BAUD = "9600"


class Mbpoll:
    """mbpoll on one line, to one station; references count from 0, as in the PLC's map."""

    def __init__(self, *line: str) -> None:
        self._line = line

    def __call__(self, kind: str, first: int, *more: object, station: int = STATION) -> str:
        """Run it once; ``more`` is ``-c`` and a count to read, or values to write."""
        words = ["-0", "-1", "-a", str(station), "-o", "10", "-t", kind, "-r", str(first)]
        options = [str(word) for word in more] if more[:1] == ("-c",) else []
        values = [] if options else [str(word) for word in more]
        done = subprocess.run(
            command("mbpoll", *words, *options, *self._line[:-1], self._line[-1], *values),
            capture_output=True,
            text=True,
            check=False,
        )
        said = done.stdout + done.stderr
        assert (done.returncode == 0) == ("failed" not in said), said
        return said

    def read(self, kind: str, first: int, count: int) -> list[float]:
        """So many values."""
        said = self(kind, first, "-c", count)
        assert "failed" not in said, said
        return [float(text) for text in re.findall(r"^\[\d+\]: \t([-.\dE+]+)", said, re.MULTILINE)]


@pytest.fixture(params=["tcp", "rtu"])
def plc_and_client(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[tuple[SimulatedPlc, Mbpoll]]:
    if request.param == "rtu" and not PTY_SUPPORTED:
        pytest.skip("no pseudo terminals here")
    simulation = build_simulation([STATION], protocol=f"modbus-{request.param}")
    server = Server(simulation)
    if request.param == "tcp":
        host, _, port = server.open_tcp().address.partition("://")[2].partition(":")
        client = Mbpoll("-m", "tcp", "-p", port, host)
    else:
        device = server.open_pty(tmp_path / "plc").address
        client = Mbpoll("-m", "rtu", "-b", BAUD, "-P", "none", device)
    with running(server):
        yield simulation.plcs[STATION], client


@needs("mbpoll")
def test_mbpoll_reads(plc_and_client: tuple[SimulatedPlc, Mbpoll]) -> None:
    plc, mbpoll = plc_and_client
    plc.write_words("R", 100, [11, 0xFFFF, 22])
    plc.write_words("R", 200, [0x0000, 0x4148])  # 12.5, low word first
    plc.write_words("R", 202, [0xFFFE, 0xFFFF])  # -2, low word first
    plc.write_discretes("M", 5, b"\1")
    assert mbpoll.read("4", 100, 3) == [11, 65535, 22]
    assert mbpoll.read("4:float", 200, 1) == [12.5]
    assert mbpoll.read("4:int", 202, 1) == [-2]
    assert mbpoll.read("0", 2000, 10) == [0] * 5 + [1] + [0] * 4
    assert len(mbpoll.read("4", 0, 125)) == 125


@needs("mbpoll")
def test_mbpoll_writes(plc_and_client: tuple[SimulatedPlc, Mbpoll]) -> None:
    plc, mbpoll = plc_and_client
    assert "Written 1 references" in mbpoll("4", 0, 4261)
    assert "Written 3 references" in mbpoll("4", 10, 1, 2, 65535)
    assert "Written 1 references" in mbpoll("4:float", 20, 12.5)
    assert "Written 1 references" in mbpoll("0", 3, 1)
    assert "Written 3 references" in mbpoll("0", 2000, 1, 0, 1)
    assert plc.read_words("R", 0, 1) == [4261]
    assert plc.read_words("R", 10, 3) == [1, 2, 65535]
    assert plc.read_words("R", 20, 2) == [0x0000, 0x4148]
    assert bytes(plc.read_discretes("Y", 0, 5)) == b"\0\0\0\1\0"
    assert bytes(plc.read_discretes("M", 0, 3)) == b"\1\0\1"


@needs("mbpoll")
def test_mbpoll_is_refused_in_words_that_it_knows(plc_and_client: tuple[SimulatedPlc, Mbpoll]) -> None:
    _, mbpoll = plc_and_client
    assert "Illegal data address" in mbpoll("4", 4168, "-c", 1)
    assert "Illegal data address" in mbpoll("3", 0, "-c", 1)  # input registers: none in the standard map
