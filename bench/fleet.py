"""1 to 1000 PLCs on as many TCP ports, 20 ms to answer: time and memory of a backup of all, as a curve.

The bound is the lines' own time: exchanges x time to answer x rounds of so many lines at once. Beside it
is a bare loop, which sends the requests for the pages from as many threads and looks at nothing. A row
with fewer PLCs than lines has one round: what it shows is the way into a connection and out of a file. Memory
is the peak of the tool's process, with the documents that ``--json`` keeps to its end; *KB a PLC* is what a
row has beyond the first one. Then ``fleet status`` for all of them, the whole process, without ``--json``.

The simulators have one core and the measured process the other; *simulators* is how much of theirs they use.
Exit 1 if a row is beyond the limit.

Usage: python bench/fleet.py [--jobs N] [PLCS ...], by default 1 10 100 500 1000, 64 at once
"""

from __future__ import annotations

import argparse
import json
import resource
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

from bare_loop import loop
from common import pinned, simulators
from exchanges import reading
from figures import figure

WORDS = 8192
PAGES = 129
SCAN_MS = 20
LIMIT = 1.2
PROCESSES = 2
_MEASURE = (
    "import json, resource, subprocess, sys, time; began = time.perf_counter(); "
    "code = subprocess.run(sys.argv[1:], check=False).returncode; took = time.perf_counter() - began; "
    "used = resource.getrusage(resource.RUSAGE_CHILDREN); "
    "print(json.dumps([took, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024]), file=sys.stderr); "
    "sys.exit(code)"
)


class Used(NamedTuple):
    """What a run of the tool took: seconds of its job, of the CPU, and its peak in MB."""

    seconds: float
    cpu_s: float
    mb: float


def bare(targets: deque[str]) -> None:
    """Read all pages of one target after the other."""
    todo = reading(PAGES)
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


def run_tool(targets: list[str], jobs: int, folder: Path, *words: str) -> Used:
    """What ``fleet`` takes for a job; seconds from the first connection to the last file with ``--json``."""
    inventory = folder / "fatek.toml"
    tables = (f'[plc.plc{number}]\ntarget = "{target}"\n' for number, target in enumerate(targets))
    inventory.write_text("\n".join(tables), encoding="utf-8")
    options = ["--jobs", str(jobs), "-q", "--inventory", str(inventory)]
    tool = [sys.executable, "-m", "fatektool", "fleet", *words, *options]
    done = subprocess.run(
        pinned(1, [sys.executable, "-c", _MEASURE, *tool]), capture_output=True, check=True, text=True
    )
    took, cpu_s, mb = json.loads(done.stderr.splitlines()[-1])
    if "--json" in words:
        document = json.loads(done.stdout)
        if document["summary"]["ok"] != len(targets):
            raise SystemExit(f"not all were done: {document['summary']}")
        took = document["duration_s"]
    return Used(took, cpu_s, mb)


def row(plcs: int, jobs: int, first_mb: float | None) -> tuple[float, float]:
    """Print one row; the greater ratio that counts, and the peak in MB."""
    bound = PAGES * SCAN_MS / 1000 * -(-plcs // jobs)
    with ExitStack() as stack:
        targets: list[str] = []
        for number in range(min(PROCESSES, plcs)):
            share = plcs // PROCESSES + (number < plcs % PROCESSES)
            options = ["--tcp", "127.0.0.1:0"] * share
            pace = ["--scan-ms", str(SCAN_MS), "--ladder-words", str(WORDS)]
            targets += stack.enter_context(simulators(*options, *pace))
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        bare_s = run_bare(targets, jobs)
        backup = run_tool(targets, jobs, folder, "backup", "--dir", str(folder), "--single-pass", "--json")
        status = run_tool(targets, jobs, folder, "status")
        clients = resource.getrusage(resource.RUSAGE_CHILDREN)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    served = bare_s + backup.seconds + status.seconds
    their_cpu = (after.ru_utime + after.ru_stime - clients.ru_utime - clients.ru_stime) / served
    ratio = backup.seconds / max(bound, bare_s)
    beyond = "" if first_mb is None else f" {1024 * (backup.mb - first_mb) / (plcs - 1):5.0f} KB a PLC"
    print(
        f"{plcs:>4} PLCs, {jobs} at once  bound {bound:5.1f} s  bare {bare_s:5.1f} s  "
        f"tool {backup.seconds:5.1f} s  to bound {backup.seconds / bound:.3f}  "
        f"to bare {backup.seconds / bare_s:.3f}  {1000 * backup.seconds / plcs:6.0f} ms a PLC, "
        f"{1000 * backup.cpu_s / plcs:4.0f} of the CPU  {backup.mb:3.0f} MB{beyond:<16}  "
        f"status {status.seconds:5.2f} s {status.mb:3.0f} MB  simulators {their_cpu:.2f}",
        flush=True,
    )
    return ratio, backup.mb


def main() -> None:
    """Print the curve."""
    if sys.argv[1:2] == ["bare"]:
        bare_main(int(sys.argv[2]), sys.argv[3:])
        return
    parser = argparse.ArgumentParser()
    parser.add_argument("--jobs", type=int, default=64)
    parser.add_argument("plcs", type=int, nargs="*", default=[1, 10, 100, 500, 1000])
    wanted = parser.parse_args()
    worst, first_mb = 0.0, None
    for plcs in wanted.plcs:
        ratio, mb = row(plcs, wanted.jobs, first_mb)
        worst, first_mb = max(worst, ratio), mb if first_mb is None else first_mb
    figure("fleet, worst to the greater of bound and bare loop", worst, limit=LIMIT)
    print(f"worst of them, to the greater of bound and bare loop: {worst:.3f}  limit {LIMIT}")
    if worst > LIMIT:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
