"""What a command loads before it is done: counted, as a time would depend on the machine.

Each is run in a process of its own, over TCP where it needs a PLC, with its lock file there as after a first
time. What ``import click`` loads in such a process is not counted.
"""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import fatektool
from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running
from fatektool.transport.lock import PortLock

if TYPE_CHECKING:
    from collections.abc import Iterator

PACKAGE = Path(fatektool.__file__).parent

LOADED = "import sys; {action}; print(*sys.modules, file=sys.stderr)"

LIBRARIES = {"rich", "pymodbus", "dulwich", "serial", "jsonschema"}
"""Each is for one thing: a bar on a terminal, Modbus, a history, a serial port, a test."""

HEAVY = {"asyncio", "git", "logging", "random", "ssl", "subprocess", "tempfile", "tomllib", "urllib.request"}
"""Of the standard library, what no command on the way to a PLC has a use for."""

OTHER_PLCS = {
    "fatektool.simulator",
    "fatektool.protocol.fatek.mseries.codec",
    "fatektool.protocol.fatek.mseries.data",
    "fatektool.protocol.modbus.codec",
    "fatektool.protocol.modbus.data",
    "fatektool.protocol.modbus.map",
    "fatektool.protocol.modbus.pdu",
    "fatektool.protocol.modbus.rtu",
    "fatektool.protocol.modbus.tcp",
    "fatektool.transport.memory",
    "fatektool.transport.modem.device",
    "fatektool.transport.serial_line.port",
    "fatektool.transport.trace",
    "fatektool.transport.udp",
}
"""Protocols and media that were not named."""

OTHER_JOBS = {
    "fatektool.history",
    "fatektool.inventory.entries",
    "fatektool.jobs.fleet.rounds",
    "fatektool.jobs.programs.restore",
    "fatektool.jobs.snapshots.snapshot",
    "fatektool.report",
    "fatektool.protocol.explain",
    "fatektool.plcports.tables",
}

NEVER = LIBRARIES | HEAVY | OTHER_PLCS | OTHER_JOBS
PLANNER = {"fatektool.planner", "fatektool.jobs.elements.reads", "fatektool.jobs.elements.selection"}
PROGRAMS = {"fatektool.program.archive", "fatektool.jobs.programs.reading", "hashlib"}


@cache
def loaded(action: str) -> frozenset[str]:
    """The modules that are there when this was done in a fresh process."""
    program = LOADED.format(action=action)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    return frozenset(done.stderr.split())


def beyond_click(*words: str) -> set[str]:
    """What a command line loads that ``import click`` does not."""
    found = loaded(f"from fatektool.cli import run; code = run({list(words)}); assert code == 0, code")
    assert "click" in found
    return set(found - loaded("import click") - FOLDERS)


FOLDERS = {
    ".".join(path.parent.relative_to(PACKAGE.parent).parts)
    for path in PACKAGE.rglob("__init__.py")
    if path.read_text(encoding="utf-8").count("\n") == 1
}
"""Packages of one docstring: nothing in them costs time."""


def ours(modules: set[str]) -> set[str]:
    return {name for name in modules if name.partition(".")[0] == "fatektool"}


