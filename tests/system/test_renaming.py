"""Files that another program has open on Windows: renamed and removed when it has closed them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from fatektool.errors import UsageError
from fatektool.files.atomic import write_whole
from fatektool.system import renaming
from fatektool.system.renaming import remove_file, rename_file, replace_file
from tests.root import ROOT
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Callable

DENIED, SHARING, LOCKED, NOT_FOUND = 5, 32, 33, 2


def windows_error(number: int) -> OSError:
    """An error as Windows has it, but for its number elsewhere."""
    error = PermissionError(13, "Access is denied")
    error.winerror = number  # type: ignore[attr-defined, unused-ignore]  # as Windows sets it
    return error


class Held:
    """A method of ``Path`` that fails as if another program had the file open, so many times."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, method: str, times: float, number: int) -> None:
        self.slept: list[float] = []
        self._left, self._number = times, number
        done = getattr(Path, method)

        def failing(path: Path, *words: object, **options: object) -> object:
            if self._left:
                self._left -= 1
                raise windows_error(self._number)
            return done(path, *words, **options)

        monkeypatch.setattr(Path, method, failing)


ACTIONS: dict[str, Callable[[Path, Path, Held], None]] = {
    "replace": lambda new, old, held: replace_file(new, old, sleep=held.slept.append),
    "rename": lambda new, old, held: rename_file(new, old.with_name("third"), sleep=held.slept.append),
    "unlink": lambda new, _, held: remove_file(new, sleep=held.slept.append),
}


@each(
    ("method", "number"),
    [("replace", DENIED), ("replace", SHARING), ("rename", SHARING), ("unlink", SHARING), ("unlink", LOCKED)],
)
def test_it_waits_for_a_program_that_has_the_file_open(
    method: str, number: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    new, old = tmp_path / "new", tmp_path / "old"
    new.write_text("new")
    old.write_text("old")
    with monkeypatch.context() as patched:
        held = Held(patched, method, 3, number)
        ACTIONS[method](new, old, held)
    assert len(held.slept) == 3
    assert held.slept == sorted(held.slept)
    assert not new.exists()
    for path in tmp_path.iterdir():
        path.unlink()


@pytest.mark.parametrize("method", ACTIONS)
def test_it_does_not_wait_for_ever(method: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "new").touch()
    held = Held(monkeypatch, method, float("inf"), SHARING)
    with pytest.raises(PermissionError):
        ACTIONS[method](tmp_path / "new", tmp_path / "old", held)
    assert 0.5 < sum(held.slept) < 2


@pytest.mark.parametrize("method", ACTIONS)
def test_another_error_is_raised_at_once(
    method: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    held = Held(monkeypatch, method, 1, NOT_FOUND)
    with pytest.raises(PermissionError):
        ACTIONS[method](tmp_path / "new", tmp_path / "old", held)
    assert not held.slept


def test_a_file_that_is_read_only_is_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """git makes the files of a history so, and Windows removes none of these."""
    path = tmp_path / "object"
    path.write_text("")
    path.chmod(0o444)
    unlink = Path.unlink

    def as_windows(path: Path, *, missing_ok: bool = False) -> None:
        if not path.stat().st_mode & 0o200:
            raise windows_error(DENIED)
        unlink(path, missing_ok=missing_ok)

    monkeypatch.setattr(Path, "unlink", as_windows)
    remove_file(path, sleep=lambda _: None)
    assert not path.exists()


def test_what_a_user_reads_of_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "press.json"
    path.write_text("old")
    held = Held(monkeypatch, "replace", float("inf"), DENIED)
    monkeypatch.setattr(renaming, "_PAUSES_S", (0,))
    with pytest.raises(UsageError) as caught:
        write_whole(path, b"new", overwrite=True)
    assert caught.value.message == f"cannot write {path}: Access is denied"
    assert caught.value.hint == (
        "close the program that has it open, or check the permissions, and run it again"
    )
    assert path.read_text() == "old"
    assert [each.name for each in tmp_path.iterdir()] == ["press.json"]
    assert not held.slept


def test_files_are_renamed_here_alone() -> None:
    """Each other place would fail on Windows as soon as a virus scanner looks at the file."""
    own = ("renaming.py",)
    for path in (ROOT / "fatektool").rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        for call in ("temporary.replace(", "lock.replace(", ".rename(", "os.rename(", "os.replace("):
            assert path.name in own or call not in text, f"{path}: {call}"
