"""Tests as another user than root, whom no mode of a file keeps out; in CI the user is mostly root."""

from __future__ import annotations

import os
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

IS_ROOT: Final = hasattr(os, "geteuid") and os.geteuid() == 0
NOBODY: Final = 65534

two_users = pytest.mark.skipif(not IS_ROOT, reason="only root can be two users")
not_as_root_alone = pytest.mark.skipif(
    IS_ROOT and not hasattr(os, "setresuid"), reason="root may do everything, and cannot be another user here"
)


@contextmanager
def no_root() -> Iterator[None]:
    """Be nobody, if this is root, for the length of a ``with`` statement.

    What is imported meanwhile must be loaded before: nobody may not read the Python of root.
    """
    if not IS_ROOT:
        yield
        return
    os.setresuid(NOBODY, NOBODY, 0)
    try:
        yield
    finally:
        os.setresuid(0, 0, 0)


@contextmanager
def folder_for_all() -> Iterator[Path]:
    """A folder of which any user finds the way: pytest's own are closed to others."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o777)
        yield folder
        folder.chmod(0o777)
