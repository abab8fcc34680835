"""Death at any step: SIGKILL, a power cut, a full disk. What is left is whole, the same command goes on."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import tempfile
from functools import partial
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.program.archive import load_backup, save_backup
from tests.cli.running import Door, one_line, served
from tests.night import night
from tests.program.samples import backup, program
from tests.reliability.conftest import each_kind, every
from tests.users import IS_ROOT, NOBODY

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fatektool.program.image import Program
    from tests.cli.running import Cli
    from tests.reliability.conftest import Deaths, Life, Mortals

WORDS, PAGES = 256, 5
OLD, NEW, OTHER = (program(WORDS, seed=seed) for seed in (1, 2, 3))
KILLED = -signal.SIGKILL
BACKUP = ["backup", "x.json", "--force"]
RESTORE = ["restore", "new.json", "--yes", "--json"]


@pytest.fixture
def door() -> Iterator[Door]:
    with served(OLD, faults=("power-cut=100000",)) as found:
        yield found


def load(door: Door, image: Program) -> None:
    """Put a program into the PLC, as nobody over the line does."""
    device = door.simulation.plcs[1]
    device.pages[:] = image.pages


def clear(place: Path, **files: Program) -> None:
    """An empty folder but for these backups."""
    for path in place.iterdir():
        path.unlink()
    for name, image in files.items():
        save_backup(backup(image), place / f"{name}.json")


def backups(place: Path, pattern: str = "*.json") -> dict[str, Program]:
    """The backups in a folder, each of them whole: half a one would not load."""
    return {path.name: load_backup(path).program for path in sorted(place.glob(pattern))}


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def stray(place: Path, *wanted: str) -> list[str]:
    """What lies in a folder beside what is wanted and safety backups."""
    return [name for name in names(place) if ".safety-st01-" not in name and name not in wanted]


# --- killed ---------------------------------------------------------------------------------------------


deaths_at = pytest.mark.parametrize("deaths", [each_kind, night(every)])


def test_death_comes_at_each_kind_of_step() -> None:
    reads = ["send 4F", "answered 4F"] * 4
    assert each_kind(["open x", *reads, *["send 50", "answered 50"] * 3]) == [1, 2, 3, 8, 9, *range(10, 16)]


@deaths_at
@pytest.mark.parametrize("there", [False, True], ids=["new", "replaced"])
def test_a_backup_killed_at_any_step(
    door: Door, place: Path, mortals: Mortals, deaths: Deaths, *, there: bool
) -> None:
    words = [*BACKUP, "-p", door.target]
    before = {"x.json": OTHER} if there else {}
    begin = partial(clear, place, **{"x": OTHER} if there else {})
    whole = whole_life(mortals, place, words, begin)
    first = 1 if there else file_steps(whole)  # up to there the two are the same
    assert len(whole.steps) > 2 * 2 * (PAGES + 1)
    for at in deaths(whole.steps):
        if at < first:
            continue
        begin()
        life = mortals(*words, folder=place, at=at)
        assert (life.code, life.out) == (KILLED, ""), life.steps
        assert backups(place) in (before, {"x.json": OLD}), life.steps
        assert len(stray(place, "x.json")) <= 1
        assert all(name.startswith(".fatektool-") for name in stray(place, "x.json"))
        assert mortals(*words, folder=place).code == 0
        assert backups(place) == {"x.json": OLD}
    assert door.pages == OLD.pages


def whole_life(
    mortals: Mortals, place: Path, words: list[str], before: Callable[[], object] | None = None
) -> Life:
    """The command undisturbed, with the lock file there already, as it is each time after the first."""
    begin = before or partial(clear, place)
    begin()
    mortals(*words, folder=place)
    begin()
    return mortals(*words, folder=place)


def file_steps(life: Life) -> int:
    """The first step that makes a file of the user's, from 1."""
    return 1 + next(at for at, step in enumerate(life.steps) if step.startswith("open .fatektool-"))


