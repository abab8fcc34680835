"""``backup --data`` and ``inspect`` of what it wrote, by the command line."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fatektool.program.archive import load_backup
from tests.cli.running import served
from tests.jobs.data.filled import disabled_of, fill_at_random, values_of
from tests.plant import Plant

if TYPE_CHECKING:
    from tests.cli.running import Cli


def test_a_file_with_program_and_data(cli: Cli) -> None:
    with served() as door:
        device = door.simulation.plcs[1]
        fill_at_random(device, 4)
        done = cli("backup", "press.json", "--data", "-p", door.target)
        assert done.code == 0, done.err
        assert "data " in done.out
        found = load_backup(Path("press.json"))
        assert found.data is not None
        assert found.data.values == values_of(device)
        assert found.data.disabled == disabled_of(device)
        assert found.program.pages == door.pages


def test_documents(cli: Cli, tmp_path: Path) -> None:
    plant = Plant(tmp_path, cli)
    assert cli("discrete", "disable", "X3", "-p", plant.target).code == 0
    saved = plant.json("backup-result", "backup", "a.json", "--data", "-p", plant.target)
    shown = plant.json("inspect", "inspect", "a.json")
    assert saved["data"] == shown["data"]
    assert shown["data"]["disabled"] == {"X3": False}
    assert shown["data"]["counts"]["R"] == 8072
    plain = plant.json("backup-result", "backup", "b.json", "-p", plant.target)
    assert plain["data"] is None
    text = cli("inspect", "a.json").out
    assert "disabled     X3 off" in text
    assert shown["data"]["sha256"] in text
