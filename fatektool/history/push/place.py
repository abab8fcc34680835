"""The destination of a push: is it a folder on this computer, and is it a bare repository?"""

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
    """The folder of a destination; None if it is not on this computer.

    Args:
        place: as the user or git's configuration gives it; a ``file:`` URL may have ``%20`` in it.
        base: the folder that a relative path starts from.
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
    """True for a repository without a work tree; the ``.git`` folder of a work tree is not bare."""
    try:
        return bool(found.bare and found.get_config().get_boolean((b"core",), b"bare", default=True))
    except ValueError:
        return False


def let_head_name(path: Path, branch: Ref) -> None:
    """Let HEAD of a new bare repository name the pushed branch: a clone of it would be empty otherwise.

    If this fails, the push is complete all the same.
    """
    with contextlib.suppress(Exception), Repo(str(path)) as found:
        if is_bare(found) and found.refs.follow(HEADREF)[1] is None:
            found.refs.set_symbolic_ref(HEADREF, branch)
