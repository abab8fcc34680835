"""A round keeps the repository open: others may write, pack and damage it meanwhile."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import DataError, UsageError
from fatektool.history.history import History
from fatektool.history.writing import writing
from tests.history.books import ONE, THREE, TWO, Book

if TYPE_CHECKING:
    from pathlib import Path


def test_what_another_one_records_meanwhile_is_seen(book: Book) -> None:
    book.record("press", ONE)
    with History(book.folder, wait_s=0.0) as history:
        assert history.record("press", ONE).revision is None
        book.record("press", TWO)
        book.record("saw", ONE)
        assert history.record("press", TWO).revision is None
        assert history.record("press", THREE).subject == "press: 1 word in 1 page changed"
    assert book.commits == 4
    assert book.history.names() == ["press", "saw"]
    book.fsck()


def test_git_may_pack_it_meanwhile(book: Book) -> None:
    book.record("press", ONE, TWO)
    with book.history as history:
        for newest in (TWO, THREE, ONE):
            history.record("press", newest)
            book.git("gc", "--quiet", "--prune=now")
            assert not (book.folder / "refs" / "heads" / "main").exists()
            assert history.record("press", newest).revision is None
    assert book.commits == 4
    book.fsck()


def test_one_that_has_been_put_back_is_read_anew(book: Book, tmp_path: Path) -> None:
    """What was wrong in a round is wrong for one PLC, not for all that come after it."""
    book.record("press", ONE)
    with book.history as history:
        assert history.record("press", ONE).revision is None
        shutil.move(book.folder, tmp_path / "aside")
        book.folder.mkdir()
        (book.folder / "holiday.jpg").touch()
        with pytest.raises(UsageError, match="neither empty nor"):
            history.record("press", TWO)
        shutil.rmtree(book.folder)
        shutil.move(tmp_path / "aside", book.folder)
        assert history.record("press", TWO).revision
    book.fsck()


def test_damage_in_a_round(book: Book) -> None:
    book.record("press", ONE, TWO)
    branch = book.folder / "refs" / "heads" / "main"
    whole = branch.read_bytes()
    with book.history as history:
        assert history.record("press", TWO).revision is None
        branch.write_bytes(b"no hash")
        for newest in (TWO, THREE):
            with pytest.raises(DataError, match="expected 40 hex digits"):
                history.record("press", newest)
        branch.write_bytes(whole)
        assert history.record("press", THREE).revision
    book.fsck()


def test_nobody_is_waited_for_where_nothing_changed(book: Book) -> None:
    book.record("press", ONE)
    with writing(book.folder, 0.0):
        assert book.history.record("press", ONE).revision is None


def test_the_end_of_a_round_does_not_wait_for_a_thread(book: Book, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fatektool.history.history._PATIENCE_S", 0.0)
    book.record("press", ONE)
    history = History(book.folder)
    with history:
        history.record("press", ONE)
        history._turn.acquire()  # a thread is at it
    history._turn.release()
    assert history.record("press", ONE).revision is None  # and leaves nothing open behind it
    assert history._kept is None
