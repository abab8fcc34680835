"""A copy of the history in another repository: a folder, or what ssh or http(s) reaches.

Where a git program is, that pushes: it knows the user's settings, keys and helpers, a remote's ``pushurl``,
and runs the hooks of both sides. Where there is none, dulwich does: see ``by_dulwich`` for what that cannot.

Nothing is ever forced: a copy that has gone another way is named, and left as it is. No question is asked and
no wait is without an end, as this runs by night.
"""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING, Final

from fatektool.history.push.outcome import Pushed, failed
from fatektool.history.repository import Repository

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["Pushed", "push"]

_TIMEOUT_S: Final = 30.0


def push(folder: Path, remote: str, *, timeout_s: float = _TIMEOUT_S) -> Pushed:
    """Give another repository all that this one has and it has not.

    Args:
        folder: the history.
        remote: a folder with a bare repository, ``ssh://…``, ``host:path``, ``https://…``, or the name of a
            remote in git's configuration.
        timeout_s: for each answer of a server, in seconds.

    Raises:
        PushFailed: it is not there, refuses, or has gone another way; the history here is as it was.
        UsageError: there is no history here.
        DataError: the history here is damaged.
    """
    if not remote:
        raise failed("''", "it names no place", "name a folder, ssh://HOST/PATH, HOST:PATH or https://…")
    program = shutil.which("git")
    with Repository(folder) as repository:
        if program is not None:
            from fatektool.history.push.by_git import push_by_git

            return push_by_git(program, repository, remote, timeout_s)
        from fatektool.history.push.by_dulwich import push_by_dulwich

        return push_by_dulwich(repository, remote, timeout_s)
