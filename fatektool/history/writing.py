"""Write a history, in an order that is safe against a crash at every step.

::

    1. blob, tree, commit   each to objects/xx/tmp_obj_…, fsync, rename, fsync of the folder (``loose``)
    2. fatektool.ref        the commit's hash, fsync
    3. main.lock            a hard link to it: git's own lock, so that no 'git gc' or 'git push' is in between
    4. the branch           is it still what the commit was made from? Then rename of main.lock, fsync

If the run is killed or the disk is full at 1 to 3, the branch does not change; git ignores the new objects,
which are unused. A lock that is left at 3 has the bytes of ``fatektool.ref``: so the next run recognises it
and deletes it. ``fatektool.lock`` lets one run write at a time; the kernel releases it with its process.

HEAD of a new repository is written last: until then it is not a repository, and the next run completes it.

dulwich's ``Repo.init_bare`` and ``set_if_equals`` are not used. A killed ``init_bare`` cannot be repeated,
and a killed ``set_if_equals`` leaves a lock that looks like git's.
"""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.callbacks import ignore
from fatektool.errors import PortBusy, UsageError
from fatektool.files.atomic import file_error, sync_folder, write_synced
from fatektool.history.repository import is_repository
from fatektool.history.sharing import FILE_MODE, FOLDER_MODE, Rights, rights_of
from fatektool.system.renaming import replace_file
from fatektool.system.shell import command_line
from fatektool.transport.lock import PortLock

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

LOCK: Final = "fatektool.lock"
STAGE: Final = "fatektool.ref"
_HEAD: Final = b"ref: refs/heads/main\n"
_CONFIG: Final = b"[core]\n\trepositoryformatversion = 0\n\tfilemode = true\n\tbare = true\n"
_FOLDERS: Final = ("objects", "objects/info", "objects/pack", "refs", "refs/heads", "refs/tags")
_MADE: Final = {"objects", "refs", "config", LOCK, "HEAD.tmp", "config.tmp"}
_STALE_S: Final = 3600.0  # git holds the lock of a branch for milliseconds
_POLL_S: Final = 0.05
_NO_LINKS: Final = {
    errno.EPERM,
    errno.ENOTSUP,
    errno.EOPNOTSUPP,
    errno.ENOSYS,
    errno.EINVAL,
}  # FAT and others


@contextlib.contextmanager
def writing(folder: Path, wait_s: float, waiting: Callable[[str], None] = ignore) -> Iterator[None]:
    """Hold the lock of a history; the history is created if it does not exist.

    Args:
        folder: the repository.
        wait_s: how long to wait for another process.
        waiting: is called with a text that names that process.

    Raises:
        UsageError: it cannot be created or written.
        DataError: the disk is full.
        PortBusy: another process still writes it after the wait.
    """
    try:
        if not folder.is_dir():
            with contextlib.suppress(FileExistsError):  # another process was faster
                folder.mkdir(FOLDER_MODE)
            sync_folder(folder.parent)
        if not is_repository(folder):
            _require_ours(folder)
        lock = PortLock(os.path.realpath(folder), wait_s, waiting=waiting)
        lock.path = folder / LOCK  # beside what it guards: the same for all users and computers
        if not lock.path.exists():
            lock.path.touch(FILE_MODE)
            rights_of(folder).give(lock.path)
        lock.acquire()
        try:
            if not is_repository(folder):
                _make(folder)
            yield
        finally:
            lock.release()
    except PermissionError as error:
        share = command_line(["git", "-C", str(folder), "config", "core.sharedRepository", "group"])
        raise UsageError(
            f"cannot write {folder}: {error.strerror}: {error.filename}",
            hint=f"check the permissions. If several users write this history, run: {share}; "
            "then give the group access to the existing files: chgrp -R, chmod -R g+rwX",
            file=str(folder),
        ) from error
    except OSError as error:
        raise file_error("write", folder, error) from error


def _require_ours(folder: Path) -> None:
    others = sorted(path.name for path in folder.iterdir() if path.name not in _MADE)
    if others:
        raise UsageError(
            f"{folder} is neither empty nor a bare git repository: it contains {others[0]!r}",
            hint="use another folder",
            file=str(folder),
        )


def _make(folder: Path) -> None:
    for name in _FOLDERS:
        (folder / name).mkdir(FOLDER_MODE, exist_ok=True)
    for name, data in (("config", _CONFIG), ("HEAD", _HEAD)):
        temporary = folder / f"{name}.tmp"
        temporary.unlink(missing_ok=True)
        write_synced(temporary, data)
        replace_file(temporary, folder / name)
        sync_folder(folder)


@dataclass(frozen=True, slots=True)
class Branch:
    """A branch: the folder of its history, its full name ``refs/heads/main``, permissions of new files."""

    folder: Path
    name: str
    rights: Rights

    @property
    def path(self) -> Path:
        """The file with the hash of its newest commit."""
        return self.folder / self.name


def move_branch(
    branch: Branch,
    new: str,
    still: Callable[[], bool],
    *,
    wait_s: float,
    clock: Callable[[], float] = time.perf_counter,
    sleep: Callable[[float], None] = time.sleep,
) -> bool:
    """Move a branch to a new commit, if it has not moved since that commit was made.

    Args:
        branch: the branch.
        new: the hash of the commit.
        still: True if the branch has not moved; called under the lock of the branch.
        wait_s: how long to wait for another git program.
        clock: seconds; for tests.
        sleep: waits so many seconds; for tests.

    Returns:
        False if the branch moved meanwhile; nothing was changed.

    Raises:
        PortBusy: another git program holds the lock of the branch.
        OSError: the disk is full or broken.
    """
    folder, path = branch.folder, branch.path
    lock, stage = path.with_name(f"{path.name}.lock"), folder / STAGE
    branch.rights.make_folder(path.parent)
    drop_stale(folder, branch.name)
    try:
        write_synced(stage, new.encode() + b"\n")
        branch.rights.give(stage)
        deadline = clock() + wait_s
        while not _taken(stage, lock):
            if not clock() < deadline:
                raise PortBusy(
                    f"{path} is locked by another git program: {lock} exists",
                    hint="wait until that program ends; if no git program is running, delete that file",
                    resource=str(path),
                )
            sleep(_POLL_S)
        if not still():
            return False
        replace_file(lock, path)
        sync_folder(path.parent)
        return True
    finally:
        with contextlib.suppress(OSError):
            drop_stale(folder, branch.name)


def drop_stale(folder: Path, branch: str) -> None:
    """Delete what a killed run left of steps 2 and 3; a lock of another program only if it is an hour old.

    Raises:
        OSError: it cannot be deleted.
    """
    lock, stage = folder / f"{branch}.lock", folder / STAGE
    with contextlib.suppress(FileNotFoundError):
        held = lock.read_bytes()
        ours = stage.exists() and held == stage.read_bytes()
        if ours or time.time() - lock.stat().st_mtime > _STALE_S:
            lock.unlink(missing_ok=True)
    stage.unlink(missing_ok=True)


def _taken(stage: Path, lock: Path) -> bool:
    try:
        os.link(stage, lock)
    except FileExistsError:
        return False
    except OSError as error:
        if error.errno not in _NO_LINKS:
            raise
        return _taken_by_copy(stage, lock)
    return True


def _taken_by_copy(stage: Path, lock: Path) -> bool:
    """The same on a file system without hard links."""
    try:
        write_synced(lock, stage.read_bytes())
        shutil.copymode(stage, lock)
    except FileExistsError:
        return False
    except OSError:
        lock.unlink(missing_ok=True)
        raise
    return True
