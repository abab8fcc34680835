"""A write of values, killed at every step: the same command completes it, its safety snapshot undoes it."""

from __future__ import annotations

import signal
from itertools import count
from typing import TYPE_CHECKING

import pytest

from fatektool.jobs.snapshots.formats import as_json
from fatektool.jobs.snapshots.snapshot import load_snapshot, raw_of
from tests.cli.running import Door, served
from tests.plant import snapshot_of
from tests.program.samples import program
from tests.rigs import simulated

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.reliability.conftest import Mortals

KILLED = -signal.SIGKILL
COUNT = 100
BEFORE, AFTER = [2] * COUNT, [0] * COUNT
WRITES = ("send 45", "send 47", "send 49")


@pytest.fixture
def door() -> Iterator[Door]:
    with served(program(256)) as found:
        yield found


def test_values_killed_at_any_step(door: Door, place: Path, mortals: Mortals, state_folder: Path) -> None:
    """The record is on disk before the first write, and the safety snapshot before the record."""
    (place / "a.json").write_text(as_json(snapshot_of(f"R0-R{COUNT - 1}", plc=simulated(ladder_words=64))))
    words = ["snapshot", "apply", "a.json", "--yes", "--json", "-p", door.target]
    device = door.simulation.plcs[1]
    died: set[str] = set()
    halves = 0
    for at in count(1):
        for path in (*place.glob("*safety*"), *place.glob(".fatektool-*"), *state_folder.glob("*.json")):
            path.unlink()
        device.write_words("R", 0, BEFORE)
        life = mortals(*words, folder=place, at=at)
        if life.code == 0:
            break
        assert (life.code, life.out) == (KILLED, ""), life.steps
        died.add(life.steps[-1].split()[0])
        held = list(device.read_words("R", 0, COUNT))
        copies = sorted(place.glob("a.safety-*"))
        for copy in copies:
            assert [raw for _, raw in raw_of(load_snapshot(copy)).values()] == BEFORE
        sent = any(step in WRITES for step in life.steps)
        assert sent or held == BEFORE
        if sent:
            assert len(copies) == 1
            assert list(state_folder.glob("*.json")) or held == AFTER, life.steps
        half = held not in (BEFORE, AFTER)
        halves += half

        again = mortals(*words, folder=place)
        assert again.code == 0, again.err
        assert device.read_words("R", 0, COUNT) == AFTER
        assert not list(state_folder.glob("*.json"))
        if held != AFTER and sent:
            assert again.document("apply")["safety_snapshot"] == str(copies[0])
        if half:
            undone = mortals("snapshot", "apply", copies[0].name, "--yes", "-p", door.target, folder=place)
            assert undone.code == 0
            assert device.read_words("R", 0, COUNT) == BEFORE
    assert {"open", "write", "half", "fsync", "link", "send", "answered"} <= died
    assert halves
