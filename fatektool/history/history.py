"""What a caller uses: record a backup, and find it again."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from dulwich.objects import Blob, ObjectID, Tree
from dulwich.objects import Commit as GitCommit

from fatektool.errors import DataError, FatektoolError, UsageError
from fatektool.history import messages
from fatektool.history.names import file_of, require_name
from fatektool.history.packing import is_due, pack_loose
from fatektool.history.repository import Repository
from fatektool.history.revisions import SHORT, changes_of, resolve
from fatektool.history.writing import move_branch, write_object, writing
from fatektool.program.archive import Backup
from fatektool.program.compare import Comparison, compare
from fatektool.program.files import write_whole

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator
    from pathlib import Path

    from fatektool.history.repository import Commit

_FILE: Final = 0o100644


@dataclass(frozen=True, slots=True)
class Recorded:
    """What became of a backup.

    Attributes:
        name: the PLC.
        revision: the new commit, 40 hex digits; None if the program is the one that is there already.
        subject: in words: ``press-3: 4 words in 2 pages changed``.
        changes: the old program against the new one; None for a first backup.
        warnings: what the user should know: a damaged file before this one.
    """

    name: str
    revision: str | None
    subject: str
    changes: Comparison | None
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Change:
    """One PLC's part of a commit; ``removed`` if its file was taken out, which fatektool never does."""

    name: str
    commit: Commit
    removed: bool


