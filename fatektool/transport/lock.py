"""A lock for each port or gateway: one process uses it at a time.

With two programs on one line, each would receive the answers of the other. The lock is the operating system's
(``flock``; on Windows a locked byte), on a small file that contains the process that holds it. The system
releases it when the process ends, in whatever way. So a file that is left over blocks nothing, and cron never
stops because of one.

If the file is not empty although the lock is free, the process before was killed, or ended without the answer
to its last request. That answer may still be received: then ``found_doubt`` is True.

All users can lock the file; it is in a folder in which all users may create files, so that one port has one
file, whoever uses it. If the system has no such folder, or a service has its own ``/tmp``, set
FATEKTOOL_LOCK_DIR to a folder for all.

A process that waits holds a second lock, the queue, so that the first process can know it (``wanted``).
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
from math import inf
from typing import TYPE_CHECKING, Final

from fatektool.callbacks import ignore
from fatektool.errors import PortBusy, UsageError
from fatektool.value import Value, frozen

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

_WINDOWS: Final = os.name == "nt"
_POLL_S: Final = 0.05
_SHARED: Final = ("/run/lock", "/var/lock", "/tmp")  # noqa: S108  # files are made there under O_EXCL
_FOR_ALL: Final = 0o003
_PAST_THE_TEXT: Final = 4096
_MOST_TEXT: Final = 1000
_LONGEST_COMMAND: Final = 200
_held: set[str] = set()


def lock_folder() -> str:
    """The folder of lock files: the first in which *every* user may create files.

    It is not enough that root may write to ``/run/lock``: other users would lock in another folder.
    """
    named = os.environ.get("FATEKTOOL_LOCK_DIR")
    if named:
        return named
    return shared_folder() or _own_folder()


def shared_folder() -> str | None:
    """The folder for all users; None if there is none."""
    if _WINDOWS:
        return _of_windows()
    for folder in _SHARED:
        with contextlib.suppress(OSError):
            if os.stat(folder).st_mode & _FOR_ALL == _FOR_ALL:  # noqa: PTH116  # pathlib is loaded later
                return folder
    return None


def _of_windows() -> str | None:
    r"""``C:\ProgramData\fatektool``: all users may create files in it, and read and lock each other's."""
    base = os.environ.get("PROGRAMDATA")
    if base:
        folder = os.path.join(base, "fatektool")  # noqa: PTH118  # pathlib is loaded later
        with contextlib.suppress(OSError):
            os.makedirs(folder, exist_ok=True)  # noqa: PTH103  # pathlib is loaded later
            return folder
    return None


def _own_folder() -> str:
    from tempfile import gettempdir

    return gettempdir()


@frozen
class Holder(Value):
    """The process that holds a lock, as written in its file.

    Attributes:
        pid: the process id.
        since: the time at which it locked, UTC, RFC 3339; empty if unknown.
        command: its command line, shortened; empty if unknown.
    """

    pid: int
    since: str = ""
    command: str = ""

    def __str__(self) -> str:
        known = ", ".join(part for part in (self.command, self.since and f"since {self.since}") if part)
        return f"process {self.pid}" + (f" ({known})" if known else "")

    @classmethod
    def present(cls) -> Holder:
        """This process, since now."""
        program = sys.argv[0] if sys.argv else ""
        folder, name = os.path.split(program)
        words = [os.path.split(folder)[1] if name == "__main__.py" else name, *sys.argv[1:]]
        command = " ".join(" ".join(words).split())[:_LONGEST_COMMAND]
        return cls(os.getpid(), time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()), command)

    @classmethod
    def parse(cls, text: str) -> Holder | None:
        """Parse a lock file: lines with process id, time and command; None if it has no process."""
        lines = [*text.split("\n"), "", ""]
        try:
            return cls(int(lines[0]), lines[1], lines[2])
        except ValueError:
            return None

    def to_text(self) -> str:
        """The lines of the lock file."""
        return f"{self.pid}\n{self.since}\n{self.command}\n"


