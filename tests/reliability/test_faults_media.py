"""Every job over every fault as a user meets them: commands over a pty, TCP or UDP, in turn."""

from __future__ import annotations

import json
import os
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import pytest

from fatektool.program.archive import load_backup, save_backup
from fatektool.simulator.build import build_simulation
from fatektool.simulator.faults import BIT_ERRORS, FAULT_KINDS, POWER_CUT
from fatektool.simulator.listen.servers import Server
from tests.hurry import hurried
from tests.plant import snapshot_of
from tests.program.samples import backup, program

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.simulator.plc import SimulatedPlc
    from tests.cli.running import Cli, Done

    Look = Callable[[Done, SimulatedPlc, Path], None]

WORDS = 64
OLD, NEW = program(WORDS, seed=1), program(WORDS, seed=2)
KEPT = [1000 + place for place in range(20)]
LINE = ("--timeout", "0.03", "--retries", "2")
SLOW_S = 0.04

MEDIA = ("pty", "tcp", "udp") if hasattr(os, "openpty") else ("tcp", "udp")


def told_status(done: Done, device: SimulatedPlc, _: Path) -> None:
    document = done.document("status")
    assert document["status"]["running"] == device.running
    assert document["status"]["battery_low"]
    assert document["system"]["ladder_words"] == WORDS


def told_backup(done: Done, _: SimulatedPlc, place: Path) -> None:
    assert done.document("backup-result")["page_count"] == len(OLD.pages)
    assert load_backup(place / "out.json").program == OLD


def told_verify(done: Done, device: SimulatedPlc, _: Path) -> None:
    assert not done.document("verify")["same"]
    assert tuple(device.pages) == OLD.pages


def told_restore(done: Done, device: SimulatedPlc, place: Path) -> None:
    document = done.document("restore")
    assert document["verified"]
    assert tuple(device.pages) == NEW.pages
    assert load_backup(place / document["safety_backup"]).program == OLD


def told_snapshot(done: Done, device: SimulatedPlc, _: Path) -> None:
    document = done.document("snapshot")
    assert not document["errors"]
    assert list(document["values"].values()) == device.read_words("R", 0, len(KEPT)) == KEPT


def told_apply(done: Done, device: SimulatedPlc, _: Path) -> None:
    document = done.document("apply")
    left = {entry["key"] for entry in document["not_taken"]}
    assert document["written"] == len(KEPT) - len(left)
    held = device.read_words("R", 0, len(KEPT))
    assert all((f"R{place}" in left) == bool(value) for place, value in enumerate(held))


def told_loopback(done: Done, _: SimulatedPlc, __: Path) -> None:
    document = done.document("loopback")
    assert document["sent"] == document["ok"] + sum(document["errors"].values()) == 6
    assert (done.code == 0) == (document["ok"] == 6)


def told_scan(done: Done, _: SimulatedPlc, __: Path) -> None:
    document = done.document("scan")
    assert document["probes"] == 2
    assert bool(document["found"]) == (done.code == 0)


class Job(NamedTuple):
    """A command.

    Args:
        words: its words.
        look: holds its document against the PLC's memory.
        results: exit codes that come with a document.
        errors: exit codes that come with an error.
        protocols: that have its commands.
    """

    words: str
    look: Look
    results: set[int]
    errors: set[int]
    protocols: tuple[str, ...] = ("facon", "mseries")


_FACON = ("facon",)
JOBS = {
    "status": Job("status", told_status, {0}, {3}),
    "backup": Job("backup out.json", told_backup, {0}, {3, 5}, _FACON),
    "verify": Job("verify new.json", told_verify, {1}, {3}, _FACON),
    "restore": Job("restore new.json --yes", told_restore, {0}, {3, 4, 5, 6}, _FACON),
    "snapshot": Job("snapshot R0-R19", told_snapshot, {0}, {3}),
    "apply": Job("snapshot apply zero.json --yes", told_apply, {0, 4}, {3, 6}),
    "loopback": Job("loopback --count 6", told_loopback, {0, 1}, {3}),
    "scan": Job("scan --stations 1-2", told_scan, {0, 1}, {3}),
}
PAIRS = [(name, kind) for name, kind in product(JOBS, FAULT_KINDS) if kind != POWER_CUT or name == "restore"]
SHARES = {BIT_ERRORS: "0.002", POWER_CUT: "1", "echo": "1"}


class Turn(NamedTuple):
    """A job with a fault over a medium."""

    name: str
    kind: str
    medium: str
    protocol: str
    seed: int


def take_turns() -> list[Turn]:
    """Each job with each fault over one medium, the next over the next; the protocols in turn too."""
    found = []
    for number, (name, kind) in enumerate(PAIRS):
        protocols = JOBS[name].protocols
        protocol = protocols[number // len(MEDIA) % len(protocols)]
        found.append(Turn(name, kind, MEDIA[number % len(MEDIA)], protocol, number))
    return found


def open_door(server: Server, medium: str, place: Path) -> str:
    if medium == "pty":
        return server.open_pty(str(place / "plc")).address
    return (server.open_tcp() if medium == "tcp" else server.open_udp()).address


@pytest.mark.parametrize("turn", take_turns(), ids=lambda turn: "-".join(turn[:4]))
def test_a_command_over_a_bad_line(turn: Turn, place: Path, cli: Cli) -> None:
    name, kind, medium, protocol, seed = turn
    job = JOBS[name]
    save_backup(backup(NEW), place / "new.json")
    zero = snapshot_of("R0-R19").document()
    (place / "zero.json").write_text(json.dumps(zero))
    simulation = build_simulation(
        protocol=protocol,
        ladder_words=WORDS,
        program=OLD.pages,
        faults=[f"{kind}={SHARES.get(kind, '0.3')}"],
        seed=seed,
        slow_s=SLOW_S,
    )
    device = simulation.plcs[1]
    device.battery_low = True
    device.write_words("R", 0, KEPT)
    server = Server(simulation)
    target = open_door(server, medium, place)
    with hurried(server):
        done = cli(*job.words.split(), "-p", target, "--protocol", protocol, "--json", *LINE)
    if done.code in job.results:
        job.look(done, device, place)
        return
    assert done.code in job.errors, done
    error = done.document("error")["error"]
    assert error["exit_code"] == done.code
    (headline,) = (line for line in done.err.splitlines() if line.startswith("fatektool: "))
    assert done.code == 6 or headline == done.err.splitlines()[-1]
    assert "Traceback" not in done.err
    assert not (place / "out.json").exists()
    if name == "restore" and done.code == 6:
        told = error["details"]
        proven = set(told["pages_written"]) - set(told["pages_unread"])
        assert all(device.pages[page] == NEW.pages[page] for page in proven)
        kept = set(told["pages_old"]) - set(told["pages_unread"])
        assert all(device.pages[page] == OLD.pages[page] for page in kept)
        assert load_backup(place / error["details"]["safety_backup"]).program == OLD
    else:
        assert tuple(device.pages) == OLD.pages
