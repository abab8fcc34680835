"""Files that are written completely or not at all.

The order of a commit, and the result of a crash::

    1. write a temporary file in the same folder     it remains, FILE is unchanged
    2. fsync it                                      the same
    3. link it to FILE (new) or rename it (replace)  FILE is complete
    4. fsync the folder                              FILE is kept after a power cut

From step 3 on the file exists: if the folder cannot be synced (a network share, a folder that may be written
but not read), that is a ``FileWarning``, not an error.

A symlink is followed: its target is replaced, not the link. Files are created with the user's umask, and
never with more than 0640 unless required, because a program is property of its owner.
"""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import stat
import sys
import warnings
from pathlib import Path
from typing import Final

from fatektool.errors import DataError, FatektoolError, FileExists, FileWarning, UsageError
from fatektool.files.portable_name import require_file_name
from fatektool.system.renaming import is_held, rename_file, replace_file

STANDARD: Final = "-"
"""The name of standard input where a file is read, and of standard output where one is written."""

_MODE = 0o640
_NO_SYNC: Final = {errno.EINVAL, errno.ENOTSUP, errno.ENOSYS, errno.EBADF, errno.EPERM, errno.ENOTTY}
"""The errors of file systems that cannot sync, such as network shares; a failing disk has other errors."""
_MOST_NAMES: Final = 10_000


def require_place(path: Path, *, overwrite: bool) -> Path:
    """Check, before any work, that a file can be written; returns its real path.

    Raises:
        UsageError: it exists and must be kept, its folder is missing or not writable, or it is not a file.
    """
    if is_pipe(path):
        return path
    require_file_name(str(path))
    try:
        real = Path(os.path.realpath(path))
        if real.is_symlink():
            raise UsageError(f"{path} is a symbolic link to itself", file=str(path))
        if real.is_dir():
            raise UsageError(f"{path} is a folder, expected a file name", file=str(path))
        if real.exists() and not real.is_file():
            raise UsageError(f"{path} is a device, expected a file name", file=str(path))
        if real.exists() and not overwrite:
            raise exists_already(path)
        require_folder(real.parent)
    except (OSError, ValueError) as error:
        raise file_error("look at", path, error) from error
    return real


def is_pipe(path: Path) -> bool:
    """True for a pipe to another process, such as the shell's ``>(gzip > x)`` or a FIFO."""
    try:
        return stat.S_ISFIFO(path.stat().st_mode)
    except (OSError, ValueError):
        return False


def require_folder(path: Path) -> Path:
    """Check that files can be created in this folder.

    Raises:
        UsageError: it is not a folder, or not writable.
    """
    try:
        is_folder = path.is_dir()
    except (OSError, ValueError) as error:  # a name that is too long, or none
        raise file_error("look at", path, error) from error
    if not is_folder:
        raise UsageError(f"{path} is not a folder", hint="create it first, or use another", file=str(path))
    if not os.access(path, os.W_OK):
        raise UsageError(f"folder {path} is not writable", hint="choose another folder", file=str(path))
    return path


def make_folder(path: Path) -> bool:
    """Make sure that a folder exists in which files can be created; True if it was missing.

    Raises:
        UsageError: it cannot be created, is not a folder, or is not writable.
    """
    require_file_name(str(path))
    try:
        made = not path.exists()
        path.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        made = False  # something else, which is said below
    except (OSError, ValueError) as error:
        raise file_error("make the folder", path, error) from error
    if made:
        sync_folder(path.parent)
    require_folder(path)
    return made


def write_whole(path: Path, data: bytes, *, overwrite: bool, mode: int = _MODE) -> None:
    """Write a file completely or not at all; it is on disk when this returns.

    Args:
        path: the file.
        data: its bytes.
        overwrite: replace an existing file.
        mode: its permissions, without the user's umask.

    Raises:
        FileExists: it exists and ``overwrite`` is False.
        UsageError: its folder cannot be written.
        DataError: the disk is full or damaged; the file is unchanged.

    Warns:
        FileWarning: it exists, but may be lost in a power cut.
    """
    real = require_place(path, overwrite=overwrite)
    if is_pipe(real):
        _write_through(real, data)
        return
    temporary = real.parent / f".fatektool-{secrets.token_hex(6)}.tmp"
    try:
        write_synced(temporary, data, mode)
        if overwrite:
            replace_file(temporary, real)
        else:
            _put_new(temporary, real)
        sync_folder(real.parent)
    except FileExistsError as error:
        raise exists_already(path) from error
    except OSError as error:
        raise file_error("write", path, error) from error
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)


