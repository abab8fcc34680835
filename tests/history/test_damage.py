"""Damage is told in the project's words, by what reads and by ``check``; recording goes on where it can."""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import DataError, FatektoolError
from fatektool.history.checking import check
from tests.history.books import ONE, THREE, TWO, Book, git

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def place_of(book: Book, what: str) -> Path:
    sha = book.git("rev-parse", what).strip()
    return book.folder / "objects" / sha[:2] / sha[2:]


def wreck(path: Path, data: bytes | None) -> None:
    path.chmod(0o640)
    path.unlink() if data is None else path.write_bytes(data)


OTHER = zlib.compress(b"blob 3\0abc")
WRECKS = [None, b"", b"no zlib", zlib.compress(b"blob 99\0abc"), zlib.compress(b"nonsense"), OTHER]


def test_a_whole_history(book: Book) -> None:
    book.record("press", ONE, TWO)
    book.record("saw", THREE)
    steps: list[tuple[str, int, int]] = []
    found = check(book.folder, lambda *step: steps.append(step))
    assert (found.commits, found.programs, found.names, found.faults) == (3, 3, ("press", "saw"), ())
    assert steps == [("checking", number, 3) for number in (1, 2, 3)]


@pytest.mark.parametrize("data", WRECKS)
def test_a_damaged_program(book: Book, data: bytes | None) -> None:
    book.record("press", ONE, TWO)
    wreck(place_of(book, "HEAD:press.json"), data)
    (fault,) = check(book.folder).faults
    assert (fault.name, fault.revision) == ("press", book.git("rev-parse", "HEAD").strip())
    with pytest.raises(DataError, match="fatektool history check"):
        book.history.show("press")
    assert book.history.show("press", "~1").backup == ONE
    found = book.record("press", THREE)[0]
    assert found.subject == "press: new backup, the previous one is damaged"
    assert "the previous backup cannot be read" in found.warnings[0]
    assert book.history.show("press").backup == THREE


@pytest.mark.parametrize("data", WRECKS)
def test_the_same_program_after_damage(book: Book, data: bytes | None) -> None:
    """The very file that is damaged is written again."""
    book.record("press", ONE, TWO)
    wreck(place_of(book, "HEAD:press.json"), data)
    assert book.record("press", TWO)[0].revision
    assert book.history.show("press").backup == TWO


def test_the_same_program_after_damage_in_a_pack(book: Book) -> None:
    """It is written beside the pack, and read from there."""
    book.record("press", ONE, TWO)
    book.git("gc", "--quiet")
    (pack,) = book.folder.glob("objects/pack/*.pack")
    found = pack.read_bytes()
    middle = len(found) // 2  # within the newest program, which fills most of it
    wreck(pack, found[:middle] + bytes(40) + found[middle + 40 :])
    with pytest.raises(DataError):
        book.history.show("press")
    assert book.record("press", TWO)[0].revision
    assert book.history.show("press").backup == TWO


@pytest.mark.parametrize("data", WRECKS)
@pytest.mark.parametrize("what", ["HEAD", "HEAD^{tree}"])
def test_a_damaged_commit_or_tree(book: Book, what: str, data: bytes | None) -> None:
    book.record("press", ONE, TWO)
    tip = book.git("rev-parse", "HEAD").strip()
    wreck(place_of(book, what), data)
    (fault,) = check(book.folder).faults
    assert (fault.name, fault.revision) == (None, tip)
    for ask in (
        lambda: book.history.show("press"),
        lambda: list(book.history.log()),
        lambda: book.history.record("press", THREE),
    ):
        with pytest.raises(DataError, match=r"run 'fatektool history check' and 'git fsck'"):
            ask()
    assert (book.folder / "refs/heads/main").read_text(encoding="utf-8") == f"{tip}\n"


