"""Several users, one history: ``core.sharedRepository`` as git itself takes it. And shallow clones."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.errors import DataError, UsageError
from fatektool.history.checking import check
from fatektool.history.packing import pack_loose
from fatektool.history.push import push
from fatektool.history.repository import Repository
from fatektool.history.writing import writing
from tests.history.books import GIT, ONE, THREE, TWO, Book, git
from tests.root import ROOT
from tests.users import two_users

if TYPE_CHECKING:
    from collections.abc import Iterator

posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such rights")

GROUP, FIRST, SECOND = 64100, 64101, 64102  # of nobody
ROUNDS = 24
USER = """
import glob, os, pathlib, sys, tempfile  # all that is loaded later: another user may not read this Python
from tests.history.books import ONE, Book
from tests.program.samples import changed
from dataclasses import replace
from fatektool.history import checking, packing, repository, writing
with tempfile.TemporaryDirectory() as name:
    Book(pathlib.Path(name) / "h").record("x", ONE)
user, group, name, folder, umask = sys.argv[1:]
os.umask(int(umask, 8)); os.setgroups([]); os.setgid(int(group)); os.setuid(int(user))
book, program = Book(pathlib.Path(folder)), ONE.program
packing.MANY = 60
for number, line in enumerate(sys.stdin):
    program = changed(program, 1 + number % 6)
    (done,) = book.record(name, replace(ONE, program=program))
    print(done.revision, *done.warnings, flush=True)
"""


def rights(path: Path) -> str:
    return f"{stat.S_IMODE(path.stat().st_mode):04o}"


@posix
@pytest.mark.parametrize(
    ("value", "folders", "files", "packs"),
    [
        (None, "0750", "0640", "0440"),
        ("umask", "0750", "0640", "0440"),
        ("group", "2770", "0660", "0440"),
        ("true", "2770", "0660", "0440"),
        ("all", "2775", "0664", "0444"),
        ("0660", "2770", "0660", "0440"),
        ("0600", "0700", "0600", "0400"),
    ],
)
def test_rights(book: Book, value: str | None, folders: str, files: str, packs: str) -> None:
    git(book.folder.parent, "init", "--quiet", "--bare", "--initial-branch=main", book.folder.name)
    if value is not None:
        book.git("config", "core.sharedRepository", value)
    before = os.umask(0o027)
    try:
        (done,) = book.record("press", ONE)
    finally:
        os.umask(before)
    assert done.revision
    place = book.folder / "objects" / done.revision[:2]
    assert rights(place) == folders
    made = [
        place / done.revision[2:],
        book.folder / "refs" / "heads" / "main",
        book.folder / "fatektool.lock",
    ]
    assert [rights(path) for path in made] == [files] * 3
    with writing(book.folder, 0.0), Repository(book.folder) as repository:
        pack_loose(repository)
    assert {rights(path) for path in (book.folder / "objects" / "pack").iterdir()} == {packs}
    book.fsck()


@pytest.fixture
def shared() -> Iterator[Path]:
    """A shared repository of two users, in a place that both reach."""
    with tempfile.TemporaryDirectory() as name:
        Path(name).chmod(0o755)
        folder = Path(name) / "history"
        git(Path(name), "init", "--quiet", "--bare", "--shared=group", "--initial-branch=main", "history")
        for path in (folder, *folder.rglob("*")):
            os.chown(path, FIRST, GROUP)
        yield folder


def user(number: int, name: str, folder: Path, umask: str) -> subprocess.Popen[str]:
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    return subprocess.Popen(
        [sys.executable, "-c", USER, str(number), str(GROUP), name, str(folder), umask],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment,
    )  # fmt: skip


def as_user(number: int, folder: Path, *words: str) -> str:
    """Run git as a user."""
    options: dict[str, Any] = {"user": number, "group": GROUP, "extra_groups": []}
    home = {"HOME": str(folder.parent), "GIT_CONFIG_NOSYSTEM": "1", "PATH": os.environ["PATH"]}
    done = subprocess.run(
        [GIT, "-C", str(folder), "--git-dir=.", *words],
        capture_output=True, text=True, check=False, env=home, **options,
    )  # fmt: skip
    assert done.returncode == 0, done
    return str(done.stdout)


@two_users
@pytest.mark.parametrize("umask", ["022", "077"])
def test_two_users_in_turns(shared: Path, umask: str) -> None:
    """As many rounds as make both write into folders of objects of the other's, and packs in between."""
    seen = []
    with user(FIRST, "press", shared, umask) as one, user(SECOND, "oven", shared, umask) as two:
        for _ in range(ROUNDS):
            for process in (one, two):
                assert process.stdin is not None
                assert process.stdout is not None
                process.stdin.write("\n")
                process.stdin.flush()
                seen.append(process.stdout.readline().split())
        for process in (one, two):
            assert process.stdin is not None
            process.stdin.close()
    assert all(len(line) == 1 for line in seen), seen  # a revision, and no warning
    assert as_user(SECOND, shared, "rev-list", "--count", "HEAD") == f"{2 * ROUNDS}\n"
    assert list((shared / "objects" / "pack").glob("*.pack"))
    as_user(FIRST, shared, "fsck", "--strict", "--full")
    for number in (SECOND, FIRST):
        as_user(number, shared, "gc", "--quiet", "--prune=now")
    found = check(shared)
    assert (found.commits, found.faults) == (2 * ROUNDS, ())


