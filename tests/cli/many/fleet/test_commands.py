"""``fleet status``, ``backup``, ``verify``, ``snapshot``: lines, documents, files, exit codes."""

from __future__ import annotations

import itertools
import json
import os
import re
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.jobs.fleet import rounds
from fatektool.program.archive import load_backup, save_backup
from fatektool.transport.limit import Limit
from tests.cli.many.fleet.gateway import deaf_door, plcs_of, saved
from tests.cli.running import NEW, OLD, check
from tests.program.samples import backup, changed, header, program

if TYPE_CHECKING:
    from tests.cli.many.fleet.gateway import Hall
    from tests.cli.running import Cli

REFERENCE = 'reference = "{}.json"\n'


def states(out: str) -> dict[str, str]:
    """Name and state of each line, whatever their order."""
    return {line.split()[0]: line.split()[1] for line in out.splitlines()}


# --- status ------------------------------------------------------------------------------------------------


def test_status(cli: Cli, plant: Hall) -> None:
    plant.press.running = plant.pump.battery_low = True
    done = cli("fleet", "status")
    assert done.code == 0
    assert sorted(done.out.splitlines()) == [
        "oven   done      STOP",
        "press  done      RUN",
        "pump   done      STOP, battery LOW",
    ]
    assert re.fullmatch(r"status: 3 of 3 done, \d\.\d s, slowest \w+ \d\.\d s\n", done.err)


def test_a_document_has_each_plc_s_own(cli: Cli, plant: Hall) -> None:
    with deaf_door() as target:
        plant.write(deaf=f'target = "{target}"\ntimeout_s = 0.05\n', nobody='target = "tcp://127.0.0.1:1"\n')
        done = cli("fleet", "status", "--json", "--select", "p*", "--select", "nobody", "--select", "deaf")
    assert done.code == 1
    document = done.document("fleet")
    assert (document["job"], document["inventory"], document["interrupted"]) == (
        "status",
        "fatek.toml",
        False,
    )
    assert document["summary"] == {"total": 4, "ok": 2, "failed": 2, "changed": 0, "not_done": 0}
    assert [plc["name"] for plc in document["plcs"]] == ["press", "pump", "deaf", "nobody"]
    assert {each["name"] for each in document["slowest"]} == {"press", "pump", "deaf", "nobody"}
    assert document["slowest"][0]["name"] == "deaf"
    found = plcs_of(document)
    assert [found[name]["exit_code"] for name in ("press", "pump", "deaf", "nobody")] == [0, 0, 3, 3]
    for name in ("press", "pump"):
        check(found[name]["document"], "status")
        assert found[name]["document"]["target"] == found[name]["target"]
    for name in ("deaf", "nobody"):
        check(found[name]["document"], "error")
        assert found[name]["document"]["error"]["exit_code"] == 3


@pytest.mark.parametrize("words", ["--select x", "--jobs 0", "--deadline 0", "--deadline nan", "--nope"])
def test_a_wrong_order(cli: Cli, plant: Hall, words: str) -> None:
    assert plant.targets
    assert cli("fleet", "status", *words.split()).code == 2


