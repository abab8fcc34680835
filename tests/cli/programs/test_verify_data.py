"""``verify --data`` and ``diff`` with data: what ought to be constant is compared, what runs is shown."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import fatektool
from fatektool.jobs.programs.backup import backup
from fatektool.program.archive import save_backup
from fatektool.simulator.build import build_simulation
from tests.plant import Plant, copied, error_of

if TYPE_CHECKING:
    from tests.cli.running import Cli


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A PLC that holds what ``press.json`` has; made once."""
    folder = tmp_path_factory.mktemp("made")
    state = folder / "plc.state"
    build_simulation(ladder_words=64, state=state)
    with fatektool.connect(f"sim:{state}") as plc:
        plc.disable("X3")
        save_backup(backup(plc, data=True), folder / "press.json")
    return folder


@pytest.fixture
def plant(made: Path, place: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> Plant:
    """A copy of it."""
    monkeypatch.setenv("FATEKTOOL_STATE_DIR", str(place.parent / "records"))
    copied(made, place)
    return Plant(place, cli)


def test_the_same(plant: Plant, cli: Cli) -> None:
    done = cli("verify", "press.json", "--data", "-p", plant.target)
    assert (done.code, "data same" in done.out) == (0, True)
    document = plant.json("verify", "verify", "press.json", "--data", "-p", plant.target)
    assert document["data"] == {"same": True, "constant": [], "disabled": [], "running": []}
    assert "data" not in plant.json("verify", "verify", "press.json", "-p", plant.target)


def test_what_runs_is_shown_and_is_no_difference(plant: Plant, cli: Cli) -> None:
    plant.write("R3000=7", "M5=1", "RT3=9", "-p", plant.target)
    done = cli("verify", "press.json", "--data", "-p", plant.target)
    assert done.code == 0
    assert "not compared, as they change by themselves: 3 values, M5, R3000, RT3" in done.out


def test_a_setting_a_kept_value_and_a_forced_discrete(plant: Plant, cli: Cli) -> None:
    plant.write("R4146=0x5621", "R12=714", "-p", plant.target)
    assert cli("discrete", "enable", "X3", "-p", plant.target).code == 0
    assert cli("discrete", "disable", "Y1", "-p", plant.target).code == 0
    done = cli("verify", "press.json", "--data", "-p", plant.target)
    assert done.code == 1
    for line in (
        "data differ: 2 values and 2 disabled discretes (press.json -> PLC)",
        "  R12  0 -> 714",
        "  R4146  0000 -> 5621",
        "  X3  disabled off -> enabled",
        "  Y1  enabled -> disabled off",
    ):
        assert line in done.out.splitlines()
    document = plant.json("verify", "verify", "press.json", "--data", "-p", plant.target, code=1)
    assert document["same"] is False
    assert document["pages_differ"] == 0
    assert document["data"]["constant"][0] == {"element": "R12", "a": "0000", "b": "02CA"}


def test_values_can_be_left_out(plant: Plant, cli: Cli) -> None:
    plant.write("D100=7", "-p", plant.target)
    assert cli("verify", "press.json", "--data", "-p", plant.target).code == 1
    assert cli("verify", "press.json", "--data", "--ignore", "D1??", "-p", plant.target).code == 0
    assert "--data" in error_of(cli("verify", "press.json", "--ignore", "D1", "-p", plant.target), 2)


def test_a_file_without_data(plant: Plant, cli: Cli) -> None:
    assert cli("backup", "plain.json", "-p", plant.target).code == 0
    done = cli("verify", "plain.json", "--data", "-p", "tcp://127.0.0.1:1")
    assert "plain.json has no data" in error_of(done, 2)
    one_has = cli("diff", "press.json", "plain.json")
    assert one_has.code == 0
    assert "only press.json has data" in one_has.err


def test_two_files(plant: Plant, cli: Cli) -> None:
    plant.write("R12=714", "R3000=7", "-p", plant.target)
    assert cli("backup", "later.json", "--data", "-p", plant.target).code == 0
    done = cli("diff", "press.json", "later.json")
    assert done.code == 1
    assert "data differ: 1 value (press.json -> later.json)" in done.out
    document = plant.json("diff", "diff", "press.json", "later.json", code=1)
    assert document["same"] is False
    assert document["data"]["running"] == ["R3000"]
    assert cli("diff", "press.json", "later.json", "--ignore", "R12").code == 0


def test_what_moved_when_it_was_saved_is_not_compared(plant: Plant, cli: Cli) -> None:
    document = json.loads(Path("press.json").read_text(encoding="utf-8"))
    document["data"]["moving"] = ["R12"]
    Path("press.json").write_text(json.dumps(document), encoding="utf-8")
    plant.write("R12=714", "-p", plant.target)
    assert cli("verify", "press.json", "--data", "-p", plant.target).code == 0