@two_users
def test_another_user_where_nothing_is_shared(shared: Path) -> None:
    """It is said what lets several users write."""
    git(shared, "-c", f"safe.directory={shared}", "config", "--unset", "core.sharedRepository")
    script = USER.replace("for number", "from fatektool.errors import FatektoolError\nfor number").replace(
        "    (done,)", "    try: book.record(name, replace(ONE, program=program))\n"
        "    except FatektoolError as error: print(error, flush=True); continue\n    (done,)"
    )  # fmt: skip
    shared.chmod(0o750)
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", script, str(SECOND), str(GROUP), "oven", str(shared), "022"],
        input="\n", capture_output=True, text=True, check=False, env=environment,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(f"cannot write {shared}: Permission denied: ")
    assert f"git -C {shared} config core.sharedRepository group" in done.stdout


# --- shallow clones ---------------------------------------------------------------------------------------


@pytest.fixture
def shallow(book: Book) -> Book:
    book.record("press", ONE, TWO, THREE)
    place = book.folder.parent / "shallow"
    git(book.folder.parent, "clone", "--quiet", "--bare", "--depth=2", f"file://{book.folder}", place.name)
    clone = Book(place)
    clone.now = book.now
    return clone


def test_a_shallow_clone_is_whole(shallow: Book) -> None:
    found = check(shallow.folder)
    assert (found.commits, found.programs, found.faults, found.shallow) == (2, 2, (), True)
    assert len(list(shallow.history.log("press"))) == 2
    assert shallow.history.show("press", "~1").backup == TWO
    with pytest.raises(UsageError, match=r"it is a shallow clone; .*run: git -C .* fetch --unshallow$"):
        shallow.history.show("press", "~2")


@pytest.mark.parametrize("by", ["git", "dulwich"])
def test_a_shallow_clone_is_written(
    shallow: Book, book: Book, monkeypatch: pytest.MonkeyPatch, by: str
) -> None:
    if by == "dulwich":
        monkeypatch.setenv("PATH", str(book.folder))  # no git there
    assert shallow.record("press", ONE)[0].revision
    assert check(shallow.folder).commits == 3
    assert push(shallow.folder, "origin").sent
    shallow.git("fetch", "--quiet", "--unshallow")
    assert (check(book.folder).commits, check(shallow.folder).commits) == (4, 4)
    assert not check(shallow.folder).shallow
    shallow.fsck()


def test_a_list_of_cuts_that_is_none(shallow: Book) -> None:
    (shallow.folder / "shallow").write_text("what\n")
    with pytest.raises(DataError, match="the repository cannot be read"):
        check(shallow.folder)
