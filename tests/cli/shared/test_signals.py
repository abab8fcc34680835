"""Ctrl-C, SIGTERM and SIGKILL in the middle of a backup and of a restore, while an answer is waited for."""

from __future__ import annotations

import json
import signal
from typing import TYPE_CHECKING

import pytest

from fatektool.program.archive import load_backup, save_backup
from tests.cli.running import check, one_line, process, served, started
from tests.held import HeldAnswer
from tests.program.samples import backup, program

if TYPE_CHECKING:
    from pathlib import Path

WORDS = 1200  # 20 pages
OLD, NEW = program(WORDS, seed=1), program(WORDS, seed=2)


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_backup_is_interrupted(place: Path, number: signal.Signals, *, as_json: bool) -> None:
    with served(OLD) as door:
        answer = HeldAnswer(door.simulation, "read_page", 10)
        command = started("backup", "x.json", "-p", door.target, *(["--json"] if as_json else []))
        with answer:
            command.send_signal(number)
        out, err = command.communicate()
    assert command.returncode == 130
    assert one_line(err) == "fatektool: interrupted"
    if as_json:
        check(json.loads(out), "error")
    else:
        assert out == ""
    assert list(place.iterdir()) == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_restore_is_interrupted_and_finished(place: Path, number: signal.Signals) -> None:
    save_backup(backup(NEW), place / "new.json")
    with served(OLD) as door:
        answer = HeldAnswer(door.simulation, "write_page", 10)
        words = ["restore", "new.json", "-p", door.target, "--yes", "--single-pass", "--json"]
        command = started(*words)
        with answer:
            command.send_signal(number)
        out, err = command.communicate()
        assert command.returncode == 6
        error = json.loads(out)
        check(error, "error")
        details = error["error"]["details"]
        assert details["cause"] == "interrupted"
        held = door.pages
        assert details["pages_written"][-1] >= 9
        assert all(held[page] == NEW.pages[page] for page in details["pages_written"])
        assert all(held[page] == OLD.pages[page] for page in details["pages_old"])
        assert len(details["pages_uncertain"]) <= 1
        assert details["command"] in err
        (safety,) = place.glob("new.safety-*")
        assert load_backup(safety).program == OLD

        again = details["command"].split()
        assert process(*again[again.index("restore") :]).code == 0
        assert door.pages == NEW.pages
        assert list(place.glob("new.safety-*")) == [safety]


def test_a_restore_is_killed_and_finished_by_the_same_command(place: Path) -> None:
    save_backup(backup(NEW), place / "new.json")
    with served(OLD) as door:
        answer = HeldAnswer(door.simulation, "write_page", 10)
        words = ["restore", "new.json", "-p", door.target, "--yes", "--changed-only", "--single-pass"]
        command = started(*words)
        with answer:
            command.kill()
            command.communicate()
        assert command.returncode == -signal.SIGKILL
        assert door.pages not in {OLD.pages, NEW.pages}
        (safety,) = place.glob("new.safety-*")
        assert load_backup(safety).program == OLD

        done = process(*words)
        assert done.code == 0
        assert f"Previous program saved in {safety.name}" in done.err
        assert door.pages == NEW.pages
    assert sorted(path.name for path in place.iterdir()) == ["new.json", safety.name]
