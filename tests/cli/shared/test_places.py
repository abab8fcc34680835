"""One rule for all files: what is there is kept unless ``--force`` replaces it; missing folders are made."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.running import Cli, Press, one_line
from tests.cli.shared.test_pairs import commands, options

FILES = [
    ("backup x.json -p sim:", "x.json"),
    ("backup y.json --raw x.bin -p sim:", "x.bin"),
    ("inspect old.json --raw x.bin", "x.bin"),
    ("snapshot R0 -p sim: -o x.json", "x.json"),
    ("snapshot R0 -p sim: -o x.csv", "x.csv"),
    ("snapshot R0 -p sim: --report x.html", "x.html"),
    ("verify old.json -p sim:plc.state --report x.html", "x.html"),
    ("diff old.json old.json --report x.html", "x.html"),
    ("loopback --count 3 -p sim: --report x.html", "x.html"),
    ("watch R0 --count 1 -p sim: --report x.html", "x.html"),
    ("link table save R0 x.toml --kind md0 -p sim:", "x.toml"),
    ("snapshot R0 -p sim: --trace x.pcap", "x.pcap"),
    ("backup y.json -p sim: --trace x.ndjson", "x.ndjson"),
]
KEPT = [
    ("status -p sim: --trace x.pcap", "x.pcap"),
    ("read R0 -p sim: --trace x.ndjson", "x.ndjson"),
    ("link table write t.toml R0 --force -p sim: --trace x.ndjson", "x.ndjson"),
]


@pytest.mark.parametrize(("words", "file"), FILES)
def test_a_file_that_is_there_is_kept_unless_forced(cli: Cli, press: Press, words: str, file: str) -> None:
    path = press.folder / file
    assert cli(*words.split()).code in {0, 5 if "table" in words else 0}
    if "table" in words and not path.exists():
        path.write_text("old")
    (press.folder / "y.json").unlink(missing_ok=True)
    before = path.read_bytes()
    done = cli(*words.split())
    assert (done.code, done.out) == (2, "")
    assert one_line(done.err).endswith(f"{file} exists already and is kept; choose another name, or --force")
    assert path.read_bytes() == before
    assert not (press.folder / "y.json").exists()
    if "table" not in words:
        assert cli(*words.split(), "--force").code == 0
        assert path.read_bytes()


@pytest.mark.parametrize(("words", "file"), KEPT)
def test_a_trace_of_a_command_without_force(cli: Cli, press: Press, words: str, file: str) -> None:
    (press.folder / file).write_text("old")
    done = cli(*words.split())
    assert done.code == 2
    assert one_line(done.err).endswith(f"{file} exists already and is kept; name another file, or remove it")
    assert (press.folder / file).read_text() == "old"


def test_each_command_that_writes_files_has_force() -> None:
    for name, command in commands():
        if {"--report", "--raw", "--output"} & options(command) and name not in {"loopback", "fleet"}:
            assert "--force" in options(command), name


@pytest.mark.parametrize(
    ("words", "folder"),
    [
        ("snapshot R0 -p sim: -o new/deep/", "new/deep"),
        ("fleet backup --dir new", "new"),
        ("fleet snapshot --dir new", "new"),
        ("restore new.json -p sim:plc.state --yes --safety-dir new", "new"),
        ("snapshot apply s.json -p sim: --yes --safety-dir new", "new"),
        ("link modem set --number 1 -p sim: --yes --safety-dir new", "new"),
    ],
)
def test_a_folder_that_is_missing_is_made(cli: Cli, press: Press, words: str, folder: str) -> None:
    (press.folder / "a.toml").write_text('[[item]]\nelement = "R0"\nname = "x"\n')
    (press.folder / "fatek.toml").write_text(f'[plc.x]\ntarget = "{press.target}"\nspec = "a.toml"\n')
    assert cli("snapshot", "R0", "-p", "sim:", "-o", "s.json").code == 0
    done = cli(*words.split())
    assert done.code == 0, done
    assert f"created the folder {folder}" in done.err
    assert Path(folder).is_dir()
    if "snapshot apply" not in words:
        assert list(Path(folder).iterdir())
    if "restore" not in words:
        assert "created the folder" not in cli(*words.split(), "-q").err


def test_a_dry_run_makes_no_folder(cli: Cli, press: Press) -> None:
    words = ["restore", press.new, "-p", press.target, "--dry-run", "--safety-dir", "new"]
    assert cli(*words).code == 0
    assert not Path("new").exists()


@pytest.mark.usefixtures("press")
def test_a_folder_that_cannot_be_made(cli: Cli) -> None:
    for place in ("old.json/deep/", "old.json/"):
        done = cli("snapshot", "R0", "-p", "sim:", "-o", place)
        assert done.code == 2
        assert "old.json" in one_line(done.err)
