"""docs/recovery.md: each command of the page is given on a terminal, and prints what the page says."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import NamedTuple

import pytest

from fatektool.program.data.uses import Use
from fatektool.simulator.build import build_simulation
from tests.cli.running import Cli
from tests.cli.terminal import Terminal
from tests.jobs.data.filled import disabled_of, fill_some, values_of
from tests.plant import Plant, cut_in_write
from tests.root import DOCS

PAGE = (DOCS / "recovery.md").read_text(encoding="utf-8")
_STEP = re.compile(r"^## `(fatektool [^`]*)`\n\n```text\n(.*?)```", re.MULTILINE | re.DOTALL)
_COMMAND = re.compile(r"`(fatektool [^`]*)`")
PORT = "/dev/ttyUSB0"


class Step(NamedTuple):
    """A command of the page, and lines that it prints."""

    command: str
    lines: list[str]


STEPS = [Step(command, text.splitlines()) for command, text in _STEP.findall(PAGE)]


def test_each_command_is_a_step_with_what_it_prints() -> None:
    inline = {"fatektool doctor -p /dev/ttyUSB0"}
    assert {*_COMMAND.findall(PAGE)} == {step.command for step in STEPS} | inline
    assert len(STEPS) == 8
    assert all(step.lines for step in STEPS)


@pytest.fixture
def plants(tmp_path: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> tuple[Plant, Plant]:
    """The press, and a spare of other contents."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("FATEKTOOL_STATE_DIR", str(tmp_path / "records"))
    monkeypatch.setenv("FATEKTOOL_LOCK_DIR", str(tmp_path))
    made = []
    for seed, name in ((1, "press.state"), (2, "spare.state")):
        plant = Plant(tmp_path, cli, name)
        plant.state.unlink()
        simulation = build_simulation(ladder_words=400, program_seed=seed, state=plant.state)
        device = simulation.plcs[1]
        fill_some(device, seed)
        for at in range(3968, 4168):  # settings are alike, as in two PLCs of one factory
            device.memory.registers["R"][at] = 0
        for at in (1956, 1958, 1959, 1967):
            device.memory.status["M"][at] = 0
            device.memory.disabled["M"][at] = 0
        simulation.save_if_changed()
        made.append(plant)
    return made[0], made[1]


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str]) -> Cli:
    return Cli(capsys)


def give(step: Step, target: str) -> None:
    """Give a command on a terminal, answer its question, and hold what it prints against the page."""
    words = [word.replace(PORT, target) for word in shlex.split(step.command)[1:]]
    if any("…" in word for word in words):
        (copy,) = Path().glob("press.safety-*")
        words = [copy.name if "…" in word else word for word in words]
    with Terminal(*words, columns=200) as terminal:
        if words[0] == "run" or (words[0] == "restore" and "--dry-run" not in words):
            terminal.read_until("? [y/N]: ")
            terminal.type("y\n")
        assert terminal.end() == 0, terminal.text
    for line in step.lines:
        assert line.replace(PORT, target) in terminal.text, (step.command, line)


def holds_the_same(one: Plant, other: Plant) -> bool:
    a, b = one.device, other.device
    kept = (Use.KEPT, Use.WORKING)
    return (
        a.pages == b.pages and values_of(a, *kept) == values_of(b, *kept) and disabled_of(a) == disabled_of(b)
    )


def test_the_page_from_top_to_bottom(
    plants: tuple[Plant, Plant], cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    press, spare = plants
    backup, status, inspect, dry_run, restore, verify, run, back = STEPS
    before = spare.device
    give(backup, press.target)
    for step in (status, inspect, dry_run):
        give(step, spare.target)
    assert not holds_the_same(press, spare)
    with monkeypatch.context() as cut:  # "if anything interrupts it"
        cut_in_write(cut, 1)
        assert cli(*shlex.split(restore.command.replace(PORT, spare.target))[1:], "--yes").code == 6
    assert not holds_the_same(press, spare)
    give(restore, spare.target)
    assert holds_the_same(press, spare)
    give(verify, spare.target)
    give(run, spare.target)
    assert spare.device.running
    give(back, spare.target)
    after = spare.device
    assert after.pages == before.pages
    assert values_of(after, Use.KEPT, Use.WORKING) == values_of(before, Use.KEPT, Use.WORKING)
    assert disabled_of(after) == disabled_of(before)
