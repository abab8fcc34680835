"""The command that completes a write: as it was given, and as it can be given in any folder."""

from __future__ import annotations

import json
import shlex
import shutil
from typing import TYPE_CHECKING

import pytest

from tests.cli.write_back.writers import Bench

if TYPE_CHECKING:
    from pathlib import Path

    from tests.cli.running import Cli

QUICK = ("--retries", "0", "--timeout", "0.01")


@pytest.fixture
def bench(place: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> Bench:
    return Bench("restore", place, cli, monkeypatch)


def commands(bench: Bench, *words: str) -> tuple[list[str], list[str]]:
    """Both commands of a restore that was cut: what is said, and what the record has."""
    with pytest.MonkeyPatch.context() as patch:
        bench.cut(patch, 5)
        done = bench.cli(*words, "--yes", *QUICK)
    assert done.code == 6, done
    (record,) = bench.records
    said, kept = done.err.splitlines()[-1], json.loads(record.read_text())["command"]
    return shlex.split(said), shlex.split(kept)


def without_quick(words: list[str]) -> list[str]:
    assert words[-5:] == ["--yes", *QUICK]
    return words[:-5]


def test_files_are_whole_paths_and_the_trace_is_left_out(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = ["restore", "./new.json", "--trace", "t.pcap", "--safety-dir=copies", "-p", bench.target]
    said, kept = commands(bench, *words)
    target = ["-p", bench.target]
    assert without_quick(said) == [
        "fatektool", "restore", "--changed-only", "./new.json", "--safety-dir=copies", *target,
    ]  # fmt: skip
    folder = bench.place
    assert without_quick(kept)[2:] == [
        "--changed-only", f"{folder}/new.json", f"--safety-dir={folder}/copies", *target,
    ]  # fmt: skip
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert bench.cli(*kept[1:]).code == 0
    assert bench.held == bench.after
    assert bench.records == []
    assert len(list((folder / "copies").iterdir())) == 1


def test_a_target_from_the_environment_is_named(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FATEKTOOL_PORT", bench.target)
    said, _ = commands(bench, "restore", "--changed-only", "new.json", "-qv")
    assert without_quick(said) == [
        "fatektool", "restore", "--changed-only", "-p", bench.target, "new.json", "-qv",
    ]  # fmt: skip
    monkeypatch.delenv("FATEKTOOL_PORT")
    assert bench.cli(*said[1:]).code == 0
    assert bench.held == bench.after


@pytest.mark.parametrize("name", ["1", "-1", "restore", "sim"])
def test_a_file_that_is_called_like_something_else(bench: Bench, name: str) -> None:
    """Only what is a file becomes a path: the station stays a number."""
    shutil.copy("new.json", name)
    with pytest.MonkeyPatch.context() as patch:
        bench.cut(patch, 5)
        done = bench.cli("restore", "-s", "1", "-p", bench.target, "--yes", *QUICK, "--", name)
    assert done.code == 6, done
    (record,) = bench.records
    kept = shlex.split(json.loads(record.read_text())["command"])
    assert kept[:5] == ["fatektool", "restore", "--changed-only", "-s", "1"]
    assert kept[-2:] == ["--", str(bench.place / name)]
    assert bench.cli(*kept[1:]).code == 0
    assert bench.held == bench.after


def test_two_files_of_one_command(place: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """SR is no file, though it comes behind one; an inventory is one."""
    bench = Bench("link table write", place, cli, monkeypatch)
    (place / "plcs.toml").write_text(f'[plc.press]\ntarget = "{bench.target}"\n')
    words = ["link", "table", "write", "table.toml", "R500", "-p", "press", "--inventory", "plcs.toml"]
    with pytest.MonkeyPatch.context() as patch:
        bench.cut(patch, 1)
        assert cli(*words, "--yes", *QUICK).code == 6
    (record,) = bench.records
    kept = without_quick(shlex.split(json.loads(record.read_text())["command"]))
    assert kept == [
        "fatektool", "link", "table", "write", f"{place}/table.toml", "R500", "-p", "press",
        "--inventory", f"{place}/plcs.toml",
    ]  # fmt: skip