def test_a_backup_without_force_is_made_once(door: Door, place: Path, mortals: Mortals) -> None:
    """Killed before FILE is there, the second run makes it; killed behind, FILE is whole and is kept."""
    words = ["backup", "x.json", "-p", door.target]
    life = whole_life(mortals, place, words)
    made = []
    for at in range(file_steps(life), len(life.steps) + 1):
        clear(place)
        assert mortals(*words, folder=place, at=at).code == KILLED
        there = "x.json" in backups(place)
        again = mortals(*words, folder=place)
        assert again.code == (2 if there else 0)
        assert ("x.json exists already and is kept" in again.err) == there
        assert backups(place) == {"x.json": OLD}
        made.append(there)
    assert made == sorted(made)
    assert set(made) == {False, True}


@deaths_at
def test_a_restore_killed_at_any_step(door: Door, place: Path, mortals: Mortals, deaths: Deaths) -> None:
    words = [*RESTORE, "-p", door.target]

    def begin() -> None:
        clear(place, new=NEW)
        load(door, OLD)

    whole = whole_life(mortals, place, words, begin)
    died: dict[str, int] = {}
    for at in deaths(whole.steps):
        begin()
        life = mortals(*words, folder=place, at=at)
        assert (life.code, life.out) == (KILLED, ""), life.steps
        died[life.steps[-1].split()[0]] = at
        half = list(door.pages)
        new = sum(a == b for a, b in zip(half, NEW.pages, strict=True))
        assert half == [*NEW.pages[:new], *OLD.pages[new:]], life.steps
        safety = backups(place, "*.safety-*")
        assert set(safety.values()) <= {OLD}
        if "send 50" in life.steps:
            assert len(safety) == 1, life.steps
        assert backups(place, "new.json") == {"new.json": NEW}

        again = mortals(*words, folder=place)
        assert again.code == 0, again.err
        done = again.document("restore")
        assert done["verified"] is True
        assert done["pages_equal"] == sum(a == b for a, b in zip(half, NEW.pages, strict=True))
        assert list(door.pages) == list(NEW.pages)
        assert set(backups(place, "*.safety-*").values()) <= {OLD}
        if list(half) != list(NEW.pages):
            assert load_backup(place / done["safety_backup"]).program == OLD
    assert {"open", "write", "half", "fsync", "link", "send", "answered"} <= died.keys()


def test_the_safety_backup_is_synced_before_the_first_page_goes_out(
    door: Door, place: Path, mortals: Mortals
) -> None:
    clear(place, new=NEW)
    life = mortals(*RESTORE, "-p", door.target, folder=place)
    assert life.code == 0
    steps = [step.split(" .fatektool-")[0] for step in life.steps]
    order = ["write", "fsync", "link", f"fsync {place.name}", "send 50"]
    assert [steps.index(step) for step in order] == sorted(steps.index(step) for step in order)
    assert steps.index("send 50") > len(steps) - 1 - steps[::-1].index(f"fsync {place.name}")


# --- the PLC's power ------------------------------------------------------------------------------------


def cut_at_read(door: Door, number: int) -> None:
    """Cut the PLC's power when it is asked for a page for the number-th time."""
    device, faults = door.simulation.plcs[1], door.simulation.faults
    assert faults is not None
    read, seen = type(device).read_page, count(1)

    def read_page(page: int) -> bytes:
        if next(seen) == number:
            faults.powered = False
        return read(device, page)

    device.read_page = read_page  # type: ignore[method-assign]


def cut_at_the_reading_back(door: Door) -> None:
    """Cut the PLC's power, once, when a page is asked for after one was written."""
    device, faults = door.simulation.plcs[1], door.simulation.faults
    assert faults is not None
    read, write, written = type(device).read_page, type(device).write_page, [False]

    def read_page(page: int) -> bytes:
        if written == [True]:
            faults.powered = False
            written.append(False)
        return read(device, page)

    def write_page(page: int, content: bytes) -> None:
        written[0] = True
        write(device, page, content)

    device.read_page = read_page  # type: ignore[method-assign]
    device.write_page = write_page  # type: ignore[method-assign]