def test_a_tree_that_is_none(book: Book, tmp_path: Path) -> None:
    """Its hash is right, and its bytes are no tree."""
    book.record("press", ONE)
    (tmp_path / "tree").write_bytes(b"100644 press.json")
    tree = book.git("hash-object", "-t", "tree", "-w", "--literally", str(tmp_path / "tree")).strip()
    person = ("-c", "user.name=A", "-c", "user.email=a@b")
    tip = book.git(*person, "commit-tree", tree, "-p", "HEAD", "-m", "No tree").strip()
    book.git("update-ref", "refs/heads/main", tip)
    (fault,) = check(book.folder).faults
    assert (fault.name, fault.revision) == (None, tip)
    for ask in (lambda: book.history.show("press"), lambda: book.history.record("press", TWO)):
        with pytest.raises(DataError, match=f"tree {tree} cannot be read"):
            ask()


@pytest.mark.parametrize("data", [b"", b"\n", b"0" * 39 + b"\n", b"ref: x", b"\xff" * 40, b"0" * 40])
def test_a_damaged_branch_is_not_one_that_begins(book: Book, data: bytes) -> None:
    book.record("press", ONE)
    (book.folder / "refs/heads/main").write_bytes(data)
    for ask in (lambda: book.history.show("press"), lambda: book.history.record("press", TWO)):
        with pytest.raises(DataError):
            ask()
    assert len(check(book.folder).faults) == 1
    assert (book.folder / "refs/heads/main").read_bytes() == data


@pytest.mark.parametrize(
    ("file", "data"),
    [
        ("HEAD", b""),
        ("HEAD", b"0" * 40 + b"\n"),
        ("HEAD", b"ref: refs/heads/../../config\n"),
        ("config", b"[core\n"),
        ("config", b"[core]\n\trepositoryformatversion = 1\n[extensions]\n\tobjectformat = sha256\n"),
        ("packed-refs", b"\xff\xfe no refs\n"),
    ],
)
def test_damage_around_the_objects(book: Book, file: str, data: bytes) -> None:
    book.record("press", ONE)
    if file == "packed-refs":
        (book.folder / "refs/heads/main").unlink()
    (book.folder / file).write_bytes(data)
    for ask in (lambda: book.history.show("press"), lambda: book.history.record("press", TWO)):
        with pytest.raises(FatektoolError):
            ask()


@pytest.mark.parametrize("cut", [lambda data: data[:-30], lambda data: data[:40] + b"\0" * 40 + data[80:]])
def test_a_damaged_pack(book: Book, cut: Callable[[bytes], bytes]) -> None:
    book.record("press", ONE, TWO)
    book.git("gc", "--quiet")
    (pack,) = book.folder.glob("objects/pack/*.pack")
    wreck(pack, cut(pack.read_bytes()))
    with pytest.raises(DataError):
        [book.history.show("press", each) for each in ("~0", "~1")]
    assert check(book.folder).faults


def test_a_file_that_was_edited_with_git(book: Book, tmp_path: Path) -> None:
    """Whole for git, and no backup any more."""
    book.record("press", ONE)
    git(tmp_path, "clone", "--quiet", str(book.folder), "clone")
    clone = tmp_path / "clone"
    file = clone / "press.json"
    file.write_bytes(file.read_bytes().replace(b'"FB30"', b'"FB31"'))
    git(clone, "-c", "user.name=A", "-c", "user.email=a@b", "commit", "--quiet", "-am", "Edited")
    git(clone, "push", "--quiet")
    (fault,) = check(book.folder).faults
    assert fault.name == "press"
    assert "header.signature (page 0): expected 'FB30' from the pages, got 'FB31'" in fault.message
    with pytest.raises(DataError, match="the file is damaged or was edited"):
        book.history.show("press")


@pytest.mark.parametrize("made", [None, "file", "empty"])
def test_what_is_no_history(tmp_path: Path, made: str | None) -> None:
    place = tmp_path / "x"
    if made == "file":
        place.write_bytes(b"")
    elif made == "empty":
        place.mkdir()
    with pytest.raises(FatektoolError, match=r"no history|not a git repository") as raised:
        check(place)
    assert raised.value.exit_code == (5 if made == "empty" else 2)
