"""The simulator's own capacity: other figures depend on it, so it must be the bottleneck of none of them.

*Exchanges*: so many clients ask as fast as they can, each with one request on its way; beside the simulator
is a bare responder, which sends a constant answer for whatever it receives, asked by the same clients.
*us* is how long the simulator's process had the CPU, as the system counts it, for one exchange.

*Pace*: requests written all at once to a pty at a baud rate, until their last answer, against the bytes on
the wire: what is over is the simulator's, as the client has no turns of its own. *Lines*: the same on many
ptys of one simulator, until they are 1 % late.

*Share*: how much of a backup's time the simulator has the CPU.

The simulator (or the bare responder) has one core, the clients another.

Usage: python bench/simulator.py [SECONDS], the length of one measurement (1)
"""

from __future__ import annotations

import json
import os
import pty
import selectors
import socket
import subprocess
import sys
import tempfile
import time
import tty
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from common import LARGEST, pinned, tool
from figures import figure
from questions import EVERY_STATION, PAGES, QUESTIONS, Question

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

BAUDS = (9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600)
LATE = 0.01
_BITS = 10


class Simulator(NamedTuple):
    """One at work: its targets, and the process."""

    targets: list[str]
    pid: int

    def cpu_s(self) -> float:
        """Seconds that it had the CPU so far."""
        return int(Path(f"/proc/{self.pid}/schedstat").read_text(encoding="ascii").split()[0]) / 1e9


@contextmanager
def started(*options: str) -> Iterator[Simulator]:
    """A simulator on a core of its own."""
    command = pinned(0, [sys.executable, "-m", "fatektool", "simulate", "--json", *options])
    with _process(command) as process:
        assert process.stdout is not None  # noqa: S101  # for the type checker
        text = ""
        while not text.endswith("}\n"):
            text += process.stdout.readline()
        yield Simulator(json.loads(text)["listening"], process.pid)


@contextmanager
def responder(kind: str, answer_bytes: int) -> Iterator[str]:
    """The least that could answer, on the same core; gives its target."""
    with _process(pinned(0, [sys.executable, __file__, "respond", kind, str(answer_bytes)])) as process:
        assert process.stdout is not None  # noqa: S101  # the same
        yield process.stdout.readline().strip()


@contextmanager
def _process(command: list[str]) -> Iterator[subprocess.Popen[str]]:
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.terminate()


def respond(kind: str, answer: bytes) -> None:
    """Answer whatever comes with the same bytes, until this process is ended."""
    watched = selectors.DefaultSelector()
    if kind == "pty":
        master, slave = pty.openpty()
        tty.setraw(slave)
        print(os.ttyname(slave), flush=True)
        while os.read(master, 65536):
            os.write(master, answer)
    listening = socket.create_server(("127.0.0.1", 0), backlog=1024)
    print(f"tcp://127.0.0.1:{listening.getsockname()[1]}", flush=True)
    watched.register(listening, selectors.EVENT_READ)
    while True:
        for key, _ in watched.select():
            if key.fileobj is listening:
                client, _ = listening.accept()
                client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                watched.register(client, selectors.EVENT_READ, client)
            elif key.data.recv(65536):
                key.data.send(answer)
            else:
                watched.unregister(key.data)
                key.data.close()


class Client:
    """One request on its way, on a descriptor."""

    def __init__(self, target: str, question: Question, first: int = 0) -> None:
        if target.startswith("tcp://"):
            host, _, port = target.removeprefix("tcp://").rpartition(":")
            connected = socket.create_connection((host, int(port)))
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.descriptor = connected.detach()
        else:
            self.descriptor = os.open(target, os.O_RDWR | os.O_NOCTTY)
        self.requests = question.requests
        self.answer_bytes = question.answer_bytes
        self.missing = 0
        self.asked = first

    def ask(self) -> None:
        """Send the next request."""
        self.missing = self.answer_bytes
        os.write(self.descriptor, self.requests[self.asked % len(self.requests)])
        self.asked += 1

    def receive(self) -> bool:
        """Take what has come; True if the answer is whole."""
        self.missing -= len(os.read(self.descriptor, self.missing))
        return not self.missing


def ask_for(clients: Sequence[Client], more: Callable[[int, float], bool]) -> tuple[int, float]:
    """Let all clients ask at once, again and again; exchanges and seconds.

    Args:
        clients: who asks.
        more: whether to ask once more, from the exchanges and seconds so far.
    """
    watched = selectors.DefaultSelector()
    for client in clients:
        watched.register(client.descriptor, selectors.EVENT_READ, client)
    began = time.perf_counter()
    for client in clients:
        client.ask()
    done, waiting = 0, len(clients)
    while waiting:
        for key, _ in watched.select() if len(clients) > 1 else [(watched.get_key(clients[0].descriptor), 0)]:
            client = key.data
            if client.receive():
                done += 1
                if more(done, time.perf_counter() - began):
                    client.ask()
                else:
                    waiting -= 1
    took = time.perf_counter() - began
    watched.close()
    return done, took


