"""What is recorded, under which name, with which words; read by git and by fatektool."""

from __future__ import annotations

import errno
import os
import stat
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from fatektool.errors import DataError, FatektoolError, PortBusy, UsageError
from fatektool.history.history import History
from fatektool.history.names import file_of, name_of
from fatektool.history.packing import pack_loose
from fatektool.history.repository import Repository
from fatektool.history.writing import Branch, move_branch, writing
from fatektool.program.archive import Backup, Source, load_backup
from tests.history.books import DAY, NOON, ONE, THREE, TWO, Book, git
from tests.program.samples import backup, changed, program

if TYPE_CHECKING:
    from pathlib import Path


def test_a_first_backup(book: Book) -> None:
    (found,) = book.record("press-3", ONE)
    assert found.subject == "press-3: first backup"
    assert found.changes is None
    assert book.git("rev-parse", "HEAD").strip() == found.revision
    assert book.git("show", "HEAD:press-3.json").encode() == ONE.to_bytes()
    assert book.git("ls-tree", "-r", "--name-only", "HEAD") == "press-3.json\n"
    book.fsck()


def test_a_change_is_told_in_pages_and_words(book: Book) -> None:
    source = Source("tcp://192.168.2.3:500", 7, "facon", None)
    found = book.record("press-3", ONE, replace(TWO, source=source))[-1]
    assert found.changes is not None
    assert (found.changes.page_numbers, found.changes.word_count) == ([3, 5], 2)
    assert book.git("log", "-1", "--format=%s|%an|%ae|%aI|%cn|%cI") == (
        "press-3: 2 words in 2 pages changed|press-3|station-7@192.168.2.3:500|2026-11-23T03:15:00+00:00|"
        "fatektool|2026-11-23T12:00:00+00:00\n"
    )
    assert book.git("log", "-1", "--format=%b").rstrip("\n").splitlines() == [
        "pages    3, 5",
        f"sha256   {ONE.program.sha256} before",
        f"sha256   {TWO.program.sha256} after",
        "program  FB30, 400 words",
        "source   station 7 on tcp://192.168.2.3:500, facon",
        f"read     2026-11-23T03:15:00Z by {TWO.tool}",
    ]
    assert '\n-  "' + ONE.program.pages[3].hex().upper() in book.git("log", "-p", "-1")


def test_a_new_time_status_tool_or_source_is_no_change(book: Book) -> None:
    again = replace(
        ONE,
        created="2027-01-01T00:00:00Z",
        tool="fatektool 9",
        source=replace(ONE.source, target="COM4"),
        plc=ONE.plc | {"status": ONE.plc["status"] | {"running": True, "battery_low": True}},
        passes=5,
    )
    first, second = book.record("press-3", ONE, again)
    assert (second.revision, second.subject) == (None, "press-3: unchanged")
    assert book.git("rev-parse", "HEAD").strip() == first.revision
    assert len(list(book.folder.rglob("objects/??/*"))) == 3


def test_a_ladder_of_another_size(book: Book) -> None:
    found = book.record("press-3", ONE, backup(program(500, seed=1)))[-1]
    assert found.subject.startswith("press-3: ladder size 400 -> 500 words, ")


def test_one_plc_does_not_touch_another(book: Book) -> None:
    book.record("press", ONE, TWO)
    book.record("saw", ONE)
    book.record("press", THREE)
    assert book.git("show", "--stat", "--format=", "HEAD").split("|")[0].strip() == "press.json"
    assert book.git("show", "HEAD:saw.json").encode() == ONE.to_bytes()
    assert book.history.names() == ["press", "saw"]
    book.fsck()


def test_a_clone_has_the_files(book: Book, tmp_path: Path) -> None:
    book.record("press", ONE, TWO)
    git(tmp_path, "clone", "--quiet", str(book.folder), "clone")
    assert load_backup(tmp_path / "clone" / "press.json") == TWO


def test_a_repository_that_git_made_and_packed(book: Book, tmp_path: Path) -> None:
    git(tmp_path, "init", "--quiet", "--bare", "--initial-branch=plant", str(book.folder))
    book.record("press", ONE, TWO)
    assert book.git("symbolic-ref", "HEAD") == "refs/heads/plant\n"
    book.git("gc", "--quiet", "--prune=now")
    assert not (book.folder / "refs" / "heads" / "plant").exists()
    found = book.record("press", THREE)[0]
    assert (found.subject, book.commits) == ("press: 1 word in 1 page changed", 3)
    book.fsck()


