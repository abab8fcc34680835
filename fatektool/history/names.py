"""What a PLC may be called in a history: its name is a file's name, on every system that may clone it."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from fatektool.errors import UsageError
from fatektool.files.portable_name import MOST_BYTES, is_portable_name

SUFFIX: Final = ".json"


def require_name(name: str) -> str:
    """Check a PLC's name: letters, digits, ``_``, ``-`` and ``.``, the first a letter, digit or ``_``.

    Never a path, no control characters, no ``@`` (that is where a revision begins), no name that Windows
    keeps for a device, 64 characters and 250 bytes at most.

    Raises:
        UsageError: it is none.
    """
    if not is_portable_name(name):
        raise UsageError(
            f"{name!r} is no name for a PLC: expected up to 64 letters, digits, '_', '-' and '.', "
            f"{MOST_BYTES} bytes, not beginning with '-' or '.', and no port's name"
        )
    return name


def file_of(name: str) -> bytes:
    """The file in which a PLC's backup lies."""
    return (require_name(name) + SUFFIX).encode()


@lru_cache(maxsize=8192)  # a thousand names stand in every tree
def name_of(file: bytes) -> str | None:
    """The PLC whose backup is in this file; None for a file that is none of ours."""
    try:
        text = file.decode()
        return require_name(text.removesuffix(SUFFIX)) if text.endswith(SUFFIX) else None
    except (UnicodeDecodeError, UsageError):
        return None
