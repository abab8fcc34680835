"""Is all of a history whole? Every object by its hash, every stored file by the backup's own rules."""

from __future__ import annotations

from dataclasses import dataclass
from stat import S_ISDIR
from typing import TYPE_CHECKING

from dulwich.objects import S_ISGITLINK

from fatektool.errors import DataError
from fatektool.history.names import name_of
from fatektool.history.repository import Repository
from fatektool.history.revisions import SHORT
from fatektool.history.trees import files
from fatektool.program.archive import Backup

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fatektool.history.commits import Commit
    from fatektool.history.trees import Item


@dataclass(frozen=True, slots=True)
class Damage:
    """What does not hold.

    Attributes:
        revision: the newest commit in which it was found, 40 hex digits; None if it is the repository itself.
        name: the PLC; None if it is none's alone.
        message: what is wrong.
    """

    revision: str | None
    name: str | None
    message: str


@dataclass(frozen=True, slots=True)
class HistoryCheck:
    """A history, looked through.

    Attributes:
        commits: how many.
        programs: how many stored programs, each version once.
        names: the PLCs that it holds now.
        faults: what does not hold; empty if all does.
        shallow: True if it is a shallow clone, in which older commits are left out.
    """

    commits: int
    programs: int
    names: tuple[str, ...]
    faults: tuple[Damage, ...]
    shallow: bool = False


def check(folder: Path, progress: Callable[[str, int, int], None] = lambda *_: None) -> HistoryCheck:
    """Look a history through, from the newest commit to the first.

    Args:
        folder: the repository.
        progress: told of each commit.

    Raises:
        UsageError: there is no such folder, or it may not be read.
        DataError: it is no repository at all.
    """
    with Repository(folder) as repository:
        return _Check(repository).run(progress)


class _Check:
    """What was looked at already, and what was found."""

    def __init__(self, repository: Repository) -> None:
        self.repository = repository
        self.seen: set[str] = set()
        self.programs = 0
        self.faults: list[Damage] = []

    def run(self, progress: Callable[[str, int, int], None]) -> HistoryCheck:
        commits = self.commits()
        names: tuple[str, ...] = ()
        for number, commit in enumerate(commits, 1):
            try:
                found = self.tree(commit.tree)
                self.look(commit, found, root=True)
                if number == 1:
                    names = tuple(sorted(files(found)))
            except DataError as error:
                self.faults.append(Damage(commit.revision, None, error.message))
            progress("checking", number, len(commits))
        return HistoryCheck(len(commits), self.programs, names, tuple(self.faults), bool(self.repository.cut))

    def commits(self) -> list[Commit]:
        """All commits that can be reached, newest first."""
        found: list[Commit] = []
        try:
            tip = self.repository.tip()
        except DataError as error:
            self.faults.append(Damage(None, None, error.message))
            return found
        waiting = [] if tip is None else [tip]
        while waiting:
            sha = waiting.pop(0)
            if sha in self.seen:
                continue
            self.seen.add(sha)
            try:
                commit = self.repository.commit(sha)
            except DataError as error:
                self.faults.append(Damage(sha, None, error.message))
                continue
            found.append(commit)
            waiting += commit.parents
        return found

    def tree(self, sha: str) -> list[Item]:
        """What a tree names; nothing the second time."""
        if sha in self.seen:
            return []
        self.seen.add(sha)
        return self.repository.items(sha)

    def look(self, commit: Commit, found: list[Item], *, root: bool = False) -> None:
        """Look at what a tree names, at each object once."""
        for path, mode, raw_sha in found:
            sha = raw_sha.decode()
            if sha in self.seen or S_ISGITLINK(mode):
                continue
            name = name_of(path) if root else None
            try:
                if S_ISDIR(mode):
                    self.look(commit, self.tree(sha))
                else:
                    self.seen.add(sha)
                    self.file(commit, name, self.repository.read(sha, "blob"))
            except DataError as error:
                self.faults.append(Damage(commit.revision, name, error.message))

    def file(self, commit: Commit, name: str | None, data: bytes) -> None:
        """A file; what is no PLC's is somebody else's."""
        if name is not None:
            self.programs += 1
            Backup.parse(data, f"{name}@{commit.revision[:SHORT]}")
