"""Names that can be a file's name on every system."""

from __future__ import annotations

import re
from typing import Final

MOST_BYTES: Final = 250
"""Most bytes of a name: with a suffix such as ``.json`` a file system takes 255."""

_NAME: Final = re.compile(r"\w[\w.-]{0,63}")
_DEVICE: Final = re.compile(r"(?:COM|LPT)\d+|CON|PRN|AUX|NUL", re.ASCII | re.IGNORECASE)


def is_portable_name(name: str) -> bool:
    """True for letters, digits, ``_``, ``-`` and ``.``, 64 characters and 250 bytes at most.

    The first is a letter, a digit or ``_``: never a path, an option or a hidden file. The names of devices on
    Windows (``COM3``, ``nul.x``) are none.
    """
    if not _NAME.fullmatch(name) or _DEVICE.fullmatch(name.partition(".")[0]):
        return False
    return len(name.encode()) <= MOST_BYTES