def run_clients(
    targets: Sequence[str], question: Question, more: Callable[[int, float], bool]
) -> tuple[int, float]:
    """The same with new clients, one a target."""
    clients = [Client(target, question, first) for first, target in enumerate(targets)]
    cores = os.sched_getaffinity(0)
    try:
        os.sched_setaffinity(0, [max(cores)])  # what has been started already keeps its own
        ask_for(clients, lambda _done, _took: False)  # the first exchange is a connection's beginning
        return ask_for(clients, more)
    finally:
        os.sched_setaffinity(0, cores)
        for client in clients:
            os.close(client.descriptor)


def exchanges(question: Question, clients: int, seconds: float, *options: str, on_pty: bool = False) -> None:
    """Print one row of the first table."""

    def more(_done: int, took: float) -> bool:
        return took < seconds

    with tempfile.TemporaryDirectory() as folder:
        listener = ["--pty", f"{folder}/plc"] if on_pty else ["--tcp", "127.0.0.1:0"]
        with started(
            *listener, "--protocol", question.protocol, "--ladder-words", "8192", *options
        ) as simulator:
            before = simulator.cpu_s()
            done, took = run_clients(simulator.targets * clients, question, more)
            cpu_us = (simulator.cpu_s() - before) / done * 1e6
    with responder("pty" if on_pty else "tcp", question.answer_bytes) as target:
        bare_done, bare_took = run_clients([target] * clients, question, more)
    rate, bare = done / took, bare_done / bare_took
    where = "pty" if on_pty else f"{clients} x TCP"
    figure(f"simulator, {question.name}, {where}", rate, "exchanges/s")
    print(
        f"{question.name:<27} {where:<9} {rate:7.0f} a second, {cpu_us:6.1f} us  "
        f"bare responder {bare:7.0f} a second  ratio {bare / rate:5.2f}",
        flush=True,
    )


def pace(baud: int, lines: int, seconds: float) -> tuple[float, float]:
    """Answers on paced ptys: seconds over those of the wire, and the simulator's part of its core."""
    count = max(2, round(seconds * baud / _BITS / PAGES.answer_bytes))
    requests = b"".join(PAGES.requests[number % len(PAGES.requests)] for number in range(count))
    at_once = Question(PAGES.name, PAGES.protocol, [requests], count * PAGES.answer_bytes)
    ideal = (len(PAGES.requests[0]) + at_once.answer_bytes) * _BITS / baud
    with tempfile.TemporaryDirectory() as folder:
        listeners = [word for number in range(lines) for word in ("--pty", f"{folder}/{number}")]
        with started(*listeners, "--baud", str(baud), "--ladder-words", "8192") as simulator:
            before = simulator.cpu_s()
            _, took = run_clients(simulator.targets, at_once, lambda _done, _took: False)
            cpu_s = simulator.cpu_s() - before
    return took / ideal, cpu_s / (2 * took)


def most_lines(baud: int, seconds: float) -> str:
    """How many lines, doubled from one, are within 1 % of their wires; and the first number that is not."""
    within = "none within 1 %"
    for lines in (1 << power for power in range(9)):
        ratio, cpu = pace(baud, lines, 2 * seconds)
        said = f"{lines} lines at once  elapsed to wire {ratio:.4f}  simulator {cpu:.3f} of its core"
        if ratio > 1 + LATE:
            return f"{within};  {said}"
        within = said
    return within


def share(name: str, options: Sequence[str], *more: str) -> None:
    """Print how much of a backup's time the simulator has the CPU."""
    with started(*options) as simulator:
        before = simulator.cpu_s()
        with tempfile.TemporaryDirectory() as folder:
            took = tool("backup", f"{folder}/x.json", "--single-pass", "-p", simulator.targets[0], *more)
        cpu_s = simulator.cpu_s() - before
    print(
        f"{name:<24} {took.transfer_s:7.3f} s, simulator at work {cpu_s:6.3f} s  "
        f"share {cpu_s / took.transfer_s:.3f}"
    )


def main() -> None:
    """Print all tables."""
    if sys.argv[1:2] == ["respond"]:
        respond(sys.argv[2], b"\x02" * int(sys.argv[3]))
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
    for question in QUESTIONS:
        exchanges(question, 8, seconds)
    for clients in (1, 64, 500):
        exchanges(PAGES, clients, seconds)
    every = [word for station in range(1, 255) for word in ("--station", str(station))]
    exchanges(EVERY_STATION, 8, seconds, *every)
    exchanges(PAGES, 1, seconds, on_pty=True)
    for baud in BAUDS:
        ratio, cpu = pace(baud, 1, 2 * seconds)
        print(f"{baud:>7} baud  elapsed to wire {ratio:.4f}  simulator {cpu:.3f} of its core", flush=True)
    for baud in (9600, 115200, 921600):
        print(f"{baud:>7} baud  {most_lines(baud, seconds)}", flush=True)
    sizes = ["--ladder-words", str(LARGEST)]
    share("TCP, 1025 pages", ["--tcp", "127.0.0.1:0", *sizes])
    with tempfile.TemporaryDirectory() as folder:
        listener = ["--pty", f"{folder}/plc"]
        for baud, words in ((115200, 13184), (921600, LARGEST)):
            options = [*listener, "--baud", str(baud), "--ladder-words", str(words)]
            share(f"{baud} baud, {words} words", options, "--baud", str(baud))


if __name__ == "__main__":
    main()