@pytest.mark.parametrize("page", range(1, 2 * PAGES + 1))
def test_the_power_goes_at_a_page_of_a_backup(door: Door, place: Path, cli: Cli, page: int) -> None:
    cut_at_read(door, page)
    words = [*BACKUP, "-p", door.target]
    done = cli(*words)
    assert done.code == 3
    assert one_line(done.err)
    assert list(place.iterdir()) == []
    door.simulation.power_on()
    assert cli(*words).code == 0
    assert backups(place) == {"x.json": OLD}


@pytest.mark.parametrize("page", range(1, 3 * PAGES + 1))
def test_the_power_goes_at_a_page_that_a_restore_reads(door: Door, place: Path, cli: Cli, page: int) -> None:
    """Two passes of the old program come before the first write, the reading back after the last."""
    clear(place, new=NEW)
    cut_at_read(door, page)
    done = cli(*RESTORE, "-p", door.target)
    error = done.document("error")["error"]
    if page <= 2 * PAGES:
        assert done.code == 3
        assert door.pages == OLD.pages
        assert backups(place) == {"new.json": NEW}
        command = [*RESTORE, "-p", door.target]
    else:
        assert done.code == 6
        told_right(error["details"], door, place)
        command = error["details"]["command"].split()[1:]
    door.simulation.power_on()
    assert cli(*command).code == 0
    assert door.pages == NEW.pages


@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize("write", range(1, PAGES + 1))
def test_the_power_goes_at_a_page_that_a_restore_writes(
    place: Path, cli: Cli, write: int, *, as_json: bool
) -> None:
    clear(place, new=NEW)
    with served(OLD, faults=(f"power-cut={write}",)) as door:
        words = ["restore", "new.json", "--yes", "-q", *(["--json"] if as_json else []), "-p", door.target]
        done = cli(*words)
        assert done.code == 6
        assert "Traceback" not in done.err
        (safety,) = place.glob("new.safety-*")
        if as_json:
            details = done.document("error")["error"]["details"]
            assert details["pages_uncertain"] == [write - 1]
            told_right(details, door, place)
        else:
            warning, *lines, command = done.err.splitlines()
            assert warning.startswith("warning: new.json is from station ")
            assert lines[0] == "fatektool: the restore did not complete"
            assert [f"page {write - 1}", "uncertain"] in [re.split(" {2,}", line.strip()) for line in lines]
            assert f"  previous program  saved in {safety}" in [
                line.replace(safety.name, str(safety)) for line in lines
            ]
            assert lines[2].endswith("not known: do not switch it to RUN; STOP it if it runs")
            assert "--changed-only" in command
        door.simulation.power_on()
        again = cli(*words)
        assert again.code == 0
        assert door.pages == NEW.pages
        assert set(backups(place, "*.safety-*").values()) == {OLD}


def told_right(details: dict[str, Any], door: Door, place: Path) -> None:
    """What is said of each page is what the PLC holds."""
    images = {"pages_written": NEW.pages, "pages_old": OLD.pages}
    for state, pages in images.items():
        assert all(door.pages[page] == pages[page] for page in details[state]), state
    named = [page for state in (*images, "pages_uncertain") for page in details[state]]
    assert sorted(named) == sorted(set(named))
    assert load_backup(place / details["safety_backup"]).program == OLD


# --- the disk is full -----------------------------------------------------------------------------------


def failing_lives(
    mortals: Mortals, place: Path, words: list[str], **files: Program
) -> Iterator[tuple[str, Life]]:
    """The same command with the disk full at each of its operations in turn, and that operation."""
    for at in count(1):
        clear(place, **files)
        life = mortals(*words, folder=place, at=at, how="full")
        if len(life.steps) < at:
            assert life.code == 0
            assert at > 5
            return
        yield life.steps[at - 1].split()[0], life


