"""A restore of program and data, killed at its steps: the same command completes it, its copy undoes it."""

from __future__ import annotations

import json
import signal
from itertools import count
from typing import TYPE_CHECKING

import pytest

from fatektool.jobs.programs.backup import backup
from fatektool.program.archive import load_backup, save_backup
from fatektool.simulator.plc import SimulatedPlc
from tests.cli.running import Door, served
from tests.jobs.data.filled import (
    IMAGE,
    OTHER_IMAGE,
    SMALL,
    disabled_of,
    fill_at_random,
    filled,
    values_of,
)
from tests.night import night

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.reliability.conftest import Mortals

KILLED = -signal.SIGKILL
WRITES = ("send 42", "send 45", "send 47", "send 49", "send 50")


@pytest.fixture
def door() -> Iterator[Door]:
    with served(OTHER_IMAGE) as found:
        yield found


def fresh(door: Door) -> SimulatedPlc:
    """The spare as it was before the first restore."""
    device = SimulatedPlc(1, SMALL, pages=list(OTHER_IMAGE.pages))
    fill_at_random(device, 2)
    door.simulation.plcs[1] = device
    return device


def holdings(device: SimulatedPlc) -> object:
    return tuple(device.pages), values_of(device), disabled_of(device)


@pytest.mark.parametrize("stride", [29, night(1)])
def test_killed_the_same_command_completes_it(
    door: Door, place: Path, mortals: Mortals, state_folder: Path, stride: int
) -> None:
    plant = filled(1, IMAGE)
    wanted = backup(plant.plc, data=True)
    save_backup(wanted, place / "press.json")
    words = ["restore", "press.json", "--data", "--yes", "--json", "-p", door.target]
    before, after = holdings(fresh(door)), holdings(plant.device)
    halves = 0
    for at in count(1, stride):
        for path in (*place.glob("*safety*"), *place.glob(".fatektool-*"), *state_folder.glob("*.json")):
            path.unlink()
        device = fresh(door)
        life = mortals(*words, folder=place, at=at)
        if life.code == 0:
            break
        assert (life.code, life.out) == (KILLED, ""), life.steps
        held = holdings(device)
        copies = sorted(place.glob("press.safety-*"))
        for copy in copies:
            saved = load_backup(copy)
            assert saved.data is not None
            assert (saved.program.pages, saved.data.values, saved.data.disabled) == before
        sent = any(step in WRITES for step in life.steps)
        assert sent or held == before
        if sent:
            assert len(copies) == 1
            records = [json.loads(path.read_text()) for path in state_folder.glob("*.json")]
            assert records or held == after, life.steps
            assert all("--data" in record["command"] for record in records)
        half = held not in (before, after)
        halves += half

        again = mortals(*words, folder=place)
        assert again.code == 0, again.err
        assert holdings(device) == after
        assert not list(state_folder.glob("*.json"))
        if half:
            assert again.document("restore")["safety_backup"] == copies[0].name
            back = ("restore", copies[0].name, "--data", "--yes", "-p", door.target)
            assert mortals(*back, folder=place).code == 0
            assert holdings(device) == before
    assert halves
