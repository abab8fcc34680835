"""Check a history: every object by its hash, every stored file as a backup."""

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
    """Something that is missing, damaged or not valid.

    Attributes:
        revision: the newest commit in which it was found, 40 hex digits; None if it is the repository itself.
        name: the PLC; None if it does not belong to one PLC.
        message: what is wrong.
    """

    revision: str | None
    name: str | None
    message: str


@dataclass(frozen=True, slots=True)
class HistoryCheck:
    """The result of a check.

    Attributes:
        commits: number of commits.
        programs: number of stored programs, each version counted once.
        names: the PLCs in the newest commit.
        faults: what was found; empty if nothing is wrong.
        shallow: True if it is a shallow clone, in which older commits are missing.
    """

    commits: int
    programs: int
    names: tuple[str, ...]
    faults: tuple[Damage, ...]
    shallow: bool = False


def check(folder: Path, progress: Callable[[str, int, int], None] = lambda *_: None) -> HistoryCheck:
    """Check a history, from the newest commit to the first.

    Args:
        folder: the repository.
        progress: called after each commit with the step, the commits checked, and all commits.

    Raises:
        UsageError: the folder does not exist or cannot be read.
        DataError: it is not a repository.
    """
    with Repository(folder) as repository:
        return _Check(repository).run(progress)


class _Check:
    """What was checked, and what was found."""

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
        """All commits that the branch leads to, newest first."""
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
        """The items of a tree; none the second time."""
        if sha in self.seen:
            return []
        self.seen.add(sha)
        return self.repository.items(sha)

    def look(self, commit: Commit, found: list[Item], *, root: bool = False) -> None:
        """Check the items of a tree, each object once."""
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
        """Check a file; one that is not named as a PLC's is not parsed."""
        if name is not None:
            self.programs += 1
            Backup.parse(data, f"{name}@{commit.revision[:SHORT]}")
