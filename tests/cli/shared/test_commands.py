"""What each command does beside its answer: files, options."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from fatektool.errors import DataError
from fatektool.program.archive import load_backup
from fatektool.simulator.build import build_simulation
from tests.cli.running import NEW, OLD, Cli, Press, schema_text
from tests.program.samples import header, program

# --- backup and inspect ----------------------------------------------------------------------------------


def test_a_backup_without_a_name_is_named_by_station_and_time(place: Path, cli: Cli) -> None:
    build_simulation([7], ladder_words=400, state="seven.state")
    assert cli("backup", "-p", "sim:seven.state", "-s", 7).code == 0
    (path,) = place.glob("*.json")
    assert re.fullmatch(r"fatek-st07-\d{8}T\d{6}Z\.json", path.name)
    assert load_backup(path).source.station == 7


def test_bare_pages_that_cannot_be_written_cost_no_backup(
    press: Press, cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, data: bytes, **_: object) -> None:
        raise DataError(f"cannot write {path}: No space left on device ({len(data)} bytes)")

    monkeypatch.setattr("fatektool.cli.programs.backup.write_whole", full)
    done = cli("backup", "x.json", "--raw", "x.bin", "-p", press.target)
    assert done.code == 5
    assert "x.json is saved, but its binary pages are not: cannot write x.bin: No space" in done.err
    assert cli("verify", "x.json", "-p", press.target).code == 0


def test_force_replaces_file_and_raw(press: Press, cli: Cli) -> None:
    raw = press.folder / "x.bin"
    raw.write_bytes(b"old")
    assert cli("backup", press.new, "--raw", raw, "-p", press.target).code == 2
    assert load_backup(press.new).program == NEW
    assert raw.read_bytes() == b"old"
    assert cli("backup", press.new, "--raw", raw, "-p", press.target, "--force").code == 0
    assert load_backup(press.new).program == OLD
    assert raw.read_bytes() == OLD.data


def test_a_file_that_could_not_be_kept_is_refused_before_the_plc_is_asked(press: Press, cli: Cli) -> None:
    assert cli("backup", press.old, "-p", "/dev/nope").code == 2
    assert cli("backup", "x.json", "--raw", press.old, "-p", "/dev/nope").code == 2


def test_a_header_that_does_not_hold_is_kept_if_that_is_asked_for(place: Path, cli: Cli) -> None:
    build_simulation(ladder_words=400, program=program(400, page0=header(400, b"XB30")).pages, state="odd")
    refused = cli("backup", "x.json", "-p", "sim:odd")
    assert refused.code == 5
    assert "byte 0: expected F (46), got X (58)" in refused.err
    assert not Path("x.json").exists()
    kept = cli("backup", "x.json", "-p", "sim:odd", "--any-header", "--json")
    assert kept.code == 0
    assert kept.err == "warning: invalid header of the program: byte 0: expected F (46), got X (58)\n"
    assert kept.document("backup-result")["header"]["valid"] is False
    shown = cli("inspect", "x.json", "--json")
    assert shown.document("inspect")["faults"] == ["byte 0: expected F (46), got X (58)"]
    assert sorted(path.name for path in place.iterdir()) == ["odd", "x.json"]


def test_the_bare_pages_of_a_backup(press: Press, cli: Cli) -> None:
    done = cli("inspect", press.old, "--raw", "x.bin")
    assert done.code == 0
    assert Path("x.bin").read_bytes() == OLD.data
    assert done.err == "1024 bytes written to x.bin\n"
    assert cli("inspect", press.old, "--raw", "x.bin").code == 2
    assert cli("inspect", press.old, "--raw", "x.bin", "--force", "-q").err == ""


@pytest.mark.parametrize("link", ["symlink", "hardlink"])
def test_a_backup_is_not_overwritten_with_its_own_pages(press: Press, cli: Cli, link: str) -> None:
    other = Path("other.json")
    if link == "symlink":
        other.symlink_to(press.old)
    else:
        os.link(press.old, other)
    cli("inspect", press.old, "--raw", other, "--force")
    assert load_backup(press.old).program == OLD


def test_what_inspect_shows(press: Press, cli: Cli) -> None:
    rows = dict(re.split(r"  +", line, maxsplit=1) for line in cli("inspect", press.old).out.splitlines())
    assert rows["file"] == f"{press.old}: complete, hash and header checked"
    assert rows["source"] == f"station 1 on {press.target}, facon, 9600 7E1"
    assert rows["ladder size"] == "400 words, 8 pages, 7 not empty"
    assert rows["sha256"] == OLD.sha256


# --- restore, run, stop ----------------------------------------------------------------------------------


def test_a_restore_keeps_the_old_program_beside_the_file(press: Press, cli: Cli) -> None:
    done = cli("restore", press.new, "-p", press.target, "--yes")
    assert done.code == 0
    assert press.program == NEW
    (safety,) = press.safety
    assert load_backup(safety).program == OLD
    facts = [
        f"PLC    station 1 on {press.target}",
        "model  MC, 28 points, OS 3.1",
        "mode   STOP",
        f"file   {press.new}",
        f"from   station 1 on {press.target}, 2026-11-22T03:15:00Z",
    ]
    assert done.err.splitlines()[:5] == facts
    assert done.err.splitlines()[5].startswith("time   ")
    assert done.err.splitlines()[6:] == [
        "The PLC's program differs in pages 1-7 (448 words).",
        "All 8 pages will be written, then all read back.",
        "--changed-only writes only the 7 pages that differ.",
        f"Previous program saved in {safety}",
    ]
    assert "8 written, 1 were equal already" in done.out
    assert cli("restore", safety, "-p", press.target, "--yes", "-q").err == ""
    assert press.program == OLD


def test_a_dry_run_tells_what_would_be_done(press: Press, cli: Cli) -> None:
    press.set("running")
    words = ["restore", press.new, "-p", press.target, "--dry-run", "--stop", "--run", "--changed-only"]
    done = cli(*words)
    facts = done.out.splitlines()[:6]
    assert [line.split()[0] for line in facts] == ["PLC", "model", "mode", "file", "from", "time"]
    assert done.out.splitlines()[6:] == [
        "The PLC's program differs in pages 1-7 (448 words).",
        "The PLC is in RUN and will be stopped.",
        "7 of 8 pages will be written, then all read back.",
        "Then the PLC will RUN.",
        "Previous program will be saved first.",
        "dry run: nothing was written",
    ]
    assert "Previous program NOT saved: this write cannot be undone." in cli(*words, "--no-safety-backup").out
    document = cli(*words, "--json").document("restore")
    assert (document["dry_run"], document["pages_to_write"], document["pages_written"]) == (True, 7, 0)
    assert (document["verified"], document["mode_after"]) == (False, "run")
    assert press.program == OLD
    assert press.running
    assert press.safety == []


def test_a_safety_backup_elsewhere(press: Press, cli: Cli) -> None:
    folder = press.folder / "safe"
    folder.mkdir()
    document = cli("restore", press.new, "-p", press.target, "--yes", "--safety-dir", folder, "--json")
    (safety,) = folder.iterdir()
    assert document.document("restore")["safety_backup"] == str(safety)
    assert press.safety == []


def test_equal_already_is_said(press: Press, cli: Cli) -> None:
    done = cli("restore", press.old, "-p", press.target)
    assert done.out.splitlines() == [
        f"same: the PLC's program is the one in {press.old} already; nothing was written",
        "the PLC is in STOP",
    ]
    assert press.safety == []
    assert cli("restore", press.old, "-p", press.target, "--run", "--yes").code == 0
    assert press.running


@pytest.mark.parametrize("command", ["run", "stop"])
def test_run_and_stop(press: Press, cli: Cli, command: str) -> None:
    if command == "stop":
        press.set("running")
    done = cli(command, "-p", press.target, "--yes")
    facts = f"station 1 on {press.target} (FBE, 13K steps)\n"
    assert (done.code, done.out) == (0, f"the PLC is in {command.upper()}\n{facts}")
    assert press.running == (command == "run")
    again = cli(command, "-p", press.target)
    assert (again.code, again.out) == (0, f"the PLC is in {command.upper()} already\n{facts}")


# --- port, status, trace ---------------------------------------------------------------------------------


def test_the_port_may_be_in_the_environment(press: Press, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FATEKTOOL_PORT", press.target)
    assert cli("status", "--json").document("status")["target"] == press.target
    assert cli("status", "-p", "sim:", "--json").document("status")["target"] == "sim:"
    monkeypatch.setenv("FATEKTOOL_PORT", "")
    assert "no PLC named" in cli("status").err


def test_status_in_words(press: Press, cli: Cli) -> None:
    press.set("battery_low", "emergency_stop", "rom_pack")
    out = cli("status", "-p", press.target).out
    for line in (
        "mode              STOP",
        "battery           LOW: take a backup and a snapshot now, then replace it",
        "emergency stop    ACTIVE",
        "ROM pack          in use: the program cannot be written",
        "ladder size       400 words",
    ):
        assert line in out.splitlines()
    brief = cli("status", "-p", press.target, "--brief").out
    assert "ladder size" not in brief
    assert [line.split() for line in out.splitlines()][: brief.count("\n")] == [
        line.split() for line in brief.splitlines()
    ]


def test_verbose_tells_more_and_only_on_stderr(press: Press, cli: Cli) -> None:
    done = cli("backup", "x.json", "-p", press.target, "-v", "--json")
    done.document("backup-result")
    assert done.err.startswith("line: ")


@pytest.mark.parametrize("ending", ["ndjson", "pcap"])
def test_a_trace_is_written_and_explained(press: Press, cli: Cli, ending: str) -> None:
    trace = f"line.{ending}"
    assert cli("status", "-p", press.target, "--trace", trace).code == 0
    if ending == "ndjson":
        for line in Path(trace).read_text().splitlines():
            Draft202012Validator(json.loads(schema_text("trace"))).validate(json.loads(line))
    document = cli("decode", trace, "--json").document("decode")
    assert [frame["command"] for frame in document["frames"]] == ["40", "40", "53", "53"]
    assert [frame["direction"] for frame in document["frames"]] == ["tx", "rx", "tx", "rx"]
    assert all(frame["checksum_ok"] for frame in document["frames"])
    assert all(re.fullmatch(r"\d{4}-\d\d-\d\dT[\d:.]+Z", frame["time"]) for frame in document["frames"])
    words = cli("decode", trace)
    assert words.code == 0
    assert words.out.count(" tx  request, ") == 2