def test_nobody_else_may_read_it(book: Book) -> None:
    before = os.umask(0)
    try:
        book.record("press", ONE)
        with Repository(book.folder) as repository:
            pack_loose(repository)
    finally:
        os.umask(before)
    for path in (book.folder, *book.folder.rglob("*")):
        assert not stat.S_IMODE(path.stat().st_mode) & 0o007, path


# --- names ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name",
    ["", ".", "..", ".git", "../x", "a/b", "a\\b", "/etc/x", "-f", "a b", "a@b", "a\n", "a\0", "C:x", "CON",
     "nul.x", "COM3", "x" * 65, "\ud800", "\u202ea", "*", "\U0001d4b3" * 64],
)  # fmt: skip
def test_what_is_no_name(book: Book, name: str) -> None:
    with pytest.raises(UsageError, match="is not a valid name for a PLC"):
        book.history.record(name, ONE)
    assert not book.folder.exists()


@given(st.text(max_size=70))
@example("press-3")
@example("Straße.7_ß")
def test_a_name_is_refused_or_a_file_in_one_folder(name: str) -> None:
    try:
        file = file_of(name)
    except UsageError:
        assert name_of(name.encode(errors="surrogatepass") + b".json") is None
        return
    assert name_of(file) == name
    assert len(file) <= 255
    assert not {*b'/\\\0\n:@"*?<>|'} & {*file}
    assert not file.startswith((b".", b"-"))


@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(target=st.text(min_size=1, max_size=40), tool=st.text(max_size=20), words=st.integers(1, 500))
@example(target="tcp://a> <b\n\nparent 0000\0", tool="\x1b[2J\r\n", words=1)
@example(target="\udc80:", tool="", words=64)
def test_whatever_a_backup_is_called_git_takes_it(book: Book, target: str, tool: str, words: int) -> None:
    made = backup(program(words, seed=len(target)))
    new = replace(made, source=replace(made.source, target=target), tool=tool)
    found = book.history.record("press", new)
    if found.revision is not None:
        text = book.git("log", "-1", "--format=%an%n%B")
        assert text.isprintable() or set(filter(lambda char: not char.isprintable(), text)) == {"\n"}
        assert book.history.show("press").backup == new
        book.fsck()


def test_names_that_differ_in_case_alone(book: Book) -> None:
    book.record("press", ONE)
    with pytest.raises(
        UsageError, match=r"'PRESS' differs only in case from 'press' in the history .* the same file"
    ):
        book.history.record("PRESS", TWO)


# --- places ---------------------------------------------------------------------------------------------


def test_a_folder_with_other_things(book: Book) -> None:
    book.folder.mkdir()
    (book.folder / "holiday.jpg").write_bytes(b"")
    with pytest.raises(
        UsageError, match=r"neither empty nor a bare git repository: it contains 'holiday.jpg'"
    ):
        book.history.record("press", ONE)
    assert [path.name for path in book.folder.iterdir()] == ["holiday.jpg"]


def test_a_folder_in_no_folder(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"cannot write .*No such file"):
        History(tmp_path / "a" / "b").record("press", ONE)


def test_a_repository_with_a_work_tree(book: Book, tmp_path: Path) -> None:
    git(tmp_path, "init", "--quiet", str(book.folder))
    for ask in (lambda: book.history.record("press", ONE), book.history.names):
        with pytest.raises(FatektoolError, match=r"work tree|neither empty nor"):
            ask()


# --- who holds it ---------------------------------------------------------------------------------------


def test_another_process_that_goes_on(book: Book) -> None:
    book.record("press", ONE)
    with writing(book.folder, 0.0), pytest.raises(PortBusy, match=f"in use by process {os.getpid()}"):
        book.history.record("press", TWO)
    assert book.record("press", TWO)[0].revision


def test_a_branch_that_git_holds(book: Book) -> None:
    book.record("press", ONE)
    lock = book.folder / "refs" / "heads" / "main.lock"
    lock.write_bytes(b"")
    with pytest.raises(PortBusy, match=r"locked by another git program: .*main.lock exists"):
        book.history.record("press", TWO)
    assert lock.exists()
    os.utime(lock, (NOON - DAY, NOON - DAY))  # whoever that was, it is long gone
    assert book.record("press", TWO)[0].revision
    assert not lock.exists()
    book.fsck()


