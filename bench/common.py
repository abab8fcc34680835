"""What the benchmarks share: a simulator in a process of its own, and runs that are timed from outside."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from figures import figure

if TYPE_CHECKING:
    from collections.abc import Iterator

    from exchanges import Exchange

HERE = Path(__file__).parent
LARGEST = 65535  # words: 1025 pages
_PIN = "import os, sys; os.sched_setaffinity(0, [int(sys.argv[1])]); os.execv(sys.argv[2], sys.argv[2:])"


def pinned(core: int, command: list[str]) -> list[str]:
    """The command on a core of its own, where the system can: sharing one times the scheduler."""
    if sys.platform != "linux" or len(os.sched_getaffinity(0)) < 2:
        return command
    return [sys.executable, "-c", _PIN, str(sorted(os.sched_getaffinity(0))[core]), *command]


class Timing(NamedTuple):
    """One run: seconds from first request to last answer, and of the whole process."""

    transfer_s: float
    process_s: float


@contextlib.contextmanager
def simulator(*options: str) -> Iterator[str]:
    """A simulator as long as the context lasts; gives its target."""
    with simulators(*options) as targets:
        yield targets[0]


@contextlib.contextmanager
def simulators(*options: str) -> Iterator[list[str]]:
    """A simulator with many TCP ports as long as the context lasts; gives their targets."""
    command = pinned(0, [sys.executable, "-m", "fatektool", "simulate", "--json", *options])
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None  # noqa: S101  # for the type checker
            text = ""
            while not text.endswith("}\n"):
                text += process.stdout.readline()
            yield json.loads(text)["listening"]
        finally:
            process.terminate()


def bare(target: str, exchanges: list[Exchange]) -> Timing:
    """The bare loop, in a process of its own."""
    lines = "".join(f"{request.hex()} {size}\n" for request, size in exchanges)
    return _timed([sys.executable, str(HERE / "bare_loop.py"), target], lines)


def tool(*words: str) -> Timing:
    """A command of the tool."""
    return _timed([sys.executable, "-m", "fatektool", *words, "--json", "-q"])


def _timed(command: list[str], lines: str = "") -> Timing:
    began = time.perf_counter()
    done = subprocess.run(pinned(1, command), input=lines, stdout=subprocess.PIPE, check=True, text=True)
    process_s = time.perf_counter() - began
    document: dict[str, Any] = json.loads(done.stdout)
    return Timing(document["duration_s"], process_s)


def best(timings: list[Timing]) -> Timing:
    """The least of each, as noise only adds."""
    return Timing(min(t.transfer_s for t in timings), min(t.process_s for t in timings))


def row(name: str, tool_took: Timing, bare_took: Timing, limit: float, wire_s: float = 0.0) -> str:
    """One line of a table, with the limit beside the ratio, and how much of the time the line was in use."""
    transfer = tool_took.transfer_s / bare_took.transfer_s
    process = tool_took.process_s / bare_took.process_s
    figure(f"{name}, transfer", transfer, limit=limit)
    use = f"  wire/tool {wire_s / tool_took.transfer_s:.3f}" if wire_s else ""
    return (
        f"{name:<30} bare {bare_took.transfer_s:8.3f} s  tool {tool_took.transfer_s:8.3f} s  "
        f"transfer {transfer:.3f}  process {process:.3f}  limit {limit:.2f}{use}"
        f"{'  OVER' if transfer > limit else ''}"
    )
