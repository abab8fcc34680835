"""Names that can be a file's name on every system."""

from __future__ import annotations

import os
import re
from typing import Final

from fatektool.errors import UsageError

WINDOWS: Final = os.name == "nt"

MOST_BYTES: Final = 250
"""Most bytes of a name: with a suffix such as ``.json`` a file system takes 255."""

_NAME: Final = re.compile(r"\w[\w.-]{0,63}")
_DEVICE: Final = re.compile(r"(?:COM|LPT)\d+|CON|PRN|AUX|NUL", re.ASCII | re.IGNORECASE)


_OPENED: Final = re.compile(
    r"(?:COM|LPT)[0-9\u00b9\u00b2\u00b3]|CON|PRN|AUX|NUL|CONIN\$|CONOUT\$", re.IGNORECASE
)


def device_of_name(path: str) -> str | None:
    r"""The device that Windows opens for a file's name: COM2 for ``backups\com2.json``; None for a file.

    Args:
        path: of a file, with or without folders.
    """
    name = re.split(r"[/\\]", path)[-1]
    stem = re.split("[.:]", name)[0].rstrip(" ")
    return stem.upper() if _OPENED.fullmatch(stem) else None


def require_no_device(path: str) -> None:
    """Check, on Windows, that a file's name does not open a device.

    Raises:
        UsageError: it does.
    """
    if WINDOWS and (device := device_of_name(path)):
        raise UsageError(
            f"{path}: on Windows this name opens the device {device}", hint="choose another file name"
        )


def is_portable_name(name: str) -> bool:
    """True for letters, digits, ``_``, ``-`` and ``.``, 64 characters and 250 bytes at most.

    The first is a letter, a digit or ``_``: never a path, an option or a hidden file. The names of devices on
    Windows (``COM3``, ``nul.x``) are none.
    """
    if not _NAME.fullmatch(name) or _DEVICE.fullmatch(name.partition(".")[0]):
        return False
    return len(name.encode()) <= MOST_BYTES
