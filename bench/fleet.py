"""500 PLCs behind 500 TCP doors, 20 ms to answer: how near is a backup of all to what the lines allow?

The bound is the lines' own time: exchanges x time to answer x PLCs / lines at once. Beside it stands a bare
loop, which sends the requests for the pages from as many threads and looks at nothing. The simulator has one
core and the measured process the other.

Usage: python bench/fleet.py [PLCS [JOBS]]
"""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from contextlib import ExitStack
from pathlib import Path

from bare_loop import loop, requests
from common import doors, pinned

WORDS = 8192
PAGES = 129
SCAN_MS = 20
LIMIT = 1.2
PROCESSES = 2
_PEAK = (
    "import resource, subprocess, sys; code = subprocess.run(sys.argv[1:], check=False).returncode; "
    "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, file=sys.stderr); sys.exit(code)"
)


def bare(targets: deque[str]) -> None:
    """Read all pages of one target after the other."""
    todo = requests(PAGES)
    while targets:
        try:
            target = targets.popleft()
        except IndexError:
            return
        host, _, port = target.removeprefix("tcp://").rpartition(":")
        with socket.create_connection((host, int(port))) as connected:
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            loop(todo, connected.sendall, connected.recv)


def bare_main(jobs: int, names: list[str]) -> None:
    """The bare loop as a process: targets on many threads."""
    targets = deque(names)
    began = time.perf_counter()
    threads = [threading.Thread(target=bare, args=(targets,)) for _ in range(jobs)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    print(json.dumps({"duration_s": time.perf_counter() - began}))


def run_bare(targets: list[str], jobs: int) -> float:
    """Seconds that the bare loop takes."""
    command = pinned(1, [sys.executable, __file__, "bare", str(jobs), *targets])
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    duration: float = json.loads(done.stdout)["duration_s"]
    return duration


def run_tool(targets: list[str], jobs: int, folder: Path) -> tuple[float, float]:
    """Seconds that ``fleet backup`` takes, from the first connection to the last file, and its peak in MB."""
    inventory = folder / "fatek.toml"
    tables = (f'[plc.plc{number}]\ntarget = "{target}"\n' for number, target in enumerate(targets))
    inventory.write_text("\n".join(tables), encoding="utf-8")
    words = ["fleet", "backup", "--dir", str(folder), "--single-pass", "--jobs", str(jobs), "-q", "--json"]
    tool = [sys.executable, "-m", "fatektool", *words, "--inventory", str(inventory)]
    command = pinned(1, [sys.executable, "-c", _PEAK, *tool])
    done = subprocess.run(command, capture_output=True, check=True)
    document = json.loads(done.stdout)
    if document["summary"]["ok"] != len(targets):
        raise SystemExit(f"not all were backed up: {document['summary']}")
    return document["duration_s"], int(done.stderr.split()[-1]) / 1024


def main() -> None:
    """Print one row."""
    if sys.argv[1:2] == ["bare"]:
        bare_main(int(sys.argv[2]), sys.argv[3:])
        return
    plcs, jobs = [*map(int, sys.argv[1:3]), *[500, 64][len(sys.argv) - 1 :]]
    bound = PAGES * SCAN_MS / 1000 * plcs / jobs
    with ExitStack() as stack:
        targets: list[str] = []
        for number in range(PROCESSES):
            share = plcs // PROCESSES + (number < plcs % PROCESSES)
            options = ["--tcp", "127.0.0.1:0"] * share
            pace = ["--scan-ms", str(SCAN_MS), "--ladder-words", str(WORDS)]
            targets += stack.enter_context(doors(*options, *pace))
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        bare_s = run_bare(targets, jobs)
        tool_s, memory_mb = run_tool(targets, jobs, folder)
    print(
        f"{plcs} PLCs, {jobs} at once  bound {bound:.1f} s  bare {bare_s:.1f} s  tool {tool_s:.1f} s  "
        f"to bound {tool_s / bound:.3f}  to bare {tool_s / bare_s:.3f}  limit {LIMIT} to the greater  "
        f"{memory_mb:.0f} MB"
    )


if __name__ == "__main__":
    main()