def _write_through(path: Path, data: bytes) -> None:
    """Write all bytes to a pipe; its reader is responsible for them."""
    try:
        with path.open("wb") as pipe:
            pipe.write(data)
    except OSError as error:
        raise file_error("write", path, error) from error


def read_bounded(path: Path, limit: int) -> bytes:
    """Read a whole file of at most ``limit`` bytes; ``-`` is standard input.

    Raises:
        UsageError: there is no such file, it may not be read, or standard input has nothing (any more).
        DataError: it is larger, or the disk is damaged.
    """
    try:
        if str(path) == STANDARD:
            data = sys.stdin.buffer.read(limit + 1)
        else:
            require_file_name(str(path))
            with path.open("rb") as file:
                data = file.read(limit + 1)
    except (OSError, ValueError) as error:
        raise file_error("read", path, error) from error
    if not data and str(path) == STANDARD:
        raise UsageError(
            "-: standard input is empty", hint="use - only once, after a command that prints something"
        )
    if len(data) > limit:
        raise DataError(f"{path}: expected at most {limit} bytes, got more", file=str(path))
    return data


def write_new(folder: Path, stem: str, suffix: str, data: bytes) -> Path:
    """Write a file with a new name: ``stem.suffix``, else ``stem-2.suffix`` and so on.

    Raises:
        UsageError: the folder cannot be written, or all names are taken.
        DataError: the disk is full or damaged; nothing was written.
    """
    for number in range(1, _MOST_NAMES + 1):
        path = folder / (f"{stem}.{suffix}" if number == 1 else f"{stem}-{number}.{suffix}")
        with contextlib.suppress(FileExists):
            write_whole(path, data, overwrite=False)
            return path
    raise UsageError(
        f"{folder} has {_MOST_NAMES} files of the name {stem}", hint="move them away", file=str(folder)
    )


def exists_already(path: Path, hint: str | None = None) -> FileExists:
    """The refusal to replace a file; ``hint`` is the next step if there is no ``--force``."""
    return FileExists(
        f"{path} exists already and is kept", hint=hint or "choose another name, or --force", file=str(path)
    )


def file_error(what: str, path: Path, error: OSError | ValueError) -> FatektoolError:
    """An error of the file system as one of the project.

    A path that cannot be used is a usage error; a disk that fails is a data error.
    """
    reason = getattr(error, "strerror", None) or str(error)
    message = f"cannot {what} {path}: {reason}"
    number = getattr(error, "errno", None)
    if number in {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}:
        return DataError(
            message, hint="free some space and run it again; the file is unchanged", file=str(path)
        )
    if number == errno.EIO:
        return DataError(message, hint="check the disk", file=str(path))
    if is_held(error):
        hint = "close the program that has it open, or check the permissions, and run it again"
        return UsageError(message, hint=hint, file=str(path))
    return UsageError(message, hint="check the name and the permissions", file=str(path))


def write_synced(path: Path, data: bytes, mode: int = _MODE) -> None:
    """Write a new file; it is on disk when this returns, except its name: see ``sync_folder``.

    Raises:
        OSError: it exists, or cannot be written completely.
    """
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    with os.fdopen(os.open(path, flags, mode), "wb") as file:
        file.write(data)
        file.flush()
        sync(file.fileno(), path)


def sync(descriptor: int, path: Path) -> None:
    """Sync the data of a file to the disk, if the file system can do that.

    Raises:
        OSError: the disk is full or damaged.

    Warns:
        FileWarning: the file system cannot sync.
    """
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in _NO_SYNC:
            raise
        _warn_of_sync(f"what is written in {path.parent}", error)


def _put_new(temporary: Path, real: Path) -> None:
    """Give the file its name, unless another file has it; without hard links (FAT, Windows) by rename."""
    try:
        os.link(temporary, real)
    except FileExistsError:
        raise
    except OSError:
        if real.exists():
            raise FileExistsError(errno.EEXIST, "exists", str(real)) from None
        rename_file(temporary, real)


def sync_folder(folder: Path) -> None:
    """Sync the names in a folder to the disk; the files exist in any case.

    Warns:
        FileWarning: the folder cannot be synced.
    """
    if os.name == "nt":  # a folder cannot be opened there
        return
    try:
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
    except OSError as error:
        if error.errno not in {errno.EINVAL, errno.ENOTSUP}:  # file systems without a sync of folders
            _warn_of_sync(f"a new name in folder {folder}", error)


def _warn_of_sync(what: str, error: OSError) -> None:
    warnings.warn(
        f"{what} may be lost in a power cut, because it cannot be synced: {error.strerror or error}; "
        f"the files themselves are complete",
        FileWarning,
        stacklevel=3,
    )
