"""Where a push goes: the folder that a place on this computer is, and what can be said of it beforehand."""

from __future__ import annotations

import contextlib
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import urlsplit
from urllib.request import url2pathname

from dulwich.refs import HEADREF
from dulwich.repo import Repo

if TYPE_CHECKING:
    from dulwich.refs import Ref

URL: Final = re.compile(r"([a-z][a-z0-9+.-]*)://", re.ASCII | re.IGNORECASE)
_HELPER: Final = re.compile(r"[a-z0-9-]+::", re.ASCII | re.IGNORECASE)  # git's own: ext::…
_SCP: Final = re.compile(r"[^/\\:]{2,}:" if os.name == "nt" else "[^/:]+:")  # host:path; C: is a drive there


def folder_of(place: str, base: Path) -> Path | None:
    """The folder that a place means; None if it is not on this computer.

    Args:
        place: as the user or git's configuration names it; a ``file:`` URL may have ``%20`` in it.
        base: what a relative path is relative to.
    """
    url = URL.match(place)
    if url is not None:
        if url[1].lower() != "file":
            return None
        return Path(url2pathname(urlsplit(place).path))
    path = Path(os.path.abspath(base / place))  # noqa: PTH100  # resolve() would follow links
    if not path.exists() and (_SCP.match(place) or _HELPER.match(place)):
        return None
    return path


def is_bare(found: Repo) -> bool:
    """True for a repository without a work tree; the ``.git`` of one that has such a tree is none."""
    try:
        return bool(found.bare and found.get_config().get_boolean((b"core",), b"bare", default=True))
    except ValueError:
        return False


def let_head_name(path: Path, branch: Ref) -> None:
    """Let HEAD of a new bare repository name the branch that came, or a clone of it would be empty.

    What was pushed is there all the same if this cannot be done.
    """
    with contextlib.suppress(Exception), Repo(str(path)) as found:
        if is_bare(found) and found.refs.follow(HEADREF)[1] is None:
            found.refs.set_symbolic_ref(HEADREF, branch)
