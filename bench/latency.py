"""What does ``--low-latency`` save? Jobs over a USB adapter that delays received bytes, and over another.

A USB adapter passes received bytes on when a packet is full or when its timer runs out, after 16 ms unless
somebody says otherwise. ``--low-latency`` has the driver say 1 ms. A pty has no such driver, so the simulated
adapter (``simulate --latency-timer``) does what a real one would do:

    off     --no-low-latency   steps of 16 ms
    on      --low-latency      steps of 1 ms
    none    --low-latency      no steps: a port without USB

Times are from the first request to the last answer, on a paced line, of a PLC that takes 5 ms to answer.
*Adds* is what the adapter adds to each exchange: the time beside that of ``none``, by their number. The ratio
is off to on. As an answer comes at a tick, and the next request right after it, exchanges last whole steps.

Usage: python bench/latency.py [BAUD …]
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path
from statistics import mean
from typing import TYPE_CHECKING, NamedTuple

from common import simulator
from figures import figure

import fatektool
from fatektool.jobs.elements.reads import read_elements
from fatektool.protocol.elements import Element

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.client import Plc

ADAPTERS = {"off": 16, "on": 1, "none": 0}
WORDS = {9600: 1024, 38400: 2048, 115200: 8192}
SCAN_MS = 5
EXCHANGES = 60
"""A job is done again until so many were timed: the time of a tick is chance."""


class Job(NamedTuple):
    """What is timed, by the name of its command."""

    name: str
    do: Callable[[Plc], object]


def registers(count: int) -> list[Element]:
    """R0 and so many in all."""
    return [Element("R", address) for address in range(count)]


JOBS = (
    Job("status", fatektool.read_status),
    Job("read R0-R9", lambda plc: read_elements(plc, registers(10))),
    Job("snapshot R0-R1023", lambda plc: read_elements(plc, registers(1024))),
    Job("backup", lambda plc: fatektool.backup(plc, single_pass=True)),
)


class Took(NamedTuple):
    """Of one job, once: requests with their answers, and seconds."""

    exchanges: float
    seconds: float


def measured(plc: Plc, job: Job) -> Took:
    """A job, done until enough was timed. Once before, so that what is learnt of a line is known."""
    job.do(plc)
    counters = plc.link.counters
    before = counters.exchanges
    took = []
    while counters.exchanges - before < EXCHANGES:
        began = time.perf_counter()
        job.do(plc)
        took.append(time.perf_counter() - began)
    if counters.trouble:
        raise SystemExit(f"{job.name}: the line was to be clean: {counters}")
    return Took((counters.exchanges - before) / len(took), mean(took))


def over(adapter: str, baud: int, folder: Path) -> dict[str, Took]:
    """All jobs over one adapter."""
    line = ["--baud", str(baud), "--latency-timer", str(ADAPTERS[adapter]), "--scan-ms", str(SCAN_MS)]
    link = str(folder / "plc")
    with (
        simulator("--pty", link, *line, "--ladder-words", str(WORDS.get(baud, 2048))) as target,
        fatektool.connect(target, baud=baud, low_latency=adapter != "off") as plc,
    ):
        return {job.name: measured(plc, job) for job in JOBS}


def row(baud: int, name: str, took: dict[str, Took]) -> str:
    """One line of the table."""
    off, on, none = (took[adapter] for adapter in ADAPTERS)
    figure(f"{baud} {name}, off to on", off.seconds / on.seconds)
    adds_off, adds_on = ((one.seconds - none.seconds) / none.exchanges * 1000 for one in (off, on))
    return (
        f"{baud:6} baud  {name:<17} {none.exchanges:3.0f} exchanges  "
        f"off {off.seconds:6.3f} s  on {on.seconds:6.3f} s  none {none.seconds:6.3f} s  "
        f"ratio {off.seconds / on.seconds:.3f}  adds off {adds_off:4.1f}, on {adds_on:4.1f} ms an exchange"
    )


def main() -> None:
    """Print a row a job and baud rate."""
    for baud in [int(word) for word in sys.argv[1:]] or [9600, 38400, 115200]:
        with tempfile.TemporaryDirectory() as folder:
            found = {adapter: over(adapter, baud, Path(folder)) for adapter in ADAPTERS}
        for job in JOBS:
            print(row(baud, job.name, {adapter: jobs[job.name] for adapter, jobs in found.items()}))


if __name__ == "__main__":
    main()
