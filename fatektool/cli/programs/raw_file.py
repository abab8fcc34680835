"""``--raw FILE.bin``: the bare pages of a program beside what else a command writes."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from fatektool.cli.shared.options import is_standard
from fatektool.errors import UsageError

if TYPE_CHECKING:
    from pathlib import Path


def require_raw_name(raw: Path | None, file: Path) -> None:
    """Check that ``--raw`` names a file, and not that of the backup.

    Raises:
        UsageError: it does not.
    """
    if is_standard(raw):
        raise UsageError("--raw -: standard output has other uses here, expected a file name")
    if raw is not None and os.path.realpath(raw) == os.path.realpath(file):
        raise UsageError(f"{raw} is named twice: expected another name for --raw")
