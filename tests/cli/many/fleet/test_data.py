"""``fleet backup --data``: files and a history with data; only what ought to be constant is a change."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from fatektool.program.archive import load_backup
from tests.cli.running import check
from tests.plant import Plant

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli, Done

INVENTORY = """
[plc.press]
target = "sim:press.state"
{keep}
"""


class Fleet:
    """One PLC with an inventory, backups and a history."""

    def __init__(self, folder: Path, cli: Cli, keep: str = "") -> None:
        self.plant = Plant(folder, cli, "press.state")
        self.file = folder / "fatek.toml"
        self.file.write_text(INVENTORY.format(keep=keep), encoding="utf-8")
        self.cli = cli

    def backup(self, *words: str) -> Done:
        where = ("--inventory", self.file, "--dir", "backups", "--history", "history")
        return self.cli("fleet", "backup", *where, *words)

    def changed(self) -> bool | None:
        """Whether a backup with data is a change; None for the first."""
        done = self.backup("--data", "--json")
        assert done.code == 0, done.err
        document: Any = done.document("fleet")
        found: bool | None = document["plcs"][0]["changed"]
        return found

    def commits(self) -> list[str]:
        done = self.cli("history", "log", "--history", "history", "--json")
        return [change["subject"] for change in done.document("history-log")["changes"]]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_what_runs_makes_no_commit(folder: Path, cli: Cli) -> None:
    fleet = Fleet(folder, cli)
    target = ("-p", fleet.plant.target)
    assert fleet.changed() is None
    fleet.plant.write("R3000=7", "M5=1", "RT3=9", *target)
    assert fleet.changed() is False
    fleet.plant.write("R12=714", "M800=1", *target)
    assert fleet.changed() is True
    assert cli("discrete", "disable", "X3", *target).code == 0
    assert fleet.changed() is True
    assert fleet.commits() == [
        "press: 1 disabled discrete changed",
        "press: 2 values changed",
        "press: first backup",
    ]
    saved = load_backup(folder / "backups" / "press.json")
    assert saved.data is not None
    assert saved.data.values["R"][12] == 714
    assert saved.data.values["R"][3000] == 7  # the file is whole all the same
    shown = cli("history", "diff", "press", "--history", "history")
    assert shown.code == 1
    assert "X3  enabled -> disabled off" in shown.out


def test_a_list_of_what_to_keep(folder: Path, cli: Cli) -> None:
    fleet = Fleet(folder, cli, 'keep = ["R3???", "M5"]')
    target = ("-p", fleet.plant.target)
    assert fleet.changed() is None
    fleet.plant.write("R12=714", "D9=1", *target)
    assert fleet.changed() is False
    fleet.plant.write("M5=1", *target)
    assert fleet.changed() is True
    listed = cli("inventory", "list", "--inventory", fleet.file, "--json").document("inventory")
    assert listed["plcs"][0]["keep"] == ["R3???", "M5"]


def test_verify_by_name_compares_what_is_kept(folder: Path, cli: Cli) -> None:
    fleet = Fleet(folder, cli, 'keep = "R3???"')
    assert fleet.changed() is None
    fleet.plant.write("R12=714", "-p", fleet.plant.target)
    verify = ("verify", "backups/press.json", "--data", "--inventory", fleet.file, "-p", "press")
    assert cli(*verify).code == 0
    fleet.plant.write("R3001=1", "-p", fleet.plant.target)
    assert cli(*verify).code == 1


def test_data_are_not_lost_by_a_backup_without(folder: Path, cli: Cli) -> None:
    fleet = Fleet(folder, cli)
    assert fleet.changed() is None
    before = (folder / "backups" / "press.json").read_bytes()
    done = fleet.backup()
    assert done.code != 0
    assert "is not replaced by the program alone" in done.err + done.out
    assert (folder / "backups" / "press.json").read_bytes() == before


def test_data_for_the_first_time(folder: Path, cli: Cli) -> None:
    fleet = Fleet(folder, cli)
    assert fleet.backup().code == 0
    assert fleet.changed() is True
    assert fleet.commits()[0] == "press: data saved for the first time"
    document = cli("history", "show", "press", "--history", "history", "--json").document("history-show")
    check(document, "history-show")
    assert document["data"]["counts"]["R"] == 8072
