"""Push with the git program: ``git push`` without questions and without force.

::

    git -C HISTORY --git-dir=. push --porcelain --progress -- REMOTE HASH:refs/heads/main
    stdout  To ../nas
            !  HASH:refs/heads/main  [remote rejected] (pre-receive hook declined)
    stderr  remote: closed until Monday
            error: failed to push some refs to '../nas'

Paths on the command line are relative to the current folder; those in the configuration are relative to the
history, as in git.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Final

from dulwich.refs import Ref

from fatektool.history.push.bounded import Ended, run_bounded
from fatektool.history.push.outcome import Pushed, diverged, failed, without_secrets
from fatektool.history.push.place import folder_of, let_head_name
from fatektool.system.shell import command_line, quoted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.errors import PushFailed
    from fatektool.history.repository import Repository

# They name another repository if this runs in one of its hooks. SSH_ASKPASS opens a window for a password.
_NOT_OURS: Final = {
    *(
        "GIT_DIR",
        "GIT_WORK_TREE",
        "GIT_INDEX_FILE",
        "GIT_OBJECT_DIRECTORY",
        "GIT_COMMON_DIR",
        "GIT_NAMESPACE",
    ),
    *("GIT_ALTERNATE_OBJECT_DIRECTORIES", "GIT_QUARANTINE_PATH", "GIT_PREFIX", "SSH_ASKPASS"),
}
_NO_QUESTIONS: Final = {
    "GIT_TERMINAL_PROMPT": "0",
    "GCM_INTERACTIVE": "never",
    "SSH_ASKPASS_REQUIRE": "never",
    "LANGUAGE": "en",  # messages quote git
}
_SILENCES: Final = 4  # between two outputs git may compute, and hooks may run
_DIVERGED: Final = re.compile(r"\[rejected\] \((fetch first|non-fast-forward)\)")
_NOISE: Final = re.compile(
    r"(remote: )?(Enumerating|Counting|Compressing|Writing|Resolving|Unpacking|Checking) [\w ]+:"
    r"|(remote: )?Total \d|Delta compression|hint:|To |Done$|remote: *$"
    r"|fatal: Could not read from remote repository"
    r"|Please make sure you have the correct access|and the repository exists\.$"
)
_MOST: Final = 400


def push_by_git(program: str, repository: Repository, remote: str, timeout_s: float) -> Pushed:
    """Push with git.

    Args:
        program: git.
        repository: the history.
        remote: see ``push``.
        timeout_s: see ``push``.

    Raises:
        PushFailed: git failed, or wrote nothing for too long.
    """
    return _Push(program, repository, timeout_s).to(remote)


class _Push:
    def __init__(self, program: str, repository: Repository, timeout_s: float) -> None:
        self.repository = repository
        self.folder = repository.folder
        self.branch = repository.branch()
        self.timeout_s = timeout_s
        self.git = (program, "-C", str(self.folder), "--git-dir=.")
        self.environment = {name: text for name, text in os.environ.items() if name not in _NOT_OURS}
        self.environment |= _NO_QUESTIONS

    def to(self, remote: str) -> Pushed:
        tip = self.repository.tip()
        settings, named = self._named(remote)
        places = named or [remote]
        local = [folder_of(place, self.folder if named else Path()) for place in places]
        shown = without_secrets(", ".join(places))
        for place, path in zip(places, local, strict=True):
            if path is not None and not path.is_dir():
                raise failed(
                    place,
                    "the folder does not exist",
                    f"create the folder: git init --bare {quoted(place)}",
                )
        if tip is None:
            return Pushed(shown, None, sent=False)
        if not named and local[0] is not None and "://" not in remote:
            remote = str(local[0])
        self._set_ssh_command()
        words = ["push", "--porcelain", "--progress", "--", remote, f"{tip}:{self.branch}"]
        ended = self._run(remote, *settings, *words, silence_s=_SILENCES * self.timeout_s)
        if ended.code != 0:
            raise self._error(shown, remote, ended)
        for path in local:
            if path is not None:
                let_head_name(path, Ref(self.branch.encode()))
        return Pushed(shown, tip, sent=any(flag != "=" for flag, _ in _results(ended.out)))

    def _named(self, remote: str) -> tuple[list[str], list[str]]:
        """Settings for git, and the URLs of the remote of this name; none if there is no such remote."""
        found = self._run(remote, "remote", "get-url", "--push", "--all", "--", remote)
        if found.code != 0:
            return [], []
        # To a mirror git cannot push one branch, and it would force.
        return ["-c", f"remote.{remote}.mirror=false"], found.out.splitlines()

    def _set_ssh_command(self) -> None:
        """Set an ssh command without questions, unless the user has set one."""
        if {"GIT_SSH_COMMAND", "GIT_SSH"} & self.environment.keys():
            return
        if self._run("", "config", "--get", "core.sshCommand").code != 0:
            seconds = f"{max(self.timeout_s, 1):.0f}"
            self.environment["GIT_SSH_COMMAND"] = (
                f"ssh -o BatchMode=yes -o ConnectTimeout={seconds} -o ServerAliveInterval={seconds}"
            )

    def _run(self, remote: str, *words: str, silence_s: float = 60.0) -> Ended:
        try:
            ended = run_bounded((*self.git, *words), self.environment, silence_s)
        except OSError as error:
            raise failed(
                remote, f"git cannot be started: {error.strerror}", "check that 'git --version' works"
            ) from error
        if ended.code is None:
            said = _words(ended.err)
            raise failed(
                remote,
                f"git wrote nothing for {silence_s:.0f} s" + (f" after: {said}" if said else ""),
                self._by_hand(remote),
            )
        return ended

    def _error(self, shown: str, remote: str, ended: Ended) -> PushFailed:
        refused = [summary for flag, summary in _results(ended.out) if flag == "!"]
        if any(map(_DIVERGED.search, refused)):
            return diverged(shown, self.branch, self.folder)
        reasons = [*refused, _words(ended.err)] if refused else [_words(ended.err)]
        reason = "; ".join(filter(None, reasons)) or f"git ended with {ended.code}"
        return failed(shown, reason, self._by_hand(remote))

    def _by_hand(self, remote: str) -> str:
        words = ["git", "-C", str(self.folder), "push", without_secrets(remote), self.branch]
        return f"for git's own messages run: {command_line(words)}"


def _results(out: str) -> Iterator[tuple[str, str]]:
    """The result for the branch, for each URL: a flag and a summary."""
    for line in out.splitlines():
        flag, *rest = line.split("\t")
        if len(rest) == 2 and len(flag) == 1:  # flag, from:to, summary
            yield flag, rest[1]


def _words(err: str) -> str:
    """The messages of git, ssh and the server in one line, without progress and advice."""
    lines = [line.strip() for line in re.split(r"[\r\n]+", err)]
    said = [re.sub(r"\x1b\[[0-9;]*[A-Za-z]", "", line) for line in lines if line and not _NOISE.match(line)]
    return " / ".join(said).rstrip(".")[:_MOST]
