"""Commands on a small machine: wall time, processor time and memory with a fraction of one core.

    python bench/small.py [SLOWER]

A command is bound to one core (``taskset``) and stopped whenever it has used more than 1/SLOWER of the time
that has passed. SLOWER is 25 by default, for a Raspberry Pi Zero: 1 GHz ARM1176, about 1/25 of a core of a
current server in Python. That is an estimate and was not measured on one. A PLC on TCP answers at once, in
another process that is not slowed; the time that a line needs is not in the figures.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server, running

SLOWER = 25.0
LOOK_S = 0.005
FEW, MANY = 100, 600
REGISTERS = "R0-R999"
JOBS = (
    ("start (`--version`)", "--version"),
    ("`status`", "status -p {plc}"),
    (f"`read {REGISTERS}`", f"read {REGISTERS} -p {{plc}}"),
    ("`backup`, 207 pages", "backup x.json --force -p {plc}"),
    ("`verify`", "verify x.json -p {plc}"),
    (f"`loopback`, {FEW} exchanges", f"loopback --count {FEW} -p {{plc}}"),
    (f"`loopback`, {MANY} exchanges", f"loopback --count {MANY} -p {{plc}}"),
)


class Cost(NamedTuple):
    """What a command took.

    Attributes:
        wall_s: from its start to its end.
        cpu_s: of processor.
        memory_mib: at most.
    """

    wall_s: float
    cpu_s: float
    memory_mib: float


def limited(words: list[str], slower: float) -> Cost:
    """Run a command with a fraction of one core."""
    command = ["taskset", "-c", "0", sys.executable, "-m", "fatektool", *words]
    began = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    used = Path(f"/proc/{process.pid}/schedstat")
    stopped = False
    while True:
        number, status, usage = os.wait4(process.pid, os.WNOHANG)
        if number:
            break
        rest = int(used.read_text().split()[0]) / 1e9 * slower - (time.perf_counter() - began)
        if (rest > 0) != stopped:
            stopped = not stopped
            os.kill(process.pid, signal.SIGSTOP if stopped else signal.SIGCONT)
        time.sleep(max(LOOK_S, min(rest, 0.1)))
    wall_s = time.perf_counter() - began
    if status:
        raise SystemExit(f"{' '.join(words)} ended with {os.waitstatus_to_exitcode(status)}")
    return Cost(wall_s, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def main(slower: float = SLOWER) -> None:
    """Print the table, as docs/install.md has it."""
    server = Server(build_simulation())
    plc = server.open_tcp().address
    costs: list[Cost] = []
    print(f"| job | time with 1/{slower:g} of a core | processor, whole core | memory |")
    print("| --- | --- | --- | --- |")
    with running(server), tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name, line in JOBS:
            costs.append(min(limited([*line.format(plc=plc).split()], slower) for _ in range(2)))
            _print_row(name, costs[-1])
    few, many = costs[-2:]
    wall_s, cpu_s = ((many[field] - few[field]) / (MANY - FEW) for field in (0, 1))
    slow, whole = f"{wall_s * 1000:.1f} ms", f"{cpu_s * 1000:.2f} ms"
    print(f"an exchange: {slow} with 1/{slower:g} of a core, {whole} of a whole one")


def _print_row(name: str, cost: Cost) -> None:
    wall, cpu = f"{cost.wall_s:.1f} s", f"{cost.cpu_s * 1000:.0f} ms"
    print(f"| {name} | {wall} | {cpu} | {cost.memory_mib:.0f} MiB |", flush=True)


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
