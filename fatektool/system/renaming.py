"""Renaming and removing files that another program may have open.

On Windows neither is possible as long as another program has the file open: a virus scanner has it for some
milliseconds, a metrics collector or an editor for longer. So it is tried again for about a second. Also a
read-only file cannot be removed there; on other systems the folder's permissions decide.
"""

from __future__ import annotations

import stat
import time
from typing import TYPE_CHECKING, Final, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

T = TypeVar("T")

HELD: Final = {5, 32, 33}
"""ERROR_ACCESS_DENIED, ERROR_SHARING_VIOLATION, ERROR_LOCK_VIOLATION; source: winerror.h."""
_PAUSES_S: Final = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4)


def is_held(error: BaseException) -> bool:
    """True for an error of Windows that a file has which another program has open."""
    return getattr(error, "winerror", None) in HELD


def replace_file(source: Path, target: Path, *, sleep: Callable[[float], object] = time.sleep) -> None:
    """Rename a file; a file of that name is replaced.

    Raises:
        OSError: it cannot be renamed.
    """
    _patiently(lambda: source.replace(target), sleep)


def rename_file(source: Path, target: Path, *, sleep: Callable[[float], object] = time.sleep) -> None:
    """Rename a file; on Windows it is an error if there is a file of that name.

    Raises:
        OSError: it cannot be renamed.
    """
    _patiently(lambda: source.rename(target), sleep)


def remove_file(path: Path, *, sleep: Callable[[float], object] = time.sleep) -> None:
    """Remove a file, if it is there.

    Raises:
        OSError: it cannot be removed.
    """

    def removed() -> None:
        try:
            path.unlink(missing_ok=True)
        except PermissionError as error:
            if is_held(error) and not path.stat().st_mode & stat.S_IWRITE:
                path.chmod(stat.S_IWRITE)  # Windows has only this one permission
            raise

    _patiently(removed, sleep)


def _patiently(action: Callable[[], T], sleep: Callable[[float], object]) -> T:
    for pause_s in _PAUSES_S:
        try:
            return action()
        except OSError as error:
            if not is_held(error):
                raise
        sleep(pause_s)
    return action()
