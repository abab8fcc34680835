"""Where snapshots are put, what is kept, and what a crash or a full disk leaves."""

from __future__ import annotations

import errno
import io
import json
import os
import stat
import subprocess
import sys
import tempfile
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.errors import DataError, PortBusy, UsageError
from fatektool.jobs.snapshots.formats import as_json, as_ndjson
from fatektool.jobs.snapshots.snapshot import load_snapshot
from fatektool.jobs.snapshots.store import Keep, append_line, save_dated
from fatektool.transport.lock import PortLock
from tests.cli.running import check, process, started
from tests.night import examples
from tests.plant import error_of, recorded, snapshot_of
from tests.platforms import posix
from tests.users import two_users

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.jobs.snapshots.snapshot import Snapshot
    from tests.plant import Plant

TAKEN = snapshot_of("R0:3", "Y0")
NOW = datetime(2026, 11, 22, 12, tzinfo=UTC)


def at(time: str, station: int = 1) -> Snapshot:
    return replace(TAKEN, time=f"{time}T03:15:00Z", station=station)


def dated(
    folder: Path, time: str, keep: str | None = None, *, station: int = 1, suffix: str = "json"
) -> Path:
    snapshot = at(time, station)
    kept = None if keep is None else Keep.parse(keep)
    return save_dated(snapshot, as_json(snapshot), folder, suffix=suffix, keep=kept, now=NOW)


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def lines(path: Path) -> list[dict[str, Any]]:
    found = [json.loads(line) for line in path.read_text().splitlines()]
    for document in found:
        check(document, "snapshot")
    return found


@pytest.mark.parametrize(
    "text", ["0", "-1", "", "d", "30D", "1.5d", "0d", "x", "30 d", "1234567890", "\u0661"]
)
def test_a_wrong_keep(plant: Plant, text: str) -> None:
    with pytest.raises(UsageError):
        Keep.parse(text)
    assert "--keep" in error_of(plant.cli("snapshot", "R0", "-o", "./", f"--keep={text}"), 2)


def test_keep_by_number(place: Path) -> None:
    for day in ("20", "18", "19"):
        dated(place, f"2026-11-{day}", "2")
    assert names(place) == ["snapshot-st01-20261119T031500Z.json", "snapshot-st01-20261120T031500Z.json"]
    assert dated(place, "2026-11-21", "1").name == names(place)[0]
    assert len(names(place)) == 1


def test_keep_by_days(place: Path) -> None:
    for day in ("01", "20", "21"):
        dated(place, f"2026-11-{day}")
    dated(place, "2026-11-22", "2d")
    assert names(place) == ["snapshot-st01-20261121T031500Z.json", "snapshot-st01-20261122T031500Z.json"]
    dated(place, "2026-11-01", "999999999d")
    assert len(names(place)) == 3


def test_keep_counts_files_of_one_second_in_their_order(place: Path) -> None:
    for number in range(12):
        (place / "x").write_text(str(number))
        save_dated(at("2026-11-20"), str(number), place, suffix="json")
    dated(place, "2026-11-21", "3")
    (place / "x").unlink()
    assert [(place / name).read_text()[:2] for name in names(place)] == ["10", "11", "{\n"]


def test_keep_leaves_all_else_alone(place: Path) -> None:
    others = [
        "fatek-st01-20200101T000000Z.json",  # a backup of the program
        "snapshot-st02-20200101T000000Z.json", "snapshot-st01-20200101T000000Z.csv", "notes.txt",
        "snapshot-st01-20200101T000000Z.safety-st01-20200101T000000Z.json", "snapshot-st01-x.json",
        ".fatektool-0123.tmp",
    ]  # fmt: skip
    for name in others:
        (place / name).write_text("{}")
    dated(place, "2020-01-01")
    dated(place, "2026-11-22", "1")
    assert set(names(place)) == {*others, "snapshot-st01-20261122T031500Z.json"}


def test_backups_live_beside_snapshots(plant: Plant, place: Path) -> None:
    folder = place / "press"
    folder.mkdir()
    assert plant.cli("backup", "--single-pass", folder / "fatek-st01-20200101T000000Z.json").code == 0
    assert plant.cli("snapshot", "R0", "-o", "press/", "--keep", "1").code == 0
    assert plant.cli("snapshot", "R0", "-o", "press", "--keep", "1d", "--format", "csv").code == 0
    assert len(names(folder)) == 3


