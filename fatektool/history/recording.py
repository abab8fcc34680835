"""Record a backup, if its program differs from the last one recorded for this PLC.

::

    compare_with_last   the newest commit, its tree, this PLC's blob        enough for most PLCs each night
    write               blob, tree, commit, then the branch (``writing``)   about 1 of 100; compares again

The first comparison takes no lock and writes nothing, so a round waits only if a program changed. If the
previous backup cannot be read, that is a warning, and the new one is recorded.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from dulwich.objects import Blob, Commit, ObjectID

from fatektool.errors import DataError, UsageError
from fatektool.history import messages
from fatektool.history.loose import write_loose
from fatektool.history.repository import Newest
from fatektool.history.trees import file_in, files, with_file
from fatektool.history.writing import Branch, move_branch
from fatektool.ladder.differences import compare_code, summary
from fatektool.ladder.image import code_of
from fatektool.program.archive import Backup
from fatektool.program.compare import Comparison, compare
from fatektool.program.data.compare import data_change

if TYPE_CHECKING:
    from collections.abc import Sequence

    from dulwich.objects import Tree

    from fatektool.history.repository import Repository
    from fatektool.history.trees import Item
    from fatektool.ladder.differences import NetworkChange

_MOST_NETWORKS = 1000


@dataclass(frozen=True, slots=True)
class RecordResult:
    """The result of a recording.

    Attributes:
        name: the PLC.
        revision: the new commit, 40 hex digits; None if the program did not change.
        subject: in words: ``press-3: 4 words in 2 pages changed``.
        changes: the comparison of the old program with the new one; None for a first backup.
        warnings: for the user, such as a damaged previous backup.
    """

    name: str
    revision: str | None
    subject: str
    changes: Comparison | None
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class BackupComparison:
    """A new backup compared with the last one that was recorded.

    Attributes:
        newest: the newest commit at that time.
        old: the last backup of this PLC; None if there is none that can be read.
        changes: the comparison of the old program with the new one; None without an old one.
        warnings: why the old one cannot be read.
        data: what changed in the data, in words; None for nothing.
    """

    newest: Newest
    old: Backup | None = None
    changes: Comparison | None = None
    warnings: tuple[str, ...] = ()
    data: str | None = None

    @property
    def same(self) -> bool:
        """True if the last recorded program is the same, and so are the data that ought to be constant."""
        return self.changes is not None and self.changes.same and self.data is None


def compare_with_last(
    repository: Repository, name: str, backup: Backup, keep: Sequence[str] = ()
) -> BackupComparison:
    """Compare a backup with the last one that was recorded.

    Raises:
        DataError: the newest commit or its tree is damaged.
    """
    found = last_recorded(repository, name)
    if found.old is None:
        return found
    changes = compare(found.old.program, backup.program)
    return replace(found, changes=changes, data=data_change(found.old.data, backup.data, keep))


def last_recorded(repository: Repository, name: str) -> BackupComparison:
    """The last backup that was recorded, compared with nothing.

    Raises:
        DataError: the newest commit or its tree is damaged.
    """
    newest = repository.newest()
    blob = file_in(newest.items, name)
    if blob is None:
        return BackupComparison(newest)
    try:
        return BackupComparison(newest, Backup.parse(repository.read(blob, "blob"), name))
    except DataError as error:  # the new backup is recorded all the same
        return BackupComparison(newest, warnings=(f"the previous backup cannot be read: {error}",))


def unchanged(name: str, found: BackupComparison) -> RecordResult:
    """The result for a program that did not change."""
    return RecordResult(name, None, f"{name}: unchanged", found.changes)


def write(
    repository: Repository,
    name: str,
    backup: Backup,
    seen: BackupComparison | None,
    *,
    keep: Sequence[str],
    now: int,
    wait_s: float,
) -> RecordResult:
    """Record a backup if it differs; the caller holds the lock of the history.

    Args:
        repository: the history.
        name: the PLC.
        backup: its program.
        seen: a comparison before the lock was taken; used again if nothing was written since.
        keep: globs of the elements whose data ought to be constant.
        now: seconds since 1970.
        wait_s: how long to wait for another git program.

    Raises:
        UsageError: the name of another PLC differs only in case.
        DataError: the newest commit or its tree is damaged.
        PortBusy: another git program holds the lock of the branch.
        OSError: the disk is full or broken.
    """
    while True:  # again if something was pushed into the history meanwhile
        tip = repository.tip()
        found = (
            seen
            if seen is not None and seen.newest.tip == tip
            else compare_with_last(repository, name, backup, keep)
        )
        if found.same:
            return unchanged(name, found)
        networks = _networks(found.old, backup)
        few = None if networks is None else summary(networks) or "same code"
        subject = messages.subject(name, found.changes, few, damaged=bool(found.warnings), data=found.data)
        blob, tree = _new_file(repository, found.newest.items, name, backup)
        put = partial(write_loose, repository.folder, rights=repository.rights)
        put(blob)
        put(tree)
        commit = _commit(tree, found.newest.tip, name, backup, now)
        every = None if networks is None else summary(networks, _MOST_NETWORKS) or "same code"
        commit.message = messages.message(subject, found.changes, found.old, backup, every)
        new = put(commit)
        still = partial(_is_tip, repository, found.newest.tip)
        branch = Branch(repository.folder, repository.branch(), repository.rights)
        if move_branch(branch, new, still, wait_s=wait_s):
            repository.is_now(Newest(new, tree.items()))
            return RecordResult(name, new, subject, found.changes, found.warnings)


def _networks(old: Backup | None, new: Backup) -> Sequence[NetworkChange] | None:
    """The networks that differ; None if there is no old program, or a program has no mnemonics."""
    if old is None:
        return None
    before, now = code_of(old.program), code_of(new.program)
    return None if before is None or now is None else compare_code(before, now)


def _is_tip(repository: Repository, tip: str | None) -> bool:
    return repository.tip() == tip


def _new_file(repository: Repository, old: Sequence[Item], name: str, backup: Backup) -> tuple[Blob, Tree]:
    """The new blob, and the new tree with it."""
    if file_in(old, name) is None:
        _require_own_file(repository, old, name)
    blob = Blob.from_string(backup.to_bytes())
    return blob, with_file(old, name, blob)


def _require_own_file(repository: Repository, items: Sequence[Item], name: str) -> None:
    others = files(items)
    twin = next((other for other in others if other.casefold() == name.casefold()), None)
    if twin is not None:
        raise UsageError(
            f"{name!r} differs only in case from {twin!r} in the history {repository.folder}: "
            "on Windows and macOS both would be the same file",
            hint="choose another name",
        )


def _commit(tree: Tree, parent: str | None, name: str, backup: Backup, now: int) -> Commit:
    commit = Commit()
    commit.tree = tree.id
    commit.parents = [] if parent is None else [ObjectID(parent.encode())]
    commit.author, commit.author_time = messages.author(name, backup), messages.read_at(backup, now)
    commit.committer, commit.commit_time = messages.committer(), now
    commit.author_timezone = commit.commit_timezone = 0
    return commit