@dataclass(frozen=True, slots=True)
class Stored:
    """A backup as the history holds it.

    Attributes:
        name: the PLC.
        commit: the one that recorded it.
        data: the file's bytes.
        backup: the same, read and checked.
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
    """The programs of many PLCs, and how they changed. Threads may share one.

    Args:
        folder: a bare git repository; made by the first ``record``.
        wait_s: how long ``record`` waits for another process that writes it, in seconds.
        clock: seconds since 1970; for tests.
    """

    def __init__(self, folder: Path, *, wait_s: float = 60.0, clock: Callable[[], float] = time.time) -> None:
        self.folder = folder
        self._wait_s = wait_s
        self._clock = clock
        self._turn = threading.Lock()

    def record(self, name: str, backup: Backup) -> Recorded:
        """Keep a backup, if its program is another than the one that the history holds for this PLC.

        It is on disk when this returns. Nothing is lost if this fails at any place.

        Args:
            name: the PLC.
            backup: its program.

        Raises:
            UsageError: the name is none, or the folder cannot be written.
            DataError: the history is damaged, or the disk is full.
            PortBusy: another process writes it, and goes on.
        """
        require_name(name)
        with self._turn, writing(self.folder, self._wait_s), Repository(self.folder) as repository:
            found = None
            while found is None:  # once more if somebody pushed into it meanwhile
                found = self._try_to_record(repository, name, backup)
            if found.revision is None or not is_due(repository):
                return found
            try:
                pack_loose(repository)
            except FatektoolError as error:  # the backup is kept, and the next run tries again
                warning = f"the history could not be packed: {error}"
                return Recorded(found.name, found.revision, found.subject, found.changes, (warning,))
            return found

    def _try_to_record(self, repository: Repository, name: str, backup: Backup) -> Recorded | None:
        tip = repository.tip()
        last = None if tip is None else repository.commit(tip)
        tree = Tree() if last is None else repository.tree(last.tree)
        files = {} if last is None else repository.files(last.tree)
        old: Backup | None = None
        warnings: tuple[str, ...] = ()
        if name in files:
            try:
                old = Backup.parse(repository.read(files[name], "blob"), name)
            except DataError as error:  # no reason to lose today's backup too
                warnings = (f"the backup before could not be read: {error}",)
        elif twin := next((other for other in files if other.casefold() == name.casefold()), None):
            raise UsageError(
                f"{name!r} and {twin!r} of the history {self.folder} would share a file",
                hint="choose another name",
            )
        changes = None if old is None else compare(old.program, backup.program)
        if changes is not None and changes.same:
            return Recorded(name, None, f"{name}: unchanged", changes)
        subject = messages.subject(name, changes, damaged=bool(warnings))
        blob = Blob.from_string(backup.to_bytes())
        tree[file_of(name)] = (_FILE, blob.id)
        commit = self._commit(tree, tip, name, backup)
        commit.message = messages.message(subject, changes, old, backup)
        for item in (blob, tree, commit):
            write_object(self.folder, item)
        new = commit.id.decode()
        moved = move_branch(
            self.folder, repository.branch(), new, lambda: repository.tip() == tip, wait_s=self._wait_s
        )
        return Recorded(name, new, subject, changes, warnings) if moved else None

    def _commit(self, tree: Tree, parent: str | None, name: str, backup: Backup) -> GitCommit:
        now = int(self._clock())
        commit = GitCommit()
        commit.tree = tree.id
        commit.parents = [] if parent is None else [ObjectID(parent.encode())]
        commit.author, commit.author_time = messages.author(name, backup), messages.read_at(backup, now)
        commit.committer, commit.commit_time = messages.committer(), now
        commit.author_timezone = commit.commit_timezone = 0
        return commit

    def names(self) -> list[str]:
        """The PLCs whose programs it holds now.

        Raises:
            UsageError: there is no such folder.
            DataError: it is damaged, or no history.
        """
        with Repository(self.folder) as repository:
            tip = repository.tip()
            return [] if tip is None else sorted(repository.files(repository.commit(tip).tree))

    def log(self, name: str | None = None) -> Generator[Change, None, None]:
        """The changes, newest first.

        Args:
            name: of this PLC alone; None for all.

        Raises:
            UsageError: there is no such folder, or no such PLC in it.
            DataError: it is damaged, or no history.
        """
        with Repository(self.folder) as repository:
            after: Commit | None = None
            files: dict[str, str] = {}
            known = name is None
            for commit in repository.chain(repository.tip()):
                before = files if after and commit.tree == after.tree else repository.files(commit.tree)
                for change in _changes(before, files, after, name):
                    known = True
                    yield change
                after, files = commit, before
            for change in _changes({}, files, after, name):
                known = True
                yield change
            if not known:
                raise self._unknown(str(name))

    def show(self, name: str, revision: str = "HEAD") -> Stored:
        """A PLC's backup as it was at a revision.

        Args:
            name: the PLC.
            revision: see ``fatektool.history.revisions``.

        Raises:
            UsageError: there is no such folder, PLC or revision.
            DataError: the history or the stored file is damaged.
        """
        with Repository(self.folder) as repository:
            if repository.tip() is None:
                raise self._unknown(name)
            commit = resolve(repository, name, revision)
            blob = repository.files(commit.tree).get(name)
            if blob is None:
                raise self._unknown(name, f" at {revision} ({commit.revision[:SHORT]})")
            data = repository.read(blob, "blob")
            recorded = next(changes_of(name, repository, commit.revision), commit)
            return Stored(name, recorded, data, Backup.parse(data, f"{name}@{commit.revision[:SHORT]}"))

    def diff(self, name: str, a: str = "~1", b: str = "HEAD") -> Comparison:
        """A PLC's program at two revisions; by default, its last change.

        Raises:
            UsageError: there is no such folder, PLC or revision.
            DataError: the history or a stored file is damaged.
        """
        return compare(self.show(name, a).backup.program, self.show(name, b).backup.program)

    def export(self, name: str, revision: str, file: Path, *, overwrite: bool = False) -> Stored:
        """Write a stored backup to a file, as it was recorded; ``restore`` takes it.

        Raises:
            UsageError: there is no such folder, PLC or revision; or the file cannot be written.
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


def _changes(
    before: dict[str, str], after: dict[str, str], commit: Commit | None, name: str | None
) -> Iterator[Change]:
    """What one commit did, to all PLCs or to one."""
    if commit is None or before is after:
        return
    for each in sorted(before.keys() | after.keys()) if name is None else [name]:
        if before.get(each) != after.get(each):
            yield Change(each, commit, each not in after)
