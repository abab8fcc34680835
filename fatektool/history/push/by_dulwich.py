"""Push with dulwich, if there is no git program.

Not supported, unlike git: hooks (a repository with hooks on this computer is refused, because one of them may
forbid the push), ``insteadOf``, ``credential.helper``, several ``pushurl`` of one remote. As in git:
``pushurl``, paths relative to the history, GIT_SSH_COMMAND, ``core.sshCommand``, GIT_SSH. No force, no
question, a limit of time for each answer.
"""

from __future__ import annotations

import os
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Final

from dulwich.client import LocalGitClient, Urllib3HttpGitClient, get_transport_and_path
from dulwich.config import ConfigFile
from dulwich.graph import can_fast_forward
from dulwich.objects import ObjectID
from dulwich.refs import Ref
from dulwich.repo import Repo

from fatektool.errors import FatektoolError
from fatektool.history.push.outcome import Pushed, diverged, failed, without_secrets
from fatektool.history.push.place import URL, folder_of, is_bare, let_head_name
from fatektool.history.repository import release
from fatektool.system.shell import quoted

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from collections.abc import Set as AbstractSet

    from dulwich.client import GitClient
    from dulwich.config import Config
    from dulwich.pack import UnpackedObject

    from fatektool.errors import PushFailed
    from fatektool.history.repository import Repository

_SCHEMES: Final = ("http", "https", "ssh", "git+ssh")
_NEXT: Final = "install git: then its own push is used"


def push_by_dulwich(repository: Repository, remote: str, timeout_s: float) -> Pushed:
    """Push with dulwich.

    Args:
        repository: the history.
        remote: see ``push``.
        timeout_s: see ``push``.

    Raises:
        PushFailed: the remote cannot be reached, refuses, has other commits, or needs git.
    """
    tip, branch = repository.tip(), Ref(repository.branch().encode())
    place, base = _configured(repository, remote)
    shown = without_secrets(place)
    if tip is None:
        return Pushed(shown, None, sent=False)
    try:
        client, path = _client(repository, place, base, timeout_s)
        try:
            sent = _send(repository, (client, path), shown, branch, ObjectID(tip.encode()))
        finally:
            if isinstance(client, Urllib3HttpGitClient):
                client.pool_manager.clear()
    except FatektoolError:
        raise
    except Exception as error:  # ssh, http, sockets, dulwich: each has its own errors
        reason = _reason(error)
        release(error)
        raise _failed(shown, reason) from error
    if isinstance(client, LocalGitClient):
        let_head_name(Path(path), branch)
    return Pushed(shown, tip, sent=sent)


def _send(repository: Repository, way: tuple[GitClient, str], shown: str, branch: Ref, new: ObjectID) -> bool:
    """Send what is missing there; False if nothing is."""
    client, path = way
    had: list[ObjectID | None] = []

    def update(refs: dict[Ref, ObjectID]) -> dict[Ref, ObjectID]:
        old = refs.get(branch)
        had.append(old)
        if old is not None and not _leads_to(repository, old, new):
            raise diverged(shown, branch.decode(), repository.folder)
        return {branch: new}

    def pack(
        have: AbstractSet[ObjectID],
        want: AbstractSet[ObjectID],
        *,
        ofs_delta: bool = False,
        progress: Callable[[bytes], None] | None = None,  # noqa: ARG001  # dulwich's signature
    ) -> tuple[int, Iterator[UnpackedObject]]:
        return repository.git.generate_pack_data(set(have), set(want), ofs_delta=ofs_delta)

    result = client.send_pack(path.encode(), update, pack, progress=lambda _: None)
    for reason in (result.ref_status or {}).values():
        if reason is not None:
            raise _failed(shown, reason)
    return had != [new]


def _failed(remote: str, reason: str) -> PushFailed:
    return failed(remote, reason, _NEXT)


def _reason(error: Exception) -> str:
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return " ".join(f"{type(error).__name__}: {text}".split())[:300]


def _configured(repository: Repository, remote: str) -> tuple[str, Path]:
    """The remote itself or the URL of the remote of this name, and the base of a relative path."""
    section = (b"remote", remote.encode())
    with repository.guard("config"):
        config = repository.git.get_config()
        for name in (b"pushurl", b"url"):
            places = _all(config, section, name)
            if len(places) > 1 and name == b"pushurl":
                raise _failed(remote, "it has several pushurl: only the git program can push to these")
            if places:
                return places[0], repository.folder
    return remote, Path()


def _all(config: Config, section: tuple[bytes, bytes], name: bytes) -> list[str]:
    try:
        return [value.decode() for value in config.get_multivar(section, name)]
    except KeyError:
        return []


def _leads_to(repository: Repository, old: ObjectID, new: ObjectID) -> bool:
    if old == new:
        return True
    with repository.guard("the commits"):
        try:
            return can_fast_forward(repository.git, old, new)
        except KeyError:  # a commit that is not in the history
            return False


def _client(repository: Repository, place: str, base: Path, timeout_s: float) -> tuple[GitClient, str]:
    """The client of dulwich for the remote, and the path there.

    Raises:
        PushFailed: it is not a remote that can be pushed to.
    """
    folder = folder_of(place, base)
    if folder is not None:
        return LocalGitClient(), _local(place, folder)
    url = URL.match(place)
    if url and url[1].lower() not in _SCHEMES:
        raise _failed(
            place, f"expected a folder, {', '.join(f'{name}://' for name in _SCHEMES)} or host:path"
        )
    config = repository.git.get_config_stack()
    patience = ConfigFile()
    patience.set((b"http",), b"timeout", str(timeout_s).encode())
    config.backends.append(patience)  # the last one: the user's settings take precedence
    return get_transport_and_path(
        place, config=config, operation="push", ssh_command=_ssh(repository, timeout_s)
    )


def _ssh(repository: Repository, timeout_s: float) -> str:
    """The user's ssh command, looked up in git's order; else ssh without questions."""
    named = os.environ.get("GIT_SSH_COMMAND")
    if named:
        return named
    try:
        return repository.git.get_config_stack().get((b"core",), b"sshCommand").decode()
    except KeyError:
        program = os.environ.get("GIT_SSH")
    if program:
        return shlex.quote(program)
    return f"ssh -o BatchMode=yes -o ConnectTimeout={timeout_s:.0f} -o ServerAliveInterval={timeout_s:.0f}"


def _local(place: str, folder: Path) -> str:
    """A folder with a bare repository without hooks. A work tree would not be updated by the push."""
    if not folder.is_dir():
        raise failed(
            place, "the folder does not exist", f"create the folder: git init --bare {quoted(place)}"
        )
    with Repo(str(folder)) as found:  # raises if it is not a repository
        if not is_bare(found):
            raise _failed(place, "it has a work tree, expected a bare repository ('git init --bare')")
        hooks = _hooks(found)
    if hooks:
        raise _failed(place, f"it has a hook, {hooks[0]}, which only the git program can run")
    return str(folder)


def _hooks(found: Repo) -> list[str]:
    """The hooks that a push with git would run."""
    try:
        named = found.get_config_stack().get((b"core",), b"hooksPath").decode()
    except KeyError:
        named = "hooks"
    folder = Path(found.controldir(), named)
    names = ("pre-receive", "update", "post-receive", "post-update", "proc-receive", "reference-transaction")
    return [name for name in names if os.access(folder / name, os.X_OK)]
