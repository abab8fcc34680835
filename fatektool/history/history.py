"""The interface of a history: record a backup, and find it again."""

from __future__ import annotations

import threading
import time
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING, Final

from fatektool.callbacks import ignore
from fatektool.errors import DataError, FatektoolError, UsageError
from fatektool.files.atomic import write_whole
from fatektool.history.names import require_name
from fatektool.history.packing import is_due, pack_loose
from fatektool.history.recording import RecordResult, compare_with_last, last_recorded, unchanged, write
from fatektool.history.repository import Repository, is_repository
from fatektool.history.revisions import SHORT, changes_of, resolve
from fatektool.history.trees import file_in, files
from fatektool.history.writing import writing
from fatektool.program.archive import Backup
from fatektool.program.compare import Comparison, compare

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator, Sequence
    from pathlib import Path
    from typing import Self

    from fatektool.history.commits import Commit
    from fatektool.history.trees import Item

__all__ = ["History", "LogEntry", "RecordResult", "Stored"]

_PATIENCE_S: Final = 1.0


@dataclass(frozen=True, slots=True)
class LogEntry:
    """A commit that changed the file of one PLC; ``removed`` if it deleted it, which fatektool never does."""

    name: str
    commit: Commit
    removed: bool


@dataclass(frozen=True, slots=True)
class Stored:
    """A recorded backup.

    Attributes:
        name: the PLC.
        commit: the commit that recorded it.
        data: the bytes of the file.
        backup: the same, parsed and checked.
    """

    name: str
    commit: Commit
    data: bytes
    backup: Backup

    @property
    def label(self) -> str:
        """Name and revision, as the command line takes them: ``press-3@a1b2c3d4e5``."""
        return f"{self.name}@{self.commit.revision[:SHORT]}"