@pytest.fixture
def target(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A PLC behind TCP, which was spoken to before."""
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    server = Server(build_simulation(ladder_words=400))
    door = server.open_tcp()
    lock = PortLock(door.address.removeprefix("tcp://"), 0)
    lock.acquire()
    lock.release()
    assert os.path.exists(lock.path)  # noqa: PTH110  # it is text
    with running(server):
        yield door.address


@pytest.mark.parametrize("name", sorted(OTHER_PLCS | OTHER_JOBS | PLANNER | PROGRAMS))
def test_there_is_such_a_module(name: str) -> None:
    """One that moved would never be found loaded."""
    assert find_spec(name) is not None


# --- the library ------------------------------------------------------------------------------------------


def test_importing_the_library_loads_no_other() -> None:
    assert not {"click", "rich", "serial"} & loaded("import fatektool; fatektool.__version__")
    every = loaded("import fatektool; [getattr(fatektool, name) for name in fatektool.__all__]")
    assert not every & ({"click"} | LIBRARIES | OTHER_PLCS)


# --- without a PLC ----------------------------------------------------------------------------------------

FRAME = {
    "fatektool",
    "fatektool.version",
    "fatektool.errors",
    "fatektool.cli",
    "fatektool.cli.app",
    "fatektool.cli.shared.lazy_group",
    "fatektool.cli.shared.output",
    "fatektool.cli.shared.stops",
    "fatektool.cli.shared.streams",
}


def test_version_loads_the_frame_alone() -> None:
    """No command, no transport, no planner, nothing of a protocol."""
    found = beyond_click("--version")
    assert ours(found) == FRAME
    assert not found & (NEVER | {"json", "pathlib", "hashlib", "socket", "difflib"})
    assert len(found) <= 12


def test_help_loads_no_command() -> None:
    found = beyond_click("--help")
    assert ours(found) == FRAME
    assert not found & (NEVER | {"json", "pathlib", "hashlib", "socket", "difflib"})
    assert len(found) <= 26


@pytest.mark.parametrize("group", ["fleet", "history", "inventory", "link", "link table", "snapshot"])
def test_the_help_of_a_group_loads_no_command(group: str) -> None:
    found = beyond_click(*group.split(), "--help")
    home = {"link table": "line.link.table", "link": "line.link", "snapshot": "elements.snapshot"}
    module = f"fatektool.cli.{home.get(group, f'many.{group}')}"
    others = {"fatektool.cli.line.link.group"} if group == "link table" else set()
    assert ours(found) - others == FRAME | {f"{module}.group"}


# --- over TCP ---------------------------------------------------------------------------------------------


def test_status(target: str) -> None:
    found = beyond_click("status", "-p", target)
    assert not found & (NEVER | PLANNER | PROGRAMS)
    assert not found & {"json", "pathlib", "encodings.idna", "fatektool.transport.limit"}
    assert {name for name in ours(found) if name.startswith("fatektool.jobs.")} == {
        "fatektool.jobs.status",
    }
    assert {name for name in ours(found) if name.startswith("fatektool.transport.")} == {
        f"fatektool.transport.{name}"
        for name in ("base", "lock", "open", "patience", "sockets", "target", "tcp", "wait")
    }
    assert len(found) <= 78


BEFORE_THE_FIRST_BYTE = """
import sys
from fatektool.transport.tcp import TcpTransport
def end(*_):
    print(*sys.modules, file=sys.stderr)
    sys.stderr.flush()
    __import__("os")._exit(0)
TcpTransport.write = end
from fatektool.cli import run
run(["status", "-p", "{target}"])
"""


def test_what_status_loads_before_its_first_byte(target: str) -> None:
    program = BEFORE_THE_FIRST_BYTE.format(target=target)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    found = set(done.stderr.split())
    assert "fatektool.protocol.fatek.facon.codec" in found
    assert "fatektool.protocol.status" not in found  # what an answer is made of is loaded while it comes


def test_read(target: str) -> None:
    found = beyond_click("read", "R0", "-p", target)
    assert found >= PLANNER
    assert not found & (NEVER | PROGRAMS | {"json", "pathlib", "encodings.idna"})
    assert len(found) <= 98


def test_backup(target: str) -> None:
    found = beyond_click("backup", "here.json", "-p", target)
    assert found >= PROGRAMS
    assert not found & ((NEVER - {"random"}) | PLANNER | {"encodings.idna", "fatektool.transport.limit"})
    assert len(found) <= 124


def test_what_is_named_is_loaded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    found = beyond_click("status", "--brief", "-p", "sim:", "--trace", "wire.ndjson", "--json")
    assert found >= {"fatektool.simulator", "fatektool.transport.memory", "fatektool.transport.trace", "json"}
