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
_DRIVE: Final = re.compile(r"(?:[\\/]{2}[?.][\\/])?(?:[A-Za-z]:)?")
_NOT_IN_NAMES: Final = re.compile(r'[<>:"|?*\x00-\x1f]')


def device_of_name(path: str) -> str | None:
    r"""The device that Windows opens for a file's name: COM2 for ``backups\com2.json``; None for a file.

    Args:
        path: of a file, with or without folders.
    """
    name = re.split(r"[/\\]", path)[-1]
    stem = re.split("[.:]", name)[0].rstrip(" ")
    return stem.upper() if _OPENED.fullmatch(stem) else None


def fault_of_name(path: str) -> str | None:
    r"""Why Windows does not write a file of this name; None if it does.

    ``press:1.json`` would be a hidden part of a file ``press``, and ``press.json.`` the file ``press.json``.

    Args:
        path: of a file or folder, with or without a drive and folders.
    """
    if device := device_of_name(path):
        return f"this name opens the device {device}"
    rest = _DRIVE.sub("", path, count=1)
    if found := _NOT_IN_NAMES.search(rest):
        return f"a file name cannot contain {found[0]!r}"
    parts = [part for part in re.split(r"[/\\]", rest) if part.strip(".")]
    if any(part.endswith((" ", ".")) for part in parts):
        return "a file name cannot end with a full stop or a space"
    return None


def require_file_name(path: str) -> None:
    """Check, on Windows, that a file of this name can be written and is found again.

    Raises:
        UsageError: the name opens a device, or Windows would use another one.
    """
    if WINDOWS and (fault := fault_of_name(path)):
        raise UsageError(f"{path}: on Windows {fault}", hint="choose another file name")


def is_portable_name(name: str) -> bool:
    """True for letters, digits, ``_``, ``-`` and ``.``, 64 characters and 250 bytes at most.

    The first is a letter, a digit or ``_``: never a path, an option or a hidden file. The names of devices on
    Windows (``COM3``, ``nul.x``) are none, nor are names that end with a full stop, which Windows leaves out.
    """
    if not _NAME.fullmatch(name) or name.endswith(".") or _DEVICE.fullmatch(name.partition(".")[0]):
        return False
    return len(name.encode()) <= MOST_BYTES
