"""Names of PLCs in a history: each is the name of a file, on every system that may clone it."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from fatektool.errors import UsageError
from fatektool.files.portable_name import MOST_BYTES, is_portable_name

SUFFIX: Final = ".json"


def require_name(name: str) -> str:
    """Check the name of a PLC; see ``is_portable_name``. ``@`` is not allowed: a revision follows it.

    Raises:
        UsageError: the name is not valid.
    """
    if not is_portable_name(name):
        raise UsageError(
            f"{name!r} is not a valid name for a PLC: expected up to 64 letters, digits, '_', '-' and '.', "
            f"at most {MOST_BYTES} bytes, not beginning with '-' or '.', and not the name of a port"
        )
    return name


def file_of(name: str) -> bytes:
    """The name of the file with the backup of a PLC."""
    return (require_name(name) + SUFFIX).encode()


@lru_cache(maxsize=8192)  # every tree has a thousand names
def name_of(file: bytes) -> str | None:
    """The PLC whose backup is in this file; None for another file."""
    try:
        text = file.decode()
        return require_name(text.removesuffix(SUFFIX)) if text.endswith(SUFFIX) else None
    except (UnicodeDecodeError, UsageError):
        return None