def test_a_plc_that_hangs_is_given_up(cli: Cli, plant: Hall, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a clock of its own for each PLC, which counts how often it is looked at: each look takes 50 ms."""
    made = lambda *limit: Limit(*limit, clock=partial(next, itertools.count(step=0.05)))  # noqa: E731
    monkeypatch.setattr(rounds, "Limit", made)
    with deaf_door() as target:
        plant.write(
            deaf=f'target = "{target}"\ntimeout_s = 0.01\nretries = 1000\n',
            behind=f'target = "{target}"\ntimeout_s = 0.01\nstation = 2\n',
        )
        done = cli("fleet", "status", "--deadline", "2", "--json")
    found = plcs_of(done.document("fleet"))
    assert done.code == 1
    assert [plc["exit_code"] for plc in found.values()] == [0, 0, 0, 3, 3]
    told = found["deaf"]["document"]["error"]
    assert told["kind"] == "deadline_passed"
    assert told["message"].startswith("stopped at the time limit of 2 s")
    behind = found["behind"]["document"]["error"]["kind"]  # asked after it, with a limit of its own
    assert behind in {"no_answer", "deadline_passed"}  # whichever of its two limits is noticed first


# --- backup ------------------------------------------------------------------------------------------------


def test_backup(cli: Cli, plant: Hall) -> None:
    done = cli("fleet", "backup", "--dir", "backups")
    assert done.code == 0
    assert sorted(done.out.splitlines()) == [
        f"{name:<5}  done      first backup, FB30, 400 words" for name in ("oven", "press", "pump")
    ]
    assert load_backup(Path("backups/press.json")).program == OLD
    assert load_backup(Path("backups/pump.json")).program == NEW
    assert load_backup(Path("backups/pump.json")).source.station == 2
    plant.oven.pages = [*changed(NEW, 3).pages]
    found = plcs_of(cli("fleet", "backup", "--dir", "backups", "--json", "--single-pass").document("fleet"))
    assert [plc["changed"] for plc in found.values()] == [False, True, False]
    for plc in found.values():
        check(plc["document"], "backup-result")
        assert plc["document"]["file"] == plc["file"] == os.path.join("backups", f"{plc['name']}.json")  # noqa: PTH118
        assert plc["document"]["passes"] == 1
    assert load_backup(Path("backups/oven.json")).program == changed(NEW, 3)
    assert sorted(path.name for path in Path("backups").iterdir()) == ["oven.json", "press.json", "pump.json"]


@pytest.mark.parametrize("byte", [0x00, 0xFF])
def test_a_backup_that_lost_its_program_is_a_failure(cli: Cli, plant: Hall, byte: int) -> None:
    cli("fleet", "backup", "--dir", "backups")
    before = Path("backups/press.json").read_bytes()
    plant.press.pages[1:] = [bytes([byte]) * 128] * 7
    done = cli("fleet", "backup", "--dir", "backups")
    assert done.code == 1
    line = next(line for line in done.out.splitlines() if line.startswith("press"))
    assert f"FAILED    invalid data: the program is empty: every byte of its ladder is {byte:02X}" in line
    assert Path("backups/press.json").read_bytes() == before


def test_a_plc_that_keeps_its_program_is_a_failure(cli: Cli, plant: Hall) -> None:
    plant.press.program_commands = False
    done = cli("fleet", "backup", "--dir", "backups")
    assert (done.code, states(done.out)["press"]) == (1, "FAILED")
    assert not Path("backups/press.json").exists()


def test_a_header_that_does_not_hold(cli: Cli, plant: Hall) -> None:
    plant.press.pages[0] = header(400, b"XB30")
    assert cli("fleet", "backup", "--dir", "backups", "--select", "press").code == 1
    done = cli("fleet", "backup", "--dir", "backups", "--select", "press", "--any-header")
    assert done.code == 0
    assert "warning: press: invalid header of the program: byte 0: expected F (46), got X (58)" in done.err


def test_what_lies_in_the_place(cli: Cli, plant: Hall) -> None:
    """A damaged backup is replaced by a good one; another kind of file is kept."""
    assert plant.targets
    good = backup(OLD).to_bytes()
    Path("backups/press.json").write_bytes(good[:-200])
    Path("backups/oven.json").write_text("my notes")
    Path("backups/pump.json").touch()
    done = cli("fleet", "backup", "--dir", "backups")
    assert states(done.out) == {"press": "done", "oven": "FAILED", "pump": "done"}
    assert "oven.json is not a backup and is not replaced; name another folder" in done.out
    assert Path("backups/oven.json").read_text() == "my notes"
    assert load_backup(Path("backups/press.json")).program == OLD
    assert "press.json: not a backup file" in done.err
    assert "the file is replaced" in done.err


@pytest.mark.parametrize("words", ["", "--dir fatek.toml"])
def test_backup_needs_a_folder(cli: Cli, plant: Hall, words: str) -> None:
    assert plant.targets
    done = cli("fleet", "backup", *words.split())
    assert (done.code, done.out) == (2, "")


# --- verify ------------------------------------------------------------------------------------------------


def test_verify(cli: Cli, plant: Hall) -> None:
    save_backup(backup(OLD), Path("press.json"))
    save_backup(backup(changed(NEW, 3, 5)), Path("oven.json"))
    Path("pump.json").write_text("{}")
    plant.write(**{name: REFERENCE.format(name) for name in ("press", "oven", "pump")})
    done = cli("fleet", "verify")
    assert done.code == 1
    assert states(done.out) == {"press": "same", "oven": "differs", "pump": "FAILED"}
    assert "DIFFERS from oven.json: 2 words in 2 pages" in done.out
    document = cli("fleet", "verify", "--json").document("fleet")
    assert document["summary"] == {"total": 3, "ok": 1, "failed": 2, "changed": 1, "not_done": 0}
    found = plcs_of(document)
    assert [plc["exit_code"] for plc in found.values()] == [0, 1, 5]
    check(found["press"]["document"], "verify")
    assert found["oven"]["document"]["pages_differ"] == 2


def test_verify_without_a_reference(cli: Cli, plant: Hall) -> None:
    save_backup(backup(program(500)), Path("press.json"))
    plant.write(press=REFERENCE.format("press"))
    found = plcs_of(cli("fleet", "verify", "--json").document("fleet"))
    assert [plc["exit_code"] for plc in found.values()] == [1, 2, 2]
    assert "ladder size 500 words, and 400" in found["press"]["words"]
    assert found["oven"]["document"]["error"]["hint"] == 'add reference = "FILE" there'


# --- snapshot ----------------------------------------------------------------------------------------------


def test_snapshot(cli: Cli, plant: Hall) -> None:
    Path("snaps").mkdir()
    Path("spec.toml").write_text('[[item]]\nelement = "R0-R9"\n')
    Path("bad.toml").write_text('[[item]]\nelement = "R60000"\n')
    plant.write(press='spec = "spec.toml"\n', oven='spec = "bad.toml"\n')
    words = ["fleet", "snapshot", "--dir", "snaps", "--keep", "2", "--json"]
    for _ in range(2):
        cli(*words)
    found = plcs_of(cli(*words).document("fleet"))
    assert found["press"]["exit_code"] == 0
    check(found["press"]["document"], "snapshot")
    assert len(found["press"]["document"]["values"]) == 10
    assert found["oven"]["exit_code"] in {4, 5}
    assert found["pump"]["document"]["error"]["message"] == "no specification in the inventory"
    kept = list(Path("snaps/press").iterdir())
    assert len(kept) == 2
    assert saved(found["press"]["file"])["schema"] == "fatektool.snapshot/1"


def test_a_name_stands_before_what_is_told_of_one(cli: Cli, plant: Hall) -> None:
    assert plant.targets
    done = cli("fleet", "status", "-q", "--json")
    assert done.err == ""
    assert json.loads(done.out)["summary"]["ok"] == 3
