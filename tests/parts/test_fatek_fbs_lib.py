"""A stranger's library for these PLCs, fatek-fbs-lib, at the simulator: it always asks unit 0.

It needs a pymodbus older than this project's, so it is installed into an environment of its own, which takes
as long as that takes.
"""

from __future__ import annotations

import json
import subprocess
import sys
import venv
from typing import TYPE_CHECKING

import pytest

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running

if TYPE_CHECKING:
    from pathlib import Path

PACKAGES = ("fatek-fbs-lib==0.1.10", "pymodbus==3.6.9")
CLIENT = """
import json, sys
from fatek import Fatek

plc = Fatek("127.0.0.1", port=int(sys.argv[1]))
plc.write("R100", 4261)
plc.write("D7", 99)
plc.write("M5", True)
plc.write("Y3", True)
print(json.dumps({
    "R": plc.bulk_read("R100", 3),
    "D7": plc.read("D7"),
    "M": plc.bulk_read("M4", 4)[:4],
    "Y3": plc.read("Y3"),
    "X0": plc.read("X0"),
    "RC200": plc.bulk_read("C200", 2, current_value=True),
}))
"""


@pytest.fixture(scope="module")
def python(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An interpreter that has the library."""
    folder = tmp_path_factory.mktemp("foreign")
    venv.create(folder, with_pip=True)
    found = folder / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
    words = [str(found), "-m", "pip", "install", "-q", "--disable-pip-version-check", *PACKAGES]
    done = subprocess.run(words, capture_output=True, text=True, check=False)  # pip
    if done.returncode:
        pytest.skip(f"{PACKAGES[0]} cannot be installed here: {done.stderr.strip()[-200:]}")
    return found


@pytest.mark.slow
def test_it_reads_and_writes_the_simulator(python: Path) -> None:
    simulation = build_simulation([3], protocol="modbus-tcp")
    device = simulation.plcs[3]
    device.write_words("R", 101, [5, 6])
    device.write_long_counters(0, [70000 & 0xFFFF, 70000 >> 16])
    server = Server(simulation)
    port = server.open_tcp().address.rpartition(":")[2]
    with running(server):
        done = subprocess.run(  # the text above
            [str(python), "-c", CLIENT, port], capture_output=True, text=True, check=False
        )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == {
        "R": [4261, 5, 6],
        "D7": 99,
        "M": [False, True, False, False],
        "Y3": True,
        "X0": False,
        "RC200": [4464, 1],
    }
    assert device.read_words("D", 7, 1) == [99]
    assert device.read_discretes("Y", 3, 1) == b"\1"
