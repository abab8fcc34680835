"""The rights of what is written: the user's and the group's, or as git's ``core.sharedRepository`` asks.

Several users write one history after ``git init --bare --shared`` or ``git config core.sharedRepository
group``: then each must be able to write into the folders, and over the files, of all others.
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
    """What the files of a history are to be for others; as they were made, unless ``shared`` says more."""

    shared: SharedPerm | None = None

    def give(self, path: Path) -> None:
        """Give a file or folder that was just made its rights."""
        with contextlib.suppress(FileNotFoundError, PermissionError):  # another process has it already
            adjust_shared_perm(path, self.shared)

    def make_folder(self, path: Path) -> None:
        """Make a folder, and those that it is in, unless they are there."""
        if path.is_dir():
            return
        self.make_folder(path.parent)
        path.mkdir(FOLDER_MODE, exist_ok=True)
        self.give(path)


def rights_of(folder: Path) -> Rights:
    """The rights that a repository's own configuration asks for; not the user's, as git has it too.

    Raises:
        OSError: it cannot be read.
        ValueError: it is none.
    """
    try:
        value = ConfigFile.from_path(str(folder / "config")).get((b"core",), b"sharedRepository")
    except (KeyError, FileNotFoundError):
        return Rights()
    return Rights(parse_shared_repository(value))
