"""A file or folder as the value of an option: ``pathlib`` is loaded when one is given."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    import os
    from pathlib import Path


class FilePath(click.Path):
    """Gives a ``pathlib.Path``; it need not be there."""

    def coerce_path_result(self, value: str | os.PathLike[str]) -> Path:
        """Make one of what was given."""
        from pathlib import Path

        return Path(value)
