"""A file or folder as the value of an option: ``pathlib`` is loaded when one is given."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from pathlib import Path


class FilePath(click.Path):
    """Gives a ``pathlib.Path``; it need not be there."""

    def coerce_path_result(self, value: str | os.PathLike[str]) -> Path:
        """Make one of what was given."""
        from pathlib import Path

        return Path(standard(os.fspath(value)))


def is_standard(path: Path | None) -> bool:
    """True for ``-``, which is standard input or output."""
    return str(path) == "-"


def standard(name: str) -> str:
    """``-`` for the names that the system has for the standard streams."""
    return "-" if name in {"/dev/stdin", "/dev/stdout"} else name