@pytest.mark.parametrize("there", [False, True], ids=["new", "replaced"])
def test_a_backup_and_a_full_disk(door: Door, place: Path, mortals: Mortals, *, there: bool) -> None:
    files = {"x": OTHER} if there else {}
    before = {"x.json": OTHER} if there else {}
    for failed, life in failing_lives(mortals, place, [*BACKUP, "-p", door.target], **files):
        assert stray(place, "x.json") == []
        if failed == "unlink":  # which needs no room
            assert (life.code, backups(place)) == (0, {"x.json": OLD})
            continue
        assert life.code == 5, life.steps
        assert "x.json: No space left on device; free some space" in one_line(life.err)
        assert life.out == ""
        assert backups(place) in (before, {"x.json": OLD})


def test_a_restore_and_a_full_disk(door: Door, place: Path, mortals: Mortals) -> None:
    """Without a safety backup on disk not one page is written."""
    words = [*RESTORE, "-p", door.target]
    for failed, life in failing_lives(mortals, place, words, new=NEW):
        assert stray(place, "new.json") == []
        if failed in {"link", "unlink"}:  # a rename does as well; and this needs no room
            assert (life.code, door.pages) == (0, NEW.pages)
            load(door, OLD)
            continue
        assert life.code == 5, life.steps
        error = life.document("error")["error"]
        assert "No space left on device" in error["message"]
        assert "free some space" in error["hint"]
        assert door.pages == OLD.pages


@pytest.mark.skipif(os.name != "posix", reason="POSIX limits and mounts")
@pytest.mark.parametrize("kind", ["limit", "disk"])
@pytest.mark.parametrize("command", ["backup", "restore"])
def test_a_disk_that_is_really_too_small(
    door: Door, place: Path, mortals: Mortals, command: str, kind: str
) -> None:
    """A limit of file size, which every user has; a disk of 4 KiB, where the system's user may mount one."""
    words = {"backup": BACKUP, "restore": [*RESTORE, "--safety-dir", "small"]}[command]
    clear(place, new=NEW)
    small = place / "small"
    small.mkdir()
    mount = shutil.which("mount")
    order = [str(mount), "-t", "tmpfs", "-o", "size=4k", "tmpfs", str(small)]
    mounted = (
        kind == "disk" and mount and not subprocess.run(order, capture_output=True, check=False).returncode
    )
    if kind == "disk" and not mounted:
        small.rmdir()
        pytest.skip("only root can mount a small disk")
    try:
        if kind == "disk":
            (small / "full").write_bytes(bytes(3000))
        words = [word.replace("x.json", "small/x.json") for word in words]
        life = mortals(*words, "-p", door.target, folder=place, limit=1024 if kind == "limit" else None)
        assert life.code == 5
        assert "free some space" in life.err
        assert [path.name for path in small.iterdir()] == (["full"] if kind == "disk" else [])
    finally:
        if mounted:
            subprocess.run(["umount", str(small)], check=True)
        small.rmdir()
    assert door.pages == OLD.pages


# --- places that cannot be written, and names that lead elsewhere ----------------------------------------


