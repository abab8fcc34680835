"""What a record and a question cost, counted: objects read and written, syncs, openings. No clock."""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from fatektool.history.checking import check
from fatektool.history.packing import pack_loose
from fatektool.history.repository import Repository
from fatektool.history.writing import writing
from fatektool.program.image import Program
from tests.history.books import ONE, THREE, TWO, Book

if TYPE_CHECKING:
    from pathlib import Path

    from fatektool.program.archive import Backup

PLCS = [f"plc-{number}" for number in range(8)]


@pytest.fixture
def reads(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often each object is read, from now on."""
    found: Counter[str] = Counter()
    read = Repository.any_object

    def counted(repository: Repository, sha: str) -> tuple[str, bytes]:
        found[sha] += 1
        return read(repository, sha)

    monkeypatch.setattr(Repository, "any_object", counted)
    return found


@pytest.fixture
def syncs(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The descriptors that are synced, from now on."""
    found: list[int] = []
    sync = os.fsync

    def counted(descriptor: int) -> None:
        found.append(descriptor)
        sync(descriptor)

    monkeypatch.setattr(os, "fsync", counted)
    return found


@pytest.fixture
def openings(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The repositories that are opened, from now on."""
    found: list[Path] = []

    class Counted(Repository):
        def __init__(self, folder: Path) -> None:
            found.append(folder)
            super().__init__(folder)

    monkeypatch.setattr("fatektool.history.history.Repository", Counted)
    return found


def version(night: int) -> Backup:
    """A program that no other night has."""
    pages = list(ONE.program.pages)
    pages[2] = night.to_bytes(128, "big")
    return replace(ONE, program=Program(ONE.program.ladder_words, tuple(pages)))


def years(book: Book, nights: int) -> None:
    """All PLCs, then so many nights in which the last one changes."""
    for name in PLCS:
        book.record(name, ONE)
    book.record(PLCS[-1], *map(version, range(nights)))


def objects(book: Book, *kinds: str) -> set[str]:
    """All objects, or those of some kinds."""
    lines = map(str.split, book.git("cat-file", "--batch-all-objects", "--batch-check").splitlines())
    return {sha for sha, kind, _ in lines if not kinds or kind in kinds}


@pytest.mark.parametrize(("nights", "packed"), [(0, False), (20, False), (20, True)])
def test_a_round_of_unchanged_programs(
    book: Book, reads: Counter[str], syncs: list[int], nights: int, *, packed: bool
) -> None:
    """One blob a PLC, and commit and tree once, however long the history is; nothing is written."""
    years(book, nights)
    if packed:
        with writing(book.folder, 0.0), Repository(book.folder) as repository:
            assert pack_loose(repository) > 40
    before = objects(book)
    reads.clear()
    syncs.clear()
    with book.history as history:
        assert [history.record(name, ONE).revision for name in PLCS[:-1]] == [None] * 7
    blobs = objects(book, "blob") & reads.keys()
    assert sum(reads[sha] for sha in blobs) == 7
    assert [reads[sha] for sha in reads.keys() - blobs] == [1, 1]
    assert syncs == []
    assert objects(book) == before


def test_a_round_opens_the_repository_once(book: Book, openings: list[Path]) -> None:
    with book.history as history:
        for backup in (ONE, ONE, TWO, TWO):
            for name in PLCS:
                history.record(name, backup)
    assert len(openings) == 1


@pytest.mark.parametrize("nights", [0, 20])
def test_a_changed_program(book: Book, reads: Counter[str], syncs: list[int], nights: int) -> None:
    """Three objects, and eight syncs: each object and its folder, the branch and its own."""
    years(book, nights)
    for number in range(256):  # each would be synced into its parent once
        (book.folder / "objects" / f"{number:02x}").mkdir(exist_ok=True)
    before = objects(book)
    reads.clear()
    syncs.clear()
    with book.history as history:
        assert history.record(PLCS[1], THREE).revision
        assert (sorted(reads.values()), len(syncs)) == ([1, 1, 1], 8)
        new = objects(book) - before
        assert len(new) == 3
        assert history.record(PLCS[1], THREE).revision is None  # of what is new the blob alone is read
        assert (sorted(reads.values()), len(syncs)) == ([1, 1, 1, 1], 8)
        assert new & reads.keys() == objects(book, "blob") & new


def test_a_record_by_itself_opens_what_it_needs(book: Book, openings: list[Path]) -> None:
    book.record("press", ONE)
    assert len(openings) == 1
    book.record("press", ONE)
    assert len(openings) == 2


def test_log_reads_each_commit_and_tree_once_and_no_program(book: Book, reads: Counter[str]) -> None:
    years(book, 20)
    for name, changes in ((PLCS[-1], 21), (PLCS[0], 1), (None, 28)):
        reads.clear()
        assert len(list(book.history.log(name))) == changes
        assert reads == dict.fromkeys(objects(book, "commit", "tree"), 1)


def test_the_newest_ten_read_eleven_commits(book: Book, reads: Counter[str]) -> None:
    years(book, 20)
    reads.clear()
    changes = book.history.log()
    for _ in range(10):
        next(changes)
    changes.close()
    assert reads.total() == 2 * 11


def test_show_reads_back_to_the_change_and_no_further(book: Book, reads: Counter[str]) -> None:
    """Its own program alone, and each commit and tree behind it once more for what it was recorded with."""
    years(book, 20)
    reads.clear()
    book.history.show(PLCS[-1])
    assert reads.total() == 2 + 2 * 2 + 1
    assert sum(reads[sha] for sha in objects(book, "blob")) == 1


@pytest.mark.parametrize("packed", [False, True])
def test_check_reads_every_object_once(book: Book, reads: Counter[str], *, packed: bool) -> None:
    years(book, 12)
    if packed:
        book.git("gc", "--quiet")
    reads.clear()
    found = check(book.folder)
    assert (found.commits, found.faults) == (book.commits, ())
    assert reads == dict.fromkeys(objects(book), 1)