class History:
    """The recorded programs of many PLCs. Threads may share one.

    As a context manager it keeps the repository open between calls of ``record``, for a round of many PLCs.

    Args:
        folder: a bare git repository; the first ``record`` creates it.
        wait_s: how long ``record`` waits for another process that writes the history, in seconds.
        waiting: is called with a text that names that process.
        clock: seconds since 1970; for tests.
    """

    def __init__(
        self,
        folder: Path,
        *,
        wait_s: float = 60.0,
        waiting: Callable[[str], None] = ignore,
        clock: Callable[[], float] = time.time,
    ) -> None:
        self.folder = folder
        self._wait_s = wait_s
        self._waiting = waiting
        self._clock = clock
        self._turn = threading.Lock()
        self._keeps = False
        self._kept: Repository | None = None

    def __enter__(self) -> Self:
        self._keeps = True
        return self

    def __exit__(self, *_: object) -> None:
        self._keeps = False
        # A thread that waits for another process may hold it: that is not waited for here.
        if self._turn.acquire(timeout=_PATIENCE_S):
            self._close()
            self._turn.release()

    def record(self, name: str, backup: Backup, keep: Sequence[str] = ()) -> RecordResult:
        """Record a backup, if its program or its data differ from the last one recorded for this PLC.

        It is on disk when this returns. A failure at any step loses nothing that was recorded before.

        Args:
            name: the PLC.
            backup: its program, and its data if they were saved.
            keep: globs of the elements whose data ought to be constant; none for the default.

        Raises:
            UsageError: the name is not valid, or the folder cannot be written.
            DataError: the history is damaged, or the disk is full.
            PortBusy: another process still writes the history after the wait.
        """
        require_name(name)
        with self._turn:
            seen = None
            if is_repository(self.folder):
                with self._open() as repository:
                    seen = compare_with_last(repository, name, backup, keep)
                if seen.same:
                    return unchanged(name, seen)
            with writing(self.folder, self._wait_s, self._waiting), self._open() as repository:
                now = int(self._clock())
                found = write(repository, name, backup, seen, keep=keep, now=now, wait_s=self._wait_s)
                if found.revision is None or not is_due(repository):
                    return found
                try:
                    pack_loose(repository)
                except FatektoolError as error:  # the backup is recorded, and the next run tries again
                    warnings = (*found.warnings, f"the history could not be packed: {error}")
                    return replace(found, warnings=warnings)
                return found

    @contextmanager
    def _open(self) -> Iterator[Repository]:
        """The open repository; closed after an error."""
        repository = self._kept or Repository(self.folder)
        self._kept = repository
        try:
            yield repository
        except BaseException:
            self._close()
            raise
        if not self._keeps:
            self._close()

    def _close(self) -> None:
        if self._kept is not None:
            self._kept.close()
            self._kept = None

    def names(self) -> list[str]:
        """The PLCs in the newest commit.

        Raises:
            UsageError: the folder does not exist.
            DataError: it is damaged or not a history.
        """
        with Repository(self.folder) as repository:
            tip = repository.tip()
            return [] if tip is None else sorted(files(repository.items(repository.commit(tip).tree)))

    def log(self, name: str | None = None) -> Generator[LogEntry, None, None]:
        """The changes, newest first.

        Args:
            name: a PLC; None for all PLCs.

        Raises:
            UsageError: the folder does not exist, or has no such PLC.
            DataError: it is damaged or not a history.
        """
        with Repository(self.folder) as repository:
            if name is None:
                yield from _changes(repository)
                return
            known = False
            for commit, blob in changes_of(name, repository, repository.tip()):
                known = True
                yield LogEntry(name, commit, blob is None)
            if not known:
                raise self._unknown(name)

    def show(self, name: str, revision: str = "HEAD") -> Stored:
        """The backup of a PLC at a revision.

        Args:
            name: the PLC.
            revision: see ``fatektool.history.revisions``.

        Raises:
            UsageError: the folder, the PLC or the revision does not exist.
            DataError: the history or the stored file is damaged.
        """
        with Repository(self.folder) as repository:
            if repository.tip() is None:
                raise self._unknown(name)
            commit = resolve(repository, name, revision)
            blob = file_in(repository.items(commit.tree), name)
            if blob is None:
                raise self._unknown(name, f" at {revision} ({commit.revision[:SHORT]})")
            data = repository.read(blob, "blob")
            recorded, _ = next(changes_of(name, repository, commit.revision), (commit, blob))
            return Stored(name, recorded, data, Backup.parse(data, f"{name}@{commit.revision[:SHORT]}"))

    def newest(self, name: str) -> Backup | None:
        """The newest backup of a PLC; None if there is none, or if it cannot be read.

        Args:
            name: the PLC.
        """
        if not is_repository(self.folder):
            return None
        with self._turn, self._open() as repository:
            return last_recorded(repository, name).old

    def before(self, found: Stored) -> Backup | None:
        """The previous backup of the same PLC; None if there is none, or if it cannot be read.

        Raises:
            DataError: the history is damaged.
        """
        with Repository(self.folder) as repository:
            changes = changes_of(found.name, repository, found.commit.revision)
            _, blob = next(islice(changes, 1, None), (None, None))
            if blob is None:
                return None
            try:
                return Backup.parse(repository.read(blob, "blob"), found.name)
            except DataError:  # 'history check' reports it
                return None

    def diff(self, name: str, a: str = "~1", b: str = "HEAD") -> Comparison:
        """Compare the program of a PLC at two revisions; by default, before and after its last change.

        Raises:
            UsageError: the folder, the PLC or the revision does not exist.
            DataError: the history or a stored file is damaged.
        """
        return compare(self.show(name, a).backup.program, self.show(name, b).backup.program)

    def export(self, name: str, revision: str, file: Path, *, overwrite: bool = False) -> Stored:
        """Write a recorded backup to a file, for ``restore``.

        Raises:
            UsageError: the folder, the PLC or the revision does not exist, or the file cannot be written.
            DataError: the history or the stored file is damaged, or the disk is full.
        """
        found = self.show(name, revision)
        write_whole(file, found.data, overwrite=overwrite)
        return found

    def _unknown(self, name: str, where: str = "") -> UsageError:
        from difflib import get_close_matches

        near = get_close_matches(name, self.names(), 3, 0.6)
        meant = f"; did you mean {' or '.join(near)}?" if near and name not in near else ""
        return UsageError(
            f"no PLC {name!r} in the history {self.folder}{where}{meant}", hint="see 'fatektool history log'"
        )


def _changes(repository: Repository) -> Iterator[LogEntry]:
    """The changes of all commits, newest first. Each tree is read once."""
    after: Commit | None = None
    new: set[Item] = set()
    for commit in repository.chain(repository.tip()):
        if after is None or commit.tree != after.tree:
            old = set(repository.items(commit.tree))
            if after is not None:
                yield from _between(old, new, after)
            new = old
        after = commit
    if after is not None:
        yield from _between(set(), new, after)


def _between(old: set[Item], new: set[Item], commit: Commit) -> Iterator[LogEntry]:
    """The changes of one commit, from the items of the tree before it and of its own."""
    before, after = files(old - new), files(new - old)
    for name in sorted(before.keys() | after.keys()):
        if before.get(name) != after.get(name):
            yield LogEntry(name, commit, name not in after)
