"""A copy of the history in another repository: a folder, or what ssh or http(s) reaches.

If there is a git program, it pushes: it uses the user's settings, keys and helpers and the ``pushurl`` of a
remote, and runs the hooks of both sides. If there is none, dulwich pushes: see ``by_dulwich`` for its limits.

Nothing is ever forced: a copy with other commits is reported and not changed. No question is asked and every
wait has a limit, because this runs at night.
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
    """Push the history to another repository.

    Args:
        folder: the history.
        remote: a folder with a bare repository, ``ssh://…``, ``host:path``, ``https://…``, or the name of a
            remote in git's configuration.
        timeout_s: for each answer of a server, in seconds.

    Raises:
        PushFailed: the remote cannot be reached, refuses, or has other commits; the history is not changed.
        UsageError: there is no history in the folder.
        DataError: the history is damaged.
    """
    if not remote:
        raise failed("''", "no remote is given", "give a folder, ssh://HOST/PATH, HOST:PATH or https://…")
    program = shutil.which("git")
    with Repository(folder) as repository:
        if program is not None:
            from fatektool.history.push.by_git import push_by_git

            return push_by_git(program, repository, remote, timeout_s)
        from fatektool.history.push.by_dulwich import push_by_dulwich

        return push_by_dulwich(repository, remote, timeout_s)
