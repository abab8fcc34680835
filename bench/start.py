"""What does starting cost, beside ``import click``, the largest part of it and one that is not ours?

Whole processes are compared, from the call that starts them:

- ``import click``: ``python -c "import click"``, to its end;
- ``--version``, ``--help`` and ``status`` to a simulator beside it, to their ends;
- *first byte*: ``status``, until the first byte of its first request has come out of a TCP connection of this
  bench. What comes after that is not in it: the answers, what is shown of them, the end of the process.

Each by ``python -m fatektool``, and by the installed command where there is one. All of them take turns, so
that a machine that slows down slows down all. The ratios are to ``import click``: of the least times, which
the limits are for, as noise only adds; and of the medians. Modules are those that are loaded at the end. All
of them are there as bytecode, as an installed package's are, and as Python keeps them after a first run.

Usage: python bench/start.py [RUNS]
"""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, NamedTuple

from common import simulator
from figures import figure

if TYPE_CHECKING:
    from collections.abc import Callable

RUNS = 25
LIMITS = {"--version": 1.3, "status, first byte": 1.6}
_MODULES = """
import sys
from fatektool.cli import run
run(sys.argv[1:])
print(len(sys.modules), file=sys.stderr)
"""
_ANSWERS = {b"40": b"0000000", b"53": b"4"}


class Start(NamedTuple):
    """What is started, and how it is timed."""

    name: str
    way: str
    modules: int
    seconds: Callable[[], float]


def whole(*command: str) -> float:
    """Seconds from the start of a process to its end."""
    began = time.perf_counter()
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
    return time.perf_counter() - began


def first_byte(server: socket.socket, *command: str) -> float:
    """Seconds from the start of a process to the first byte that it sends.

    It gets answers, and so ends as always: a PLC in STOP, and one that refuses 53.
    """
    words = [*command, "-p", target_of(server)]
    began = time.perf_counter()
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL):
        came_in, _ = server.accept()
        with came_in:
            request = came_in.recv(1)
            took = time.perf_counter() - began
            while more := came_in.recv(64):
                request += more
                if request.endswith(b"\x03"):
                    came_in.sendall(answer(request[3:5]))
                    request = b""
    return took


def answer(code: bytes) -> bytes:
    """A frame that answers a command."""
    body = b"\x0201" + code + _ANSWERS[code]
    return b"%b%02X\x03" % (body, sum(body) & 0xFF)


def target_of(server: socket.socket) -> str:
    """How the tool names it."""
    return f"tcp://127.0.0.1:{server.getsockname()[1]}"


def modules(words: list[str]) -> int:
    """How many modules a command line has loaded when it is done."""
    command = [sys.executable, "-c", _MODULES, *words]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return int(done.stderr.split()[-1])


def starts(target: str, server: socket.socket) -> list[Start]:
    """All that is compared; the first is what the others are compared with."""
    bare = [sys.executable, "-c", "import click"]
    count = [sys.executable, "-c", "import click, sys; print(len(sys.modules))"]
    loaded = int(subprocess.run(count, capture_output=True, text=True, check=True).stdout)
    found = [Start("import click", "", loaded, partial(whole, *bare))]
    ways = {"python -m": [sys.executable, "-m", "fatektool"]}
    installed = shutil.which("fatektool", path=str(Path(sys.executable).parent))
    if installed:
        ways["command"] = [installed]
    status = ["status", "-p", target]
    for name, words in {"--version": ["--version"], "--help": ["--help"], "status": status}.items():
        modules(words)  # the first time leaves a lock file
        loaded = modules(words)
        for way, tool in ways.items():
            found.append(Start(name, way, loaded, partial(whole, *tool, *words)))
    for way, tool in ways.items():
        found.append(Start("status, first byte", way, loaded, partial(first_byte, server, *tool, "status")))
    return found


def row(start: Start, took: list[float], bare: list[float]) -> tuple[str, bool]:
    """One line, and whether the limit is kept."""
    least, middle = min(took) / min(bare), median(took) / median(bare)
    limit = LIMITS.get(start.name)
    figure(f"{start.name} {start.way}".strip(), least, limit=limit)
    times = f"least {min(took) * 1000:6.1f}  median {median(took) * 1000:6.1f} ms"
    ratios = f"ratio {least:.3f}  of medians {middle:.3f}"
    text = f"{start.name:<18} {start.way:<9}  {start.modules:3} modules  {times}  {ratios}"
    return text + (f"  limit {limit}" if limit else ""), limit is None or least <= limit


def main() -> int:
    """Print a row for each; 1 if a limit is passed."""
    runs = int(sys.argv[1]) if sys.argv[1:] else RUNS
    with (
        tempfile.TemporaryDirectory() as folder,
        simulator("--tcp", "127.0.0.1:0") as target,
        socket.create_server(("127.0.0.1", 0)) as server,
    ):
        os.environ["PYTHONPYCACHEPREFIX"] = folder
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
        found = starts(target, server)
        for start in found[1:]:  # a first run leaves its bytecode, and the lock files
            start.seconds()
        took: list[list[float]] = [[] for _ in found]
        for _ in range(runs):
            for start, times in zip(found, took, strict=True):
                times.append(start.seconds())
    rows = [row(start, times, took[0]) for start, times in zip(found, took, strict=True)]
    print(*(text for text, _ in rows), sep="\n")
    return 0 if all(kept for _, kept in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