class PortLock:
    """The lock of one port or gateway.

    Args:
        resource: what is locked, by one name for all: the real path of a device, or ``ip:port``.
        wait_s: how long to wait for another process, in seconds.
        waiting: gets a message, at once, with the process that has the lock.
        clock: in seconds; for tests.
        sleep: waits so many seconds; for tests.
    """

    def __init__(
        self,
        resource: str,
        wait_s: float,
        *,
        waiting: Callable[[str], object] = ignore,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.resource = resource
        self._wait_s = wait_s
        self._waiting = waiting
        self._clock = clock
        self._sleep = sleep
        self._queue: PortLock | None = None
        readable = re.sub(r"[^A-Za-z0-9.]+", "-", resource)[-60:].strip("-")
        unique = crc32(resource.encode(errors="surrogateescape"))  # a-b, a/b; two alike would only wait
        self.path: str | Path = f"{lock_folder()}/fatektool-{readable}-{unique:08x}.lock"
        self._descriptor: int | None = None
        self.found_doubt = False
        """True, once locked, if an answer to the process before may still be received."""
        self.leaves_doubt: Callable[[], bool] = bool
        """Set by the holder: the same of itself, called when the lock is released."""

    def acquire(self) -> None:
        """Lock, and wait if necessary.

        Raises:
            PortBusy: another process, or another part of this one, has it for longer than ``wait_s``.
        """
        if self._try():
            return
        deadline = self._clock() + self._wait_s
        if self._wait_s > 0:
            most = f", for {self._wait_s:g} s at most" if self._wait_s < inf else ""
            self._waiting(f"{self.resource} is in use by {self.holder() or 'another process'}: waiting{most}")
        queue = self._waiting_line()
        try:
            while not self._try():
                if not self._clock() < deadline:  # also for NaN
                    raise self._busy()
                with contextlib.suppress(UsageError):
                    queue._try()  # noqa: SLF001  # its own kind; one in the queue is enough
                self._sleep(_POLL_S)
        finally:
            queue.release()

    def wanted(self) -> bool:
        """True if a process waits for this lock."""
        queue = self._waiting_line()
        if not os.path.exists(queue.path):  # noqa: PTH110  # pathlib is loaded later
            return False
        with contextlib.suppress(UsageError):
            if queue._try():  # noqa: SLF001  # its own kind
                queue.release()
                return False
        return True

    def _waiting_line(self) -> PortLock:
        if self._queue is None:
            self._queue = PortLock(f"{self.resource} queue", 0)
        return self._queue

    def release(self) -> None:
        """Release the lock; may be called again."""
        if self._descriptor is not None:
            if not self.leaves_doubt():
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
        with contextlib.suppress(OSError):  # the file of another user is locked, but not written
            left = os.read(descriptor, 1)
            os.lseek(descriptor, 0, os.SEEK_SET)
            os.ftruncate(descriptor, 0)
            self.found_doubt = bool(left)
            os.write(descriptor, Holder.present().to_text().encode(errors="backslashreplace"))
        return True

    def _open(self) -> int:
        flags = os.O_RDWR
        for name in ("O_NOFOLLOW", "O_CLOEXEC", "O_BINARY"):
            flags |= getattr(os, name, 0)
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
                f"cannot create the lock file {self.path}: {error.strerror}",
                hint="set FATEKTOOL_LOCK_DIR to another folder",
            ) from error

    def _make(self, flags: int) -> None:
        """Create the file under another name first, so that all users can lock it as soon as it is there.

        The umask would exclude other users, and this process may be killed before it has corrected that.
        """
        from pathlib import Path

        new = Path(f"{self.path}.{os.getpid()}-{threading.get_ident()}")
        descriptor = os.open(new, flags | os.O_CREAT | os.O_EXCL, 0o666)
        try:
            with contextlib.suppress(OSError, AttributeError):
                os.fchmod(descriptor, 0o666)
            os.close(descriptor)
            with contextlib.suppress(FileExistsError):  # another process was faster
                os.link(new, self.path)
        except OSError:  # a file system without hard links
            with contextlib.suppress(FileExistsError):
                os.close(os.open(self.path, flags | os.O_CREAT | os.O_EXCL, 0o666))
        finally:
            new.unlink(missing_ok=True)

    def holder(self) -> Holder | None:
        """The process that holds the lock, as written in its file."""
        try:
            with open(self.path, "rb") as file:  # noqa: PTH123  # pathlib is loaded later
                return Holder.parse(file.read(_MOST_TEXT).decode(errors="replace"))
        except OSError:
            return None

    def _busy(self) -> PortBusy:
        found = self.holder()
        stop = f" or stop process {found.pid}" if found else ""
        return PortBusy(
            f"{self.resource} is in use by {found or 'another process'}: waited {self._wait_s:g} s",
            hint=f"wait until it has ended{stop}, or wait longer with --lock-wait",
            holder=found and found.pid,
            command=found and found.command,
            since=found and found.since,
            resource=self.resource,
        )


def _lock(descriptor: int) -> None:
    if sys.platform == "win32":
        os.lseek(descriptor, _PAST_THE_TEXT, os.SEEK_SET)
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        os.lseek(descriptor, 0, os.SEEK_SET)
    else:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