def test_what_a_killed_run_left_at_the_branch(book: Book) -> None:
    book.record("press", ONE)
    stage = book.folder / "fatektool.ref"
    stage.write_bytes(b"1" * 40 + b"\n")
    (book.folder / "refs" / "heads" / "main.lock").hardlink_to(stage)
    assert book.record("press", TWO)[0].revision
    assert not stage.exists()
    assert book.commits == 2
    book.fsck()


def test_where_there_are_no_hard_links(book: Book, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise PermissionError(errno.EPERM, "no hard links")

    monkeypatch.setattr("os.link", fail)
    book.record("press", ONE, TWO)
    lock = book.folder / "refs" / "heads" / "main.lock"
    lock.write_bytes(b"of another git")
    with pytest.raises(PortBusy):
        book.history.record("press", THREE)
    assert lock.read_bytes() == b"of another git"
    book.fsck()


def test_a_push_into_it_in_between(book: Book) -> None:
    """What was read is no longer so when the branch is to be moved: nothing is cut off."""
    first = book.record("press", ONE)[0].revision
    second = book.record("press", TWO)[0].revision
    assert first
    assert second
    with writing(book.folder, 0.0), Repository(book.folder) as repository:
        branch = Branch(book.folder, repository.branch(), repository.rights)
        assert not move_branch(branch, first, lambda: repository.tip() == first, wait_s=0.0)
        assert repository.tip() == second
    assert not list(book.folder.rglob("*.lock"))[1:]
    assert book.commits == 2


# --- packs ----------------------------------------------------------------------------------------------


def test_many_files_become_one(book: Book, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fatektool.history.packing.MANY", 9)
    book.record("press", ONE, TWO)
    assert "count: 6\n" in book.git("count-objects", "-v")
    book.record("press", THREE)
    assert "count: 0\n" in book.git("count-objects", "-v")
    assert "in-pack: 9\n" in book.git("count-objects", "-v")
    assert [book.history.show("press", f"~{n}").backup for n in range(3)] == [THREE, TWO, ONE]
    assert book.record("press", ONE)[0].revision
    book.fsck()


def test_what_killed_runs_left_is_taken_away(book: Book) -> None:
    """dulwich's and our own unfinished files at once; a pack without an index only when it is an hour old."""
    book.record("press", ONE)
    objects = book.folder / "objects"
    (objects / "30").mkdir(exist_ok=True)
    old, new = (objects / "pack" / f"pack-{digit * 40}.pack" for digit in "12")
    left = [
        objects / "30" / "tmp_obj_fatektool-1",
        objects / "pack" / "tmp1.pack",
        old.with_suffix(".idx.lock"),
        old,
    ]
    for path in (*left, new):
        path.write_bytes(b"left by a killed run")
    os.utime(old, (NOON - DAY, NOON - DAY))
    with writing(book.folder, 0.0), Repository(book.folder) as repository:
        assert pack_loose(repository) == 3
    assert [path for path in left if path.exists()] == []
    assert new.exists()


def test_a_pack_that_cannot_be_made_is_a_warning(book: Book, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: object) -> int:
        raise DataError("no room")

    monkeypatch.setattr("fatektool.history.history.is_due", lambda _: True)
    monkeypatch.setattr("fatektool.history.history.pack_loose", fail)
    found = book.record("press", ONE)[0]
    assert found.warnings == ("the history could not be packed: no room",)
    assert book.history.show("press").backup == ONE


def test_a_damaged_file_is_left_for_check_to_name(book: Book) -> None:
    book.record("press", ONE)
    (path,) = (book.folder / "objects" / book.git("rev-parse", "HEAD:press.json")[:2]).iterdir()
    path.write_bytes(b"no zlib")
    with writing(book.folder, 0.0), Repository(book.folder) as repository:
        assert pack_loose(repository) == 2
    assert path.exists()


# --- reading --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("revision", "found"),
    [
        ("HEAD", THREE),
        ("HEAD~0", THREE),
        ("HEAD~1", TWO),
        ("HEAD~2", TWO),  # that commit was the saw's
        ("~0", THREE),
        ("~1", TWO),
        ("~2", ONE),
        ("2026-11-22", ONE),
        ("2026-11-24", TWO),
        ("2026-11-25", THREE),
        ("2026-11-25T11:59:59Z", TWO),
        ("2026-11-25T12:00Z", THREE),
        ("2100-01-01", THREE),
    ],
)
def test_revisions(book: Book, revision: str, found: Backup) -> None:
    book.record("press", ONE, TWO)
    book.record("saw", ONE)
    book.record("press", THREE)
    stored = book.history.show("press", revision)
    assert stored.backup == found
    assert stored.data == found.to_bytes()
    assert book.git("show", f"{stored.commit.revision}:press.json").encode() == stored.data
    assert book.history.show("press", stored.commit.revision[:9].upper()).commit == stored.commit


@pytest.mark.parametrize(
    ("revision", "message"),
    [
        ("~3", "there is no revision press@~3"),
        ("HEAD~9", "there is no revision"),
        ("2026-11-21", "there is no revision"),
        ("2026-02-30", "is not a valid date"),
        ("0000000", "there is no revision"),
        ("abc", "is not a revision: expected a hash"),
        ("main", "is not a revision"),
        ("HEAD~x", "is not a revision"),
        ("--all", "is not a revision"),
    ],
)
def test_what_is_no_revision(book: Book, revision: str, message: str) -> None:
    book.record("press", ONE, TWO, THREE)
    with pytest.raises(UsageError, match=message):
        book.history.show("press", revision)


def test_log(book: Book) -> None:
    book.record("press", ONE)
    book.record("saw", ONE)
    book.record("press", TWO)
    found = [(change.name, change.commit.subject) for change in book.history.log()]
    assert found == [
        ("press", "press: 2 words in 2 pages changed"),
        ("saw", "saw: first backup"),
        ("press", "press: first backup"),
    ]
    assert [change.commit.time for change in book.history.log("press")] == [NOON + 2 * DAY, NOON]
    for ask in (lambda: list(book.history.log("pres")), lambda: book.history.show("pres")):
        with pytest.raises(UsageError, match=r"no PLC 'pres' in the history .*; did you mean press\?"):
            ask()


def test_commits_that_somebody_else_made(book: Book, tmp_path: Path) -> None:
    """A file taken out and put back, another beside it, a merge: read like any other."""
    book.record("press", ONE, TWO)
    git(tmp_path, "clone", "--quiet", str(book.folder), "clone")
    clone = tmp_path / "clone"
    for words in (["config", "user.name", "A \x1b[2J"], ["config", "user.email", "a@b"]):
        git(clone, *words)
    (clone / "notes").mkdir()
    (clone / "notes" / "press.txt").write_text("grease it", encoding="utf-8")
    git(clone, "rm", "--quiet", "press.json")
    git(clone, "add", "notes")
    git(clone, "commit", "--quiet", "-m", "Taken\x1b[31m out")
    git(clone, "push", "--quiet")
    change = next(book.history.log("press"))
    assert (change.removed, change.commit.subject) == (True, "Taken?[31m out")
    with pytest.raises(UsageError, match="no PLC 'press' in the history"):
        book.history.show("press")
    assert book.history.show("press", "~1").backup == TWO
    assert book.record("press", THREE)[0].subject == "press: first backup"
    assert book.git("show", "HEAD:notes/press.txt") == "grease it"
    book.fsck()


def test_diff_and_export(book: Book, tmp_path: Path) -> None:
    book.record("press", ONE, TWO, THREE)
    assert book.history.diff("press").page_numbers == [6]
    assert book.history.diff("press", "~2").page_numbers == [3, 5, 6]
    assert book.history.diff("press", "~2", "~2").same
    book.history.export("press", "~1", tmp_path / "x.json")
    assert load_backup(tmp_path / "x.json") == TWO
    with pytest.raises(UsageError, match="exists already and is kept"):
        book.history.export("press", "~1", tmp_path / "x.json")


def test_an_image_whose_header_does_not_hold(book: Book) -> None:
    odd = replace(ONE, program=changed(ONE.program, 0))
    assert [found.revision is not None for found in book.record("press", odd, odd)] == [True, False]
    assert book.history.show("press").backup == odd
