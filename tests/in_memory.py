"""Temporary folders of the tests in memory, where the system has a place for that.

The program syncs each file that it writes, and its folder, which takes some milliseconds on a disk, thousands
of times in a run. In memory it takes none, and nothing else differs.
"""

from __future__ import annotations

import os
from typing import Final

_PLACE: Final = "/dev/shm"  # noqa: S108  # pytest makes a folder in it for this user alone
_ROOM: Final = 2 << 30


def keep_in_memory() -> None:
    """Have pytest make its folders there, unless told where to; programs must run from it."""
    if os.name != "posix" or not os.access(_PLACE, os.W_OK):  # in Wine the folder is there, its size is not
        return
    found = os.statvfs(_PLACE)
    if found.f_bavail * found.f_frsize >= _ROOM and not found.f_flag & os.ST_NOEXEC:
        os.environ.setdefault("PYTEST_DEBUG_TEMPROOT", _PLACE)
