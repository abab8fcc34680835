"""The symbolic link to a pseudo terminal, and its owner.

::

    plc        -> /dev/pts/7
    .plc.lock     locked as long as the simulator runs that created the link

The system gives the number of a dead simulator's terminal to the next one that is opened by any program. So
the target of a link does not show whether its creator still runs; the lock does. A simulator that was killed
leaves both files, and the next one replaces them. Any other file with that name is kept.
"""

from __future__ import annotations

import contextlib
import os
import re
from pathlib import Path

from fatektool.errors import LineError

try:
    import fcntl
except ImportError:  # Windows has no pseudo terminals to link to either
    LOCKS_SUPPORTED = False
else:
    LOCKS_SUPPORTED = True

_TERMINAL = re.compile(r"/dev/(pts/\d+|tty[a-z]*\d+)")


class PtyLink:
    """The ownership of ``path``: locked first, then a link, then removed.

    Args:
        path: the link that will be created. LineError if it cannot be used.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        if not self.path.name:
            raise self._refused("it is a folder")
        self._lock = self.path.with_name(f".{self.path.name}.lock")
        self._target: str | None = None
        made_by_us = self._lock.exists()
        try:
            self._descriptor = os.open(self._lock, os.O_RDWR | os.O_CREAT, 0o600)
        except OSError as error:
            raise self._refused(error.strerror or str(error)) from error
        try:
            fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            os.close(self._descriptor)
            raise self._refused("another simulator uses it") from error
        try:
            self._remove_dead(made_by_us=made_by_us)
        except LineError:
            self._unlock()
            raise

    def point_to(self, terminal: str) -> None:
        """Create the link."""
        try:
            self.path.symlink_to(terminal)
        except OSError as error:
            raise self._refused(error.strerror or str(error)) from error
        self._target = terminal

    def remove(self) -> None:
        """Remove the link, if it is still the one that was created, and unlock."""
        with contextlib.suppress(OSError):
            if self._target is not None and os.fspath(self.path.readlink()) == self._target:
                self.path.unlink()
        self._unlock()

    def _remove_dead(self, *, made_by_us: bool) -> None:
        if self.path.is_symlink():
            to_terminal = _TERMINAL.fullmatch(os.fspath(self.path.readlink()))
            if to_terminal and (made_by_us or not self.path.exists()):
                self.path.unlink()
                return
        if self.path.is_symlink() or self.path.exists():
            raise self._refused("it exists")

    def _unlock(self) -> None:
        # Unlinked before it is unlocked, so that no process waits for a file that is deleted.
        with contextlib.suppress(OSError):
            self._lock.unlink()
        os.close(self._descriptor)

    def _refused(self, reason: str) -> LineError:
        return LineError(
            f"cannot create the link {self.path}: {reason}", hint="remove it or choose another path"
        )
