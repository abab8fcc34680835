"""Two at once, a killed run, a full disk: git finds the repository whole, and the next run goes on."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from fatektool.history.checking import check
from fatektool.history.history import History
from fatektool.history.packing import pack_loose
from fatektool.history.repository import Repository
from fatektool.history.writing import writing
from tests.history.books import Book, git
from tests.history.crash import ONE, TWO

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="ends processes by fork and signal")

RECORDER = """
import sys
from pathlib import Path
from tests.history.crash import ONE, TWO
from fatektool.history.history import History
history = History(Path(sys.argv[1]))
for number in range(12):
    history.record(f"{sys.argv[2]}-{number % 4}", (ONE, TWO)[number // 4 % 2])
"""


def crashed(how: str, folder: Path, first: int, step: int) -> list[Path]:
    """The histories of a series of crashes."""
    command = [sys.executable, "-m", "tests.history.crash", how, str(folder), str(first), str(step)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return [folder / str(number) for number in range(first, int(done.stdout) + 1, step)]


@pytest.mark.parametrize(
    ("how", "first", "step", "least"), [("kill", 0, 5, 8), ("full", 1, 5, 7), ("short", 1, 509, 4)]
)
def test_whenever_it_ends(tmp_path: Path, how: str, first: int, step: int, least: int) -> None:
    places = crashed(how, tmp_path, first, step)
    assert len(places) >= least
    for place in places:
        book = Book(place)
        if (place / "HEAD").exists():
            book.fsck()
            versions = {stored.commit.subject for stored in book.history.log()}
            if int(place.name) % 2:
                assert "press: first backup" in versions
            assert not check(place).faults
        else:
            assert int(place.name) % 2 == 0
        history = History(place, wait_s=0.0)
        history.record("press", TWO)
        assert history.show("press").backup.program == TWO.program
        assert len(list(history.log("press"))) == 1 + int(place.name) % 2
        history.record("press", ONE)  # nothing is in the way of the next night
        with writing(place, 0.0), Repository(place) as repository:
            assert pack_loose(repository) >= 3
        book.fsck()
        assert not check(place).faults
        assert [path.name for path in place.rglob("*.lock")] == ["fatektool.lock"]


def test_two_at_once_lose_nothing(book: Book, tmp_path: Path) -> None:
    """From the very first: both make the repository."""
    running = [
        subprocess.Popen([sys.executable, "-c", RECORDER, str(book.folder), name])
        for name in ("press", "saw")
    ]
    assert [each.wait() for each in running] == [0, 0]
    assert book.commits == 24
    assert {name: len(list(book.history.log(name))) for name in book.history.names()} == {
        f"{name}-{number}": 3 for name in ("press", "saw") for number in range(4)
    }
    book.fsck()
    git(tmp_path, "clone", "--quiet", str(book.folder), "clone")


def test_threads_may_share_one(book: Book) -> None:
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda number: book.history.record(f"press-{number}", ONE), range(16)))
    assert all(each.revision for each in found)
    assert book.commits == 16
    book.fsck()


def test_a_folder_that_another_process_makes_meanwhile(book: Book, monkeypatch: pytest.MonkeyPatch) -> None:
    make = Path.mkdir

    def second(folder: Path, mode: int = 0o777, *, exist_ok: bool = False) -> None:
        if folder == book.folder and not folder.exists():
            make(folder)
        make(folder, mode, exist_ok=exist_ok)

    monkeypatch.setattr(Path, "mkdir", second)
    book.record("press", ONE)
    assert book.commits == 1
