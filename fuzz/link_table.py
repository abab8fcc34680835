"""Communication tables as TOML: read and written again without loss, or refused in one plain line."""

from __future__ import annotations

from fatektool.errors import DataError
from fatektool.jobs.plcports.toml import load_table
from fatektool.jobs.plcports.toml_text import dump_table
from fuzz.words import require_plain


def one_input(data: bytes) -> None:
    """Read; what is taken is written, read again and the same."""
    try:
        found = load_table(data, "table.toml")
    except DataError as error:
        require_plain(error)
        return
    assert load_table(dump_table(found).encode(), "again") == found
