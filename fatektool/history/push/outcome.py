"""What becomes of a push."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.errors import PushFailed

if TYPE_CHECKING:
    from pathlib import Path

_LOGIN: Final = re.compile(r"(\w*)://([^/@:\s]*)(?::[^/@\s]*)?@")
_WHOLE: Final = "the history here is whole, and the next push brings all of it"


@dataclass(frozen=True, slots=True)
class Pushed:
    """What became of a push.

    Attributes:
        remote: where to, without what may be a secret.
        revision: the newest commit there now, 40 hex digits; None if there is nothing to push yet.
        sent: False if it had all already.
    """

    remote: str
    revision: str | None
    sent: bool


def without_secrets(text: str) -> str:
    """A text whose URLs name no password, and no user but that of ssh: elsewhere that may be a token."""
    return _LOGIN.sub(lambda url: f"ssh://{url[2]}@" if url[1] == "ssh" else f"{url[1]}://", text)


def failed(remote: str, reason: str, next_step: str) -> PushFailed:
    """The error for a push that did not work.

    Args:
        remote: where to.
        reason: what happened; in one line.
        next_step: what the user can do.
    """
    shown = without_secrets(remote)
    return PushFailed(
        f"could not push to {shown}: {without_secrets(reason)}",
        hint=f"{_WHOLE}; {next_step}",
        remote=shown,
    )


def gone_another_way(remote: str, branch: str, folder: Path) -> PushFailed:
    """The error for a copy with commits that the history does not come from."""
    shown = without_secrets(remote)
    return PushFailed(
        f"{shown} has gone another way: its {branch} has commits that {folder} does not come from",
        hint="nothing was pushed or lost; see with git what it holds, or push to an empty one",
        remote=shown,
    )
