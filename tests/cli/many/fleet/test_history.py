"""``fleet backup --history``: a commit for each change, and a copy elsewhere."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from dulwich.repo import Repo

from tests.cli.many.fleet.gateway import plcs_of
from tests.cli.running import NEW
from tests.program.samples import changed

if TYPE_CHECKING:
    from tests.cli.many.fleet.gateway import Hall
    from tests.cli.running import Cli


def test_a_commit_for_each_change(cli: Cli, plant: Hall) -> None:
    first = plcs_of(cli("fleet", "backup", "--history", "hist", "--json").document("fleet"))
    assert [plc["changed"] for plc in first.values()] == [None, None, None]
    assert first["press"]["file"] == "hist"
    plant.pump.pages = [*changed(NEW, 3).pages]
    done = cli("fleet", "backup", "--history", "hist", "--dir", "backups")
    assert done.code == 0
    assert "pump   done      CHANGED, FB30, 400 words" in done.out
    assert "press  done      unchanged, FB30, 400 words" in done.out  # though the file is new
    assert Path("backups/pump.json").exists()
    entries = cli("history", "log", "--history", "hist", "--json").document("history-log")["changes"]
    assert len(entries) == 4


def test_push(cli: Cli, plant: Hall) -> None:
    assert plant.targets
    words = ["fleet", "backup", "--history", "hist", "--push", "copy.git"]
    done = cli(*words, "--json")
    assert done.code == 1  # nobody made it
    assert "warning: the history is not pushed: " in done.err
    assert done.document("fleet")["push"]["error"]
    Repo.init_bare("copy.git", mkdir=True).close()
    for sent in (True, False):  # the second time nothing is new
        done = cli(*words, "--json")
        assert (done.code, done.err.count("warning")) == (0, 0)
        assert done.document("fleet")["push"]["sent"] is sent
    assert (
        cli("history", "log", "--history", "copy.git").out == cli("history", "log", "--history", "hist").out
    )


def test_a_push_needs_a_history(cli: Cli, plant: Hall) -> None:
    assert plant.targets
    assert cli("fleet", "backup", "--dir", "backups", "--push", "copy.git").code == 2
