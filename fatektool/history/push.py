"""A copy of the history in another repository: a folder, or what ssh or http(s) reaches.

Nothing is ever forced: a copy that has gone another way is told, and left as it is. No question is asked and
no wait is without an end, as this runs by night: ssh in batch mode, http with a time for each answer.
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from dulwich.client import LocalGitClient, get_transport_and_path
from dulwich.config import ConfigFile
from dulwich.graph import can_fast_forward
from dulwich.objects import ObjectID
from dulwich.refs import HEADREF, Ref
from dulwich.repo import Repo

from fatektool.errors import FatektoolError, PushFailed
from fatektool.history.repository import Repository

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from collections.abc import Set as AbstractSet

    from dulwich.client import GitClient
    from dulwich.pack import UnpackedObject

_SCHEMES: Final = ("http", "https", "ssh", "git+ssh")
_URL: Final = re.compile(r"([a-z][a-z0-9+.-]*)://", re.ASCII | re.IGNORECASE)
_SCP: Final = re.compile(r"[^/\\:]{2,}:.+")  # host:path; one letter would be a drive
_SECRET: Final = re.compile(r"://[^/@]*@")


@dataclass(frozen=True, slots=True)
class Pushed:
    """What became of a push.

    Attributes:
        remote: where to, without what should not be told of it.
        revision: the newest commit there now, 40 hex digits; None if there is nothing to push yet.
        sent: False if it had all already.
    """

    remote: str
    revision: str | None
    sent: bool


def push(folder: Path, remote: str, *, timeout_s: float = 30.0) -> Pushed:
    """Give another repository all that this one has and it has not.

    Args:
        folder: the history.
        remote: a folder with a bare repository, ``ssh://…``, ``host:path``, ``https://…``, or the name of a
            remote in the history's own git configuration.
        timeout_s: for each answer of a server, in seconds.

    Raises:
        PushFailed: it is not there, refuses, or has gone another way; the history here is as it was.
        UsageError: there is no history here.
        DataError: the history here is damaged.
    """
    with Repository(folder) as repository:
        tip, branch = repository.tip(), Ref(repository.branch().encode())
        place = _configured(repository, remote)
        shown = _SECRET.sub("://", place)
        if tip is None:
            return Pushed(shown, None, sent=False)
        new = ObjectID(tip.encode())
        had: list[ObjectID | None] = []

        def update(refs: dict[Ref, ObjectID]) -> dict[Ref, ObjectID]:
            old = refs.get(branch)
            had.append(old)
            if old is not None and not _leads_to(repository, old, new):
                raise PushFailed(
                    f"{shown} has gone another way: its {branch.decode()} is {old.decode()[:10]}, "
                    f"which {folder} does not come from",
                    hint="nothing was pushed or lost; see with git what it holds, or push to an empty one",
                    remote=shown,
                )
            return {branch: new}

        def pack(
            have: AbstractSet[ObjectID],
            want: AbstractSet[ObjectID],
            *,
            ofs_delta: bool = False,
            progress: Callable[[bytes], None] | None = None,  # noqa: ARG001  # dulwich's signature
        ) -> tuple[int, Iterator[UnpackedObject]]:
            return repository.git.generate_pack_data(set(have), set(want), ofs_delta=ofs_delta)

        try:
            client, path = _client(repository, place, timeout_s)
            result = client.send_pack(path.encode(), update, pack, progress=lambda _: None)
            if isinstance(client, LocalGitClient):
                _let_head_name(path, branch)
        except FatektoolError:
            raise
        except Exception as error:  # ssh, http, sockets, dulwich: each fails with errors of its own
            raise _failed(shown, _SECRET.sub("://", _reason(error))) from error
        for reason in (result.ref_status or {}).values():
            if reason is not None:
                raise _failed(shown, reason)
        return Pushed(shown, tip, sent=had != [new])


def _failed(remote: str, reason: str) -> PushFailed:
    return PushFailed(
        f"could not push to {remote}: {reason}",
        hint="the history here is whole, and the next push brings all of it",
        remote=remote,
    )


def _reason(error: Exception) -> str:
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return " ".join(f"{type(error).__name__}: {text}".split())[:300]


def _configured(repository: Repository, remote: str) -> str:
    """The place itself, or that of a remote of this name: ``git remote add --mirror=push NAS URL``."""
    with repository.door("config"):
        try:
            return repository.git.get_config().get((b"remote", remote.encode()), b"url").decode()
        except KeyError:
            return remote


def _leads_to(repository: Repository, old: ObjectID, new: ObjectID) -> bool:
    if old == new:
        return True
    with repository.door("the commits"):
        try:
            return can_fast_forward(repository.git, old, new)
        except KeyError:  # a commit that is not in here
            return False


def _let_head_name(path: str, branch: Ref) -> None:
    """In a new repository HEAD may name a branch that never comes, and a clone of it would be empty."""
    with Repo(path) as found:
        if found.refs.follow(HEADREF)[1] is None:
            found.refs.set_symbolic_ref(HEADREF, branch)


def _client(repository: Repository, place: str, timeout_s: float) -> tuple[GitClient, str]:
    """Who carries it there, and the path at that place.

    Raises:
        PushFailed: it is no place that can be pushed to.
    """
    url = _URL.match(place)
    local = place.removeprefix("file://") if place.startswith("file://") else place
    if local != place or Path(place).exists() or not (url or _SCP.fullmatch(place)):
        return LocalGitClient(), _local(local)
    if url and url[1].lower() not in _SCHEMES:
        raise _failed(
            place, f"expected a folder, {', '.join(f'{name}://' for name in _SCHEMES)} or host:path"
        )
    config = repository.git.get_config_stack()
    patience = ConfigFile()
    patience.set((b"http",), b"timeout", str(timeout_s).encode())
    config.backends.append(patience)  # the last one: what the user has set goes before it
    try:
        ssh = os.environ.get("GIT_SSH_COMMAND") or config.get((b"core",), b"sshCommand").decode()
    except KeyError:
        ssh = f"ssh -o BatchMode=yes -o ConnectTimeout={timeout_s:.0f} -o ServerAliveInterval={timeout_s:.0f}"
    return get_transport_and_path(place, config=config, operation="push", ssh_command=ssh)


def _local(place: str) -> str:
    """A folder with a bare repository: in one with a work tree, that would be left behind."""
    path = Path(place).absolute()
    if not path.is_dir():
        raise _failed(place, "there is no such folder")
    with Repo(str(path)) as found:  # raises what its message names, if it is none
        if not found.bare:
            raise _failed(place, "it has a work tree, expected a bare repository ('git init --bare')")
    return str(path)