def test_an_output_replaces_snapshots_and_no_program(
    plant: Plant, place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert plant.cli("backup", "--single-pass", "press.json").code == 0
    before = (place / "press.json").read_bytes()
    with monkeypatch.context() as patch:
        sent = recorded(patch)
        assert "press.json exists already" in error_of(plant.cli("snapshot", "R0", "-o", "press.json"), 2)
        assert sent == []
    assert (place / "press.json").read_bytes() == before
    done = plant.cli("snapshot", "R0", "-o", "data.json")
    assert (done.code, done.out) == (0, "")
    assert done.err.startswith("saved data.json: 1 value, took ")
    quiet = plant.cli("snapshot", "R0", "-o", "quiet.json", "-q")
    assert (quiet.code, quiet.out, quiet.err) == (0, "", "")
    done = plant.cli("snapshot", "R0", "-o", "data.json")
    assert "data.json exists already and is kept; choose another name, or --force" in error_of(done, 2)
    assert "is the backup" in error_of(plant.cli("snapshot", "R0", "-o", "press.json", "--force"), 2)
    assert plant.cli("snapshot", "R0", "-o", "data.json", "--force").code == 0
    assert load_snapshot(place / "data.json").values == {"R0": 0}
    assert plant.cli("snapshot", "R0", "-o", "-", "--format", "csv").out.startswith("time,")
    assert not (place / "-").exists()
    document = plant.json("snapshot", "snapshot", "R0", "-o", "data.csv", "--format", "csv")
    assert document["values"] == {"R0": 0}
    assert (place / "data.csv").read_text().startswith("time,")


def test_refused_elements_are_saved_too(plant: Plant, place: Path) -> None:
    words = ["snapshot", "R0", "R9000", "R1"]
    document = plant.json("snapshot", *words, "-o", "a.json", "--append", "a.ndjson", code=4)
    assert document["values"] == {"R0": 0, "R9000": None, "R1": 0}
    assert list(document["errors"]) == ["R9000"]
    assert load_snapshot(place / "a.json").document() == document
    assert load_snapshot(place / "a.ndjson").document() == document
    assert plant.cli(*words).err.startswith("warning: R9000: the PLC refused")


@pytest.mark.parametrize(
    "words",
    [
        ["-o", "notes.txt/"], ["-o", "none/x.json"], ["-o", "."], ["-o", "/dev/null"], ["--append", "none/x"],
        ["--append", "."], ["--append", "/dev/null"], ["--keep", "5"], ["-o", "x.json", "--keep", "5"],
        ["--append", "notes.txt"], ["--append", "whole.json"], ["--append", "backup.json"], ["-o", "x\0y"],
    ],
)  # fmt: skip
def test_a_wrong_place_is_refused_before_a_byte_is_sent(
    plant: Plant, place: Path, monkeypatch: pytest.MonkeyPatch, words: list[str]
) -> None:
    if os.name == "nt" and "x\0y" in words:
        pytest.skip("a command line of Windows has no such word")
    (place / "notes.txt").write_text("do not lose me\n")
    (place / "whole.json").write_text(as_json(TAKEN))
    (place / "backup.json").write_text('{\n  "schema": "fatektool.backup/1"')
    sent = recorded(monkeypatch)
    done = plant.cli("snapshot", "R0", *words)
    if words == ["-o", "."]:
        assert done.code == 0  # a folder without its slash is a folder still
        return
    error_of(done, 2)
    assert sent == []
    assert (place / "notes.txt").read_text() == "do not lose me\n"


def test_a_folder_that_is_read_only(plant: Plant, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = place / "closed"
    folder.mkdir()
    own = folder / "own.ndjson"
    own.touch()
    closed = {folder}  # not by its mode: root may write anywhere
    access = os.access
    monkeypatch.setattr(
        os,
        "access",
        lambda path, mode: (
            (mode != os.W_OK or Path(os.path.realpath(path)) not in closed) and access(path, mode)
        ),
    )
    for words in (["-o", "closed/"], ["-o", "closed/x.json"], ["--append", "closed/x.ndjson"]):
        assert "not writable" in error_of(plant.cli("snapshot", "R0", *words), 2)
    assert plant.cli("snapshot", "R0", "--append", own).code == 0
    assert "not writable" in error_of(plant.cli("snapshot", "R0", "--append", own, "--keep", "1"), 2)
    closed.add(own)
    assert "not writable" in error_of(plant.cli("snapshot", "R0", "--append", own), 2)
    assert len(lines(own)) == 1


def test_append(place: Path) -> None:
    path = place / "a.ndjson"
    for day in ("18", "19", "20"):
        append_line(path, as_ndjson(at(f"2026-11-{day}")), None)
    assert [line["time"][:10] for line in lines(path)] == ["2026-11-18", "2026-11-19", "2026-11-20"]
    append_line(path, as_ndjson(at("2026-11-21")), Keep.parse("2"), now=NOW)
    assert [line["time"][8:10] for line in lines(path)] == ["20", "21"]
    append_line(path, as_ndjson(at("2026-11-22")), Keep.parse("1d"), now=NOW)
    assert [line["time"][8:10] for line in lines(path)] == ["22"]


@posix("modes of files")
def test_append_follows_a_link_and_keeps_the_mode(place: Path) -> None:
    real, link = place / "real.ndjson", place / "link.ndjson"
    link.symlink_to(real)
    append_line(link, as_ndjson(at("2026-11-18")), None)
    real.chmod(0o664)
    append_line(link, as_ndjson(at("2026-11-19")), Keep.parse("1"))
    assert link.is_symlink()
    assert len(lines(real)) == 1
    assert stat.S_IMODE(real.stat().st_mode) == 0o664


def test_half_a_line_is_closed_off_and_goes_with_the_old_ones(place: Path) -> None:
    path = place / "a.ndjson"
    line = as_ndjson(at("2026-11-20"))
    path.write_text(line + line[:50])
    append_line(path, as_ndjson(at("2026-11-21")), None)
    assert path.read_text().splitlines()[1] == line[:50]
    assert load_snapshot(path).time.startswith("2026-11-21")
    append_line(path, as_ndjson(at("2026-11-22")), Keep.parse("2"))
    assert [part["time"][8:10] for part in lines(path)] == ["21", "22"]
    path.write_text(line[:9])
    append_line(path, line, Keep.parse("5d"), now=NOW)
    assert path.read_text() == line


def test_lines_of_something_else_stay(place: Path) -> None:
    path = place / "a.ndjson"
    path.write_text(
        '{"schema": "fatektool.watch/1", "time": "2020-01-01T00:00:00Z"}\n' + as_ndjson(at("2026-11-01"))
    )
    append_line(path, as_ndjson(at("2026-11-22")), Keep.parse("1"))
    assert [line["schema"] for line in map(json.loads, path.read_text().splitlines())] == [
        "fatektool.watch/1", "fatektool.snapshot/1",
    ]  # fmt: skip


class FullDisk(io.FileIO):
    """A disk with room for some bytes more."""

    room = 0

    def write(self, data: object) -> int:
        whole = bytes(data)  # type: ignore[call-overload]  # bytes
        if not self.room:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        written = super().write(whole[: self.room])
        FullDisk.room -= written
        return written


@pytest.mark.parametrize("room", [0, 1, 100])
def test_a_full_disk_takes_the_half_line_back(
    place: Path, monkeypatch: pytest.MonkeyPatch, room: int
) -> None:
    path = place / "a.ndjson"
    append_line(path, as_ndjson(at("2026-11-20")), None)
    before = path.read_bytes()
    monkeypatch.setattr(FullDisk, "room", room)
    with monkeypatch.context() as patch:
        patch.setattr(
            "fatektool.jobs.snapshots.store.os.fdopen", lambda number, *_, **__: FullDisk(number, "r+")
        )
        with pytest.raises(DataError, match="No space left") as caught:
            append_line(path, as_ndjson(at("2026-11-21")), None)
    assert caught.value.exit_code == 5
    assert path.read_bytes() == before
    append_line(path, as_ndjson(at("2026-11-21")), None)
    assert len(lines(path)) == 2


@posix("devices are files")
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_standard_output_on_a_full_disk(plant: Plant) -> None:
    done = process("snapshot", "R0", "-p", plant.target, redirect="> /dev/full")
    assert done.code == 5
    assert done.err.count("\n") == 1


def test_a_lock_that_is_held(place: Path) -> None:
    path = place / "a.ndjson"
    lock = PortLock(os.path.realpath(path), 0.0)
    lock.acquire()
    with pytest.raises(PortBusy):
        append_line(path, as_ndjson(TAKEN), None, wait_s=0.0)
    lock.release()
    assert not path.exists()


def test_processes_that_append_at_once(place: Path) -> None:
    """Four at once, each with a PLC of its own, two of them dropping old lines: every line is whole."""
    targets = [f"sim:{place / f'{number}.state'}" for number in range(4)]
    jobs = [
        started(
            "snapshot",
            "R0-R63",
            "-p",
            target,
            "--append",
            "all.ndjson",
            "--keep",
            "5" if number % 2 else "9d",
        )
        for number, target in enumerate(targets)
    ]
    assert [job.wait() for job in jobs] == [0] * 4
    for job in jobs:
        job.communicate()
    found = lines(place / "all.ndjson")
    assert {part["target"] for part in found} == set(targets)


def test_killed_while_appending(place: Path) -> None:
    """Whenever the process dies, the file is lines, and the last one is whole or can be told."""
    path = place / "a.ndjson"
    path.write_text(as_ndjson(TAKEN))
    program = (
        "import sys; from pathlib import Path; from fatektool.jobs.snapshots.store import append_line, Keep\n"
        "line = Path(sys.argv[1]).read_text().splitlines()[0] + '\\n'\n"
        "while True: print(flush=True); append_line(Path(sys.argv[1]), line, Keep(8, False))\n"
    )
    for number in range(examples(5)):
        with subprocess.Popen([sys.executable, "-c", program, str(path)], stdout=subprocess.PIPE) as job:
            assert job.stdout is not None
            for _ in range(1 + 5 * number):
                job.stdout.readline()
            job.kill()
        assert replace(load_snapshot(path), time=TAKEN.time) == TAKEN
        append_line(path, as_ndjson(TAKEN), Keep.parse("20"))
        assert [part["schema"] for part in lines(path)][-1] == "fatektool.snapshot/1"


# --- folders that may be written and not listed, and disks that cannot sync ---------------------------------

AS_NOBODY = """
import contextlib, io, os, sys
from fatektool.cli import main, run
words = sys.argv[2:]
with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
    run([word.replace(sys.argv[1], ".") for word in words])  # loads all: others may not read this Python
os.setgroups([]); os.setgid(65534); os.setuid(65534)
main(words)
"""


def as_nobody(folder: Path, *words: object) -> subprocess.CompletedProcess[str]:
    """Run a command as another user, after a try in the present folder instead of this one."""
    return subprocess.run(
        [sys.executable, "-c", AS_NOBODY, str(folder), *map(str, words)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture
def unlisted() -> Iterator[Path]:
    """A folder of another user, into which files may be put and which may not be listed: mode 733."""
    with tempfile.TemporaryDirectory() as name:
        Path(name).chmod(0o711)
        folder = Path(name) / "in"
        folder.mkdir()
        folder.chmod(0o733)
        yield folder


@pytest.mark.usefixtures("place")
@two_users
def test_a_folder_that_may_not_be_listed(unlisted: Path) -> None:
    """One file, told of as written."""
    done = as_nobody(unlisted, "snapshot", "R0:3", "-p", "sim:", "-o", f"{unlisted}/")
    assert done.returncode == 0, done.stderr
    assert f"warning: a new name in folder {unlisted} may be lost in a power cut" in done.stderr
    (file,) = unlisted.iterdir()
    assert load_snapshot(file, print).values.keys() == {"R0", "R1", "R2"}
    done = as_nobody(unlisted, "backup", unlisted / "x.json", "-p", "sim:")
    assert done.returncode == 0, done.stderr
    assert done.stderr.startswith("warning: a new name in folder")
    assert "saved" in done.stdout
    done = as_nobody(unlisted, "check", "-p", "sim:", "--expect", "any", "--prometheus", unlisted / "x.prom")
    assert (done.returncode, done.stdout[:8]) == (0, "FATEK OK")
    assert (unlisted / "x.prom").exists()


@pytest.mark.usefixtures("place")
@two_users
def test_old_snapshots_that_cannot_be_dropped(unlisted: Path) -> None:
    done = as_nobody(unlisted, "snapshot", "R0:3", "-p", "sim:", "-o", f"{unlisted}/", "--keep", "1")
    assert done.returncode == 0, done.stderr
    assert f"warning: the snapshot is written, but old ones in {unlisted} could not be removed" in done.stderr
    assert len(list(unlisted.iterdir())) == 1
