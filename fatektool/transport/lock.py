"""One process a line: a lock that dies with its process.

Frames of two programs on one line would answer each other's questions, so a port or gateway is used by one
process at a time. The lock is the operating system's (``flock``; on Windows a locked byte), on a small file
whose content names the holder for the one who waits. It goes with the process, however that ends: a file left
behind stops nobody, and cron is never held up by one.

What it says when the lock is free tells one thing: the holder before was killed, or left without the answer
to its last request. That answer may still come, to whoever is next: ``found_doubt`` is True then.

The file is made for all users to lock: one port, one file, whoever asks.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import sys
import threading
import time
from binascii import crc32
from typing import TYPE_CHECKING, Final

from fatektool.errors import PortBusy, UsageError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

_POLL_S: Final = 0.05
_SHARED: Final = ("/run/lock", "/var/lock")
_PAST_THE_TEXT: Final = 4096
_held: set[str] = set()


def lock_folder() -> str:
    """Where lock files lie: the system's shared folder for them, else the one for temporary files."""
    named = os.environ.get("FATEKTOOL_LOCK_DIR")
    if named:
        return named
    for folder in _SHARED:
        if os.access(folder, os.W_OK | os.X_OK):
            return folder
    from tempfile import gettempdir

    return gettempdir()


class PortLock:
    """The right of this process to use one port or gateway.

    Args:
        resource: what is locked, the same for everyone who means it: a device's real path, ``ip:port``.
        wait_s: how long to wait for another process.
        clock: seconds; for tests.
        sleep: waits so many seconds; for tests.
    """

    def __init__(
        self,
        resource: str,
        wait_s: float,
        *,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.resource = resource
        self._wait_s = wait_s
        self._clock = clock
        self._sleep = sleep
        readable = re.sub(r"[^A-Za-z0-9.]+", "-", resource)[-60:].strip("-")
        told_apart = crc32(resource.encode(errors="surrogateescape"))  # a-b, a/b; two alike would only wait
        self.path: str | Path = f"{lock_folder()}/fatektool-{readable}-{told_apart:08x}.lock"
        self._descriptor: int | None = None
        self.found_doubt = False
        """True, once taken, if the holder before may have left an answer on its way."""
        self.leaves_doubt = False
        """Set by the holder: the same of itself."""

    def acquire(self) -> None:
        """Take the lock, waiting if need be.

        Raises:
            PortBusy: another process (or another part of this one) has it and keeps it.
        """
        deadline = self._clock() + self._wait_s
        while not self._try():
            if not self._clock() < deadline:  # NaN is no time to wait
                raise self._busy()
            self._sleep(_POLL_S)

    def release(self) -> None:
        """Give the lock back; again is fine."""
        if self._descriptor is not None:
            if not self.leaves_doubt:
                with contextlib.suppress(OSError):
                    os.ftruncate(self._descriptor, 0)
            os.close(self._descriptor)
            self._descriptor = None
            _held.discard(str(self.path))

    def _try(self) -> bool:
        if str(self.path) in _held:
            return False
        descriptor = self._open()
        try:
            _lock(descriptor)
        except OSError as error:
            os.close(descriptor)
            if error.errno in {errno.EAGAIN, errno.EACCES, errno.EWOULDBLOCK, errno.EDEADLK}:
                return False
            raise UsageError(f"cannot lock {self.path}: {error.strerror}") from error
        self._descriptor = descriptor
        _held.add(str(self.path))
        with contextlib.suppress(OSError):  # another user's file is locked without being written
            left = os.read(descriptor, 1)
            os.lseek(descriptor, 0, os.SEEK_SET)
            os.ftruncate(descriptor, 0)
            self.found_doubt = bool(left)
            os.write(descriptor, f"{os.getpid()}\n".encode())
        return True

    def _open(self) -> int:
        flags = os.O_RDWR | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0)
        try:
            try:
                return os.open(self.path, flags)
            except FileNotFoundError:
                self._make(flags)
                return os.open(self.path, flags)
            except PermissionError:
                return os.open(self.path, flags & ~os.O_RDWR)
        except OSError as error:
            raise UsageError(
                f"cannot make the lock file {self.path}: {error.strerror}",
                hint="name another folder in FATEKTOOL_LOCK_DIR",
            ) from error

    def _make(self, flags: int) -> None:
        """Make the file under another name first, so that it is for all users as soon as it has its own.

        The umask would keep other users out, and this process may be killed before it has set that right.
        """
        from pathlib import Path

        new = Path(f"{self.path}.{os.getpid()}-{threading.get_ident()}")
        descriptor = os.open(new, flags | os.O_CREAT | os.O_EXCL, 0o666)
        try:
            with contextlib.suppress(OSError, AttributeError):
                os.fchmod(descriptor, 0o666)
            os.close(descriptor)
            with contextlib.suppress(FileExistsError):  # somebody else was faster
                os.link(new, self.path)
        except OSError:  # a file system without hard links
            with contextlib.suppress(FileExistsError):
                os.close(os.open(self.path, flags | os.O_CREAT | os.O_EXCL, 0o666))
        finally:
            new.unlink(missing_ok=True)

    def holder(self) -> int | None:
        """The process that holds the lock, as far as its file tells."""
        from pathlib import Path

        try:
            return int(Path(self.path).read_bytes()[:20])
        except (OSError, ValueError):
            return None

    def _busy(self) -> PortBusy:
        pid = self.holder()
        who = f"process {pid}" if pid else "another process"
        return PortBusy(
            f"{self.resource} is in use by {who}: waited {self._wait_s:g} s",
            hint=f"let it end{f' or stop process {pid}' if pid else ''}, or wait longer with --lock-wait",
            holder=pid,
            resource=self.resource,
        )


def _lock(descriptor: int) -> None:
    if sys.platform == "win32":
        os.lseek(descriptor, _PAST_THE_TEXT, os.SEEK_SET)
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        os.lseek(descriptor, 0, os.SEEK_SET)
    else:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
