"""Permissions of the files of a history: for user and group, or as git's ``core.sharedRepository`` says.

Several users can write one history after ``git init --bare --shared`` or ``git config core.sharedRepository
group``. Then each must be able to write into the folders, and replace the files, of all others.
"""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from dulwich.config import ConfigFile
from dulwich.file import SharedPerm, adjust_shared_perm
from dulwich.repo import parse_shared_repository

if TYPE_CHECKING:
    from pathlib import Path

FOLDER_MODE: Final = 0o750
FILE_MODE: Final = 0o640


@dataclass(frozen=True, slots=True)
class Rights:
    """The permissions for new files of a history; unchanged if ``shared`` is None."""

    shared: SharedPerm | None = None

    def give(self, path: Path) -> None:
        """Set the permissions of a new file or folder."""
        with contextlib.suppress(FileNotFoundError, PermissionError):  # another process has replaced it
            adjust_shared_perm(path, self.shared)

    def make_folder(self, path: Path) -> None:
        """Make a folder and its parents if they do not exist."""
        if path.is_dir():
            return
        self.make_folder(path.parent)
        path.mkdir(FOLDER_MODE, exist_ok=True)
        self.give(path)


def rights_of(folder: Path) -> Rights:
    """The permissions that the configuration of a repository asks for; the user's own is not read, as in git.

    Raises:
        OSError: the configuration cannot be read.
        ValueError: it is not valid.
    """
    try:
        value = ConfigFile.from_path(str(folder / "config")).get((b"core",), b"sharedRepository")
    except (KeyError, FileNotFoundError):
        return Rights()
    return Rights(parse_shared_repository(value))
