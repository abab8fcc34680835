"""``restore --data`` by the command line: what it shows, asks, says and writes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import fatektool
from fatektool.cli.shared.unfinished import unfinished
from fatektool.jobs.programs.backup import backup
from fatektool.program.archive import load_backup, save_backup
from fatektool.program.data.uses import Use
from fatektool.simulator.build import build_simulation
from tests.jobs.data.filled import disabled_of, fill_some, values_of
from tests.plant import Plant, copied, cut_in_write, error_of

if TYPE_CHECKING:
    from tests.cli.running import Cli

WRITTEN = (Use.KEPT, Use.WORKING)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two PLCs of different contents, and ``press.json`` of the first; made once."""
    folder = tmp_path_factory.mktemp("made")
    for seed, name in ((1, "press.state"), (2, "spare.state")):
        simulation = build_simulation(ladder_words=64, state=folder / name)
        fill_some(simulation.plcs[1], seed)
        simulation.save_if_changed()
    with fatektool.connect(f"sim:{folder / 'press.state'}") as plc:
        save_backup(backup(plc, data=True), folder / "press.json")
    return folder


@pytest.fixture
def plants(made: Path, place: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> tuple[Plant, Plant]:
    """Copies of them."""
    monkeypatch.setenv("FATEKTOOL_STATE_DIR", str(place.parent / "records"))
    copied(made, place)
    return Plant(place, cli, "press.state"), Plant(place, cli, "spare.state")


def restore(plant: Plant, *words: str) -> list[object]:
    return ["restore", "press.json", "-p", plant.target, *words]


def same_data(one: Plant, other: Plant, *uses: Use) -> bool:
    a, b = one.device, other.device
    return values_of(a, *uses) == values_of(b, *uses) and disabled_of(a) == disabled_of(b)


def test_one_plc_into_another(plants: tuple[Plant, Plant], cli: Cli) -> None:
    press, spare = plants
    done = cli(*restore(spare, "--data", "--yes", "--run"))
    assert done.code == 0, done.err
    assert same_data(press, spare, *WRITTEN)
    assert "press.json is from station 1 on" in done.err
    assert "Previous program and data saved in press.safety-" in done.err
    assert "the PLC is in RUN" in done.out
    again = cli(*restore(spare, "--data", "--yes", "--stop"))
    assert again.out.startswith("same: the PLC's program and data are those in press.json already")


def test_a_dry_run_says_what_would_change(plants: tuple[Plant, Plant], cli: Cli) -> None:
    _, spare = plants
    before = spare.state.read_bytes()
    document = spare.json("restore", *restore(spare, "--data", "--dry-run"))
    assert spare.state.read_bytes() == before
    data = document["data"]
    assert data["values_to_write"] > 40
    assert data["settings"] == {}
    assert set(data["not_written"]) == {"input", "output", "clock", "status", "setting"}
    assert data["not_written"]["clock"][0] == "R4128"
    assert (document["pages_written"], data["not_taken"]) == (0, {})
    shown = cli(*restore(spare, "--data", "--dry-run")).out
    for line in (
        "The PLC's program is that of FILE already.",
        "Will be disabled and held: X",
        "time   about",
    ):
        assert line in shown
    assert "(--system writes them)" in shown
    assert "Not written, inputs: R3840" in shown


def test_settings_are_listed_by_name(plants: tuple[Plant, Plant], cli: Cli) -> None:
    press, spare = plants
    shown = cli(*restore(spare, "--data", "--system", "--dry-run")).out
    before, after = spare.register(4146), press.register(4146)
    assert f"Setting R4146: {before:04X} -> {after:04X}" in shown
    document = spare.json("restore", *restore(spare, "--data", "--system", "--yes"))
    assert document["data"]["settings"]["R4146"] == {"before": f"{before:04X}", "after": f"{after:04X}"}
    assert same_data(press, spare, *WRITTEN, Use.SETTING)


def test_the_program_alone_says_that_data_are_left_alone(plants: tuple[Plant, Plant], cli: Cli) -> None:
    _, spare = plants
    simulation = build_simulation(state=spare.state)
    simulation.plcs[1].pages[1] = bytes(128)
    simulation.plcs[1].memory.revision += 1
    simulation.save_if_changed()
    before = values_of(spare.device)
    done = cli(*restore(spare, "--yes"))
    assert done.code == 0, done.err
    assert "FILE has data too. They are not written without --data: the PLC keeps its own." in done.err
    assert values_of(spare.device) == before
    assert spare.json("restore", *restore(spare, "--yes"))["data"] is None


def test_options_that_do_not_go_together(plants: tuple[Plant, Plant], cli: Cli) -> None:
    _, spare = plants
    assert "--data" in error_of(cli(*restore(spare, "--system", "--yes")), 2)
    assert cli("backup", "plain.json", "-p", spare.target).code == 0
    done = cli("restore", "plain.json", "--data", "--yes", "-p", "tcp://127.0.0.1:1")
    assert "the file has no data" in error_of(done, 2)


def test_what_may_move_at_once_is_warned_of(plants: tuple[Plant, Plant], cli: Cli) -> None:
    press, spare = plants
    simulation = build_simulation(state=press.state)
    device = simulation.plcs[1]
    device.running = True
    device.memory.disabled["Y"][7] = device.memory.status["Y"][7] = 1
    device.memory.revision += 1
    simulation.save_if_changed()
    assert cli("backup", "press.json", "--force", "--data", "-p", press.target).code == 0
    done = cli(*restore(spare, "--data", "--dry-run"))
    assert "Y7 will be disabled and held on, as in FILE: the output may switch on at once" in done.err
    assert "The data of FILE were read in RUN: its values are not all of one moment." in done.out


def test_nobody_to_ask(plants: tuple[Plant, Plant], cli: Cli) -> None:
    _, spare = plants
    before = spare.state.read_bytes()
    done = cli(*restore(spare, "--data"))
    assert done.code == 2
    assert done.err.endswith("nothing was written; add --yes\n")
    assert spare.state.read_bytes() == before


def test_cut_and_finished_by_the_same_command(
    plants: tuple[Plant, Plant], cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    press, spare = plants
    with monkeypatch.context() as cut:
        cut_in_write(cut, 1)
        done = cli(*restore(spare, "--data", "--yes"))
    assert done.code == 6
    assert "previous program and data" in done.err
    assert "fatektool restore" in done.err
    (copy,) = Path().glob("press.safety-*")
    original = load_backup(copy)
    (record,) = unfinished(spare.target, 1)
    assert record.safety_backup == str(copy.absolute())
    assert "--data" in record.command

    # a restore of the program alone, and a program that is whole, are not the end of it
    assert cli(*restore(spare, "--yes")).code == 0
    assert cli("verify", "press.json", "-p", spare.target).code == 0
    assert len(unfinished(spare.target, 1)) == 1
    status: Any = spare.json("status", "status", "-p", spare.target)
    assert status["unfinished_restore"]["command"] == record.command

    done = cli(*restore(spare, "--data", "--yes"))
    assert done.code == 0, done.err
    assert same_data(press, spare, *WRITTEN)
    assert [*Path().glob("press.safety-*")] == [copy]
    assert load_backup(copy) == original
    assert unfinished(spare.target, 1) == []


def test_the_safety_copy_is_the_way_back(plants: tuple[Plant, Plant], cli: Cli) -> None:
    _, spare = plants
    values, disabled = values_of(spare.device), disabled_of(spare.device)
    document = spare.json("restore", *restore(spare, "--data", "--yes", "--system"))
    copy = document["safety_backup"]
    assert cli("restore", copy, "--data", "--system", "--yes", "-p", spare.target).code == 0
    for symbol, held in values_of(spare.device, *WRITTEN, Use.SETTING).items():
        assert all(now in {-1, before} for now, before in zip(held, values[symbol], strict=True))
    assert disabled_of(spare.device) == disabled
