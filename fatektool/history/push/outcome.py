"""The result of a push, and its errors."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import PushFailed

if TYPE_CHECKING:
    from pathlib import Path

_LOGIN: Final = re.compile(r"(\w*)://([^/@:\s]*)(?::[^/@\s]*)?@")
_SAFE: Final = "nothing is lost: the next push includes everything"


@dataclass(frozen=True, slots=True)
class Pushed:
    """The result of a push.

    Attributes:
        remote: the remote, without passwords.
        revision: the newest commit there now, 40 hex digits; None if there is nothing to push yet.
        sent: False if the remote was up to date.
    """

    remote: str
    revision: str | None
    sent: bool


def without_secrets(text: str) -> str:
    """The text without passwords in its URLs, and without users but those of ssh: a user may be a token."""
    return _LOGIN.sub(lambda url: f"ssh://{url[2]}@" if url[1] == "ssh" else f"{url[1]}://", text)


def failed(remote: str, reason: str, next_step: str) -> PushFailed:
    """The error for a push that failed.

    Args:
        remote: the remote.
        reason: what happened, in one line.
        next_step: what the user can do.
    """
    shown = without_secrets(remote)
    return PushFailed(
        f"could not push to {shown}: {without_secrets(reason)}",
        hint=f"{_SAFE}; {next_step}",
        remote=shown,
    )


def diverged(remote: str, branch: str, folder: Path) -> PushFailed:
    """The error for a remote with commits that are not in the history."""
    shown = without_secrets(remote)
    return PushFailed(
        f"{shown} has other commits: its {branch} has commits that are not in {folder}",
        hint="nothing was pushed or lost; examine the remote with git, or push to an empty repository",
        remote=shown,
    )