@pytest.mark.skipif(os.name != "posix", reason="POSIX rights")
@pytest.mark.parametrize("words", [BACKUP, [*RESTORE, "-q"]], ids=["backup", "restore"])
def test_a_folder_that_may_only_be_read(door: Door, mortals: Mortals, words: list[str]) -> None:
    user = NOBODY if IS_ROOT else None  # root may write everywhere, so the child is somebody else
    with tempfile.TemporaryDirectory() as name, tempfile.TemporaryDirectory() as locks:
        folder = Path(name)
        save_backup(backup(NEW), folder / "new.json")
        (folder / "new.json").chmod(0o644)
        folder.chmod(0o555)
        Path(locks).chmod(0o777)
        life = mortals(*words, "-p", door.target, folder=folder, user=user, locks=locks)
        assert life.code == 2, life.err
        assert life.steps == [], "it was found out before anything was done"
        assert "is not writable; choose another folder" in life.err
        assert names(folder) == ["new.json"]
        folder.chmod(0o755)
    assert door.pages == OLD.pages


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["backup", "x" * 300], "too long"),
        (["backup", "x.json", "--raw", "x" * 300], "too long"),
        (["restore", "x" * 300, "--yes"], "too long"),
        (["restore", "new.json", "--yes", "--safety-dir", "x" * 300], "too long"),
        (["backup", "loop"], "symbolic link to itself"),
        (["restore", "loop", "--yes"], "symbolic links"),
        (["restore", "dangling", "--yes"], "No such file"),
        (["backup", "leading"], "exists already and is kept"),
    ],
)
def test_a_name_that_leads_nowhere_is_refused_before_the_plc_is_asked(
    place: Path, cli: Cli, words: list[str], message: str
) -> None:
    clear(place, new=NEW)
    (place / "loop").symlink_to("loop")
    (place / "dangling").symlink_to("nowhere.json")
    (place / "leading").symlink_to("new.json")
    before = names(place)
    done = cli(*words, "-p", "tcp://127.0.0.1:1")  # where nobody is: an exit code of 3 if it were tried
    assert done.code == 2, done.err
    assert message in one_line(done.err)
    assert names(place) == before


def test_a_backup_through_a_symlink(door: Door, place: Path, mortals: Mortals) -> None:
    """The link stays; what it names is made, or replaced whole, whenever the command is killed."""
    words = [*BACKUP, "-p", door.target]
    for there in (True, False):
        for at in (0, *range(30, 50)):
            clear(place, **{"target": OTHER} if there else {})
            (place / "x.json").symlink_to("target.json")
            life = mortals(*words, folder=place, at=at)
            assert life.code in {0, KILLED}
            assert (place / "x.json").is_symlink()
            found = backups(place, "target.json")
            assert found in ({"target.json": OLD}, {"target.json": OTHER} if there else {})
            assert life.code != 0 or found == {"target.json": OLD}


def test_a_restore_through_a_symlink(door: Door, place: Path, cli: Cli) -> None:
    """The safety backup lies beside the link, and bears its name: where the user looked is where it is."""
    clear(place)
    (place.parent / "far").mkdir()
    save_backup(backup(NEW), place.parent / "far" / "a.json")
    (place / "new.json").symlink_to("../far/a.json")
    done = cli(*RESTORE, "-p", door.target)
    assert done.code == 0
    safety = done.document("restore")["safety_backup"]
    assert safety.startswith("new.safety-st01-")
    assert load_backup(place / safety).program == OLD
    assert names(place.parent / "far") == ["a.json"]
    assert door.pages == NEW.pages


def test_the_safety_backup_itself_is_restored(door: Door, place: Path, cli: Cli) -> None:
    """There and back again; the way back of the way back lies beside it, and neither is overwritten."""
    clear(place, new=NEW)
    first = cli(*RESTORE, "-p", door.target).document("restore")["safety_backup"]
    before = (place / first).read_bytes()
    back = cli("restore", first, "--yes", "--json", "-p", door.target).document("restore")
    assert door.pages == OLD.pages
    assert (place / first).read_bytes() == before
    assert back["safety_backup"] != first
    assert load_backup(place / back["safety_backup"]).program == NEW


@pytest.mark.parametrize("write", range(3, PAGES + 1))  # from the second change on there is a half
def test_half_a_restore_is_undone_by_the_safety_backup(place: Path, cli: Cli, write: int) -> None:
    """The power goes on the way there and on the way back; the same command finishes each."""
    clear(place, new=NEW)
    with served(OLD, faults=(f"power-cut={write}",)) as door:
        details = cli(*RESTORE, "-p", door.target).document("error")["error"]["details"]
        way_back = ["restore", details["safety_backup"], "--yes", "--json", "-p", door.target]
        door.simulation.power_on()
        cut_at_the_reading_back(door)
        assert cli(*way_back).code == 6
        door.simulation.power_on()
        assert cli(*way_back).code == 0
        assert door.pages == OLD.pages
        assert load_backup(place / details["safety_backup"]).program == OLD
