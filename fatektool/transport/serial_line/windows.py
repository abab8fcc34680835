"""Serial ports of Windows: their names, and what each error number means.

pyserial keeps the number only as text, at the end of its own message, and before it a message in the language
of the system::

    could not open port 'COM3': PermissionError(13, 'Zugriff verweigert', None, 5)
    Cannot configure port, something went wrong. Original message: OSError(22, 'The parameter …', None, 87)
    ClearCommError failed (PermissionError(13, 'The device does not recognize the command.', None, 22))

Source of the numbers: winerror.h.
"""

from __future__ import annotations

import re
from enum import Enum
from typing import Final, NamedTuple

from fatektool.errors import UsageError
from fatektool.files.portable_name import device_of_name

_PORT: Final = re.compile(r"(?:[\\/]{2}[.?][\\/])?(COM\d+):?", re.ASCII | re.IGNORECASE)
_ERROR: Final = re.compile(r"\w+\(-?\d+, (['\"])(.*)\1, None, (\d+)\)", re.DOTALL)


class WindowsErrorKind(Enum):
    """What a number means for the user."""

    MISSING = "missing"
    BUSY = "busy"
    NOT_SUPPORTED = "not supported"
    BROKEN = "broken"
    GONE = "gone"
    UNKNOWN = "unknown"


class WindowsError(NamedTuple):
    """One error number.

    Attributes:
        number: of winerror.h.
        kind: what it means when the port is opened or set up; while it is used, the device is gone.
        text: the meaning, the same in each language of the system; of an unknown number the system's own.
    """

    number: int
    kind: WindowsErrorKind
    text: str

    def __str__(self) -> str:
        return f"Windows error {self.number}"


_TABLE: Final = (
    WindowsError(1, WindowsErrorKind.NOT_SUPPORTED, "it is not a serial port"),
    WindowsError(2, WindowsErrorKind.MISSING, "no such port"),
    WindowsError(3, WindowsErrorKind.MISSING, "no such port"),
    WindowsError(5, WindowsErrorKind.BUSY, "access denied"),
    WindowsError(6, WindowsErrorKind.NOT_SUPPORTED, "it is not a serial port"),
    WindowsError(15, WindowsErrorKind.MISSING, "no such port"),
    WindowsError(20, WindowsErrorKind.GONE, "the device is not connected"),
    WindowsError(21, WindowsErrorKind.GONE, "the device is not ready"),
    WindowsError(22, WindowsErrorKind.GONE, "the device does not accept commands"),
    WindowsError(31, WindowsErrorKind.BROKEN, "the device or its driver does not work"),
    WindowsError(32, WindowsErrorKind.BUSY, "another program has the port open"),
    WindowsError(50, WindowsErrorKind.NOT_SUPPORTED, "the driver does not support this"),
    WindowsError(53, WindowsErrorKind.MISSING, "no such port"),
    WindowsError(55, WindowsErrorKind.GONE, "the device is no longer available"),
    WindowsError(87, WindowsErrorKind.NOT_SUPPORTED, "the driver does not accept this baud rate or format"),
    WindowsError(121, WindowsErrorKind.GONE, "the device does not answer the driver"),
    WindowsError(123, WindowsErrorKind.MISSING, "no such port"),
    WindowsError(161, WindowsErrorKind.MISSING, "no such port"),
    WindowsError(170, WindowsErrorKind.BUSY, "another program has the port open"),
    WindowsError(433, WindowsErrorKind.GONE, "the device no longer exists"),
    WindowsError(617, WindowsErrorKind.GONE, "the device was removed"),
    WindowsError(995, WindowsErrorKind.GONE, "the driver aborted the operation"),
    WindowsError(1117, WindowsErrorKind.BROKEN, "the device or its driver does not work"),
    WindowsError(1167, WindowsErrorKind.GONE, "the device is not connected"),
    WindowsError(1450, WindowsErrorKind.BROKEN, "the system has no resources for the device"),
    WindowsError(1617, WindowsErrorKind.GONE, "the device was removed"),
)
ERRORS: Final = {each.number: each for each in _TABLE}


def port_name(device: str) -> str:
    r"""One name for all names of a port: ``COM1`` for ``\\.\com1`` and ``COM1:``."""
    found = _PORT.fullmatch(device)
    return found[1].upper() if found else device


def require_port(target: str, device: str) -> None:
    """Check that a name does not open a port only because its first part is that of one.

    Args:
        target: as the user wrote it.
        device: its device.

    Raises:
        UsageError: it does, as ``com2.json`` opens COM2.
    """
    found = device_of_name(device)
    if found is not None and not _PORT.fullmatch(device):
        raise UsageError(
            f"{target}: on Windows this name opens the device {found}",
            hint="for a port write its name alone, such as COM2",
        )


def windows_error(error: BaseException) -> WindowsError | None:
    """The meaning of an error; None if it is of another system.

    Args:
        error: of pyserial, or the OSError itself.
    """
    number, text = getattr(error, "winerror", None), getattr(error, "strerror", None)
    if not isinstance(number, int):
        found = _ERROR.search(str(error))
        if found is None:
            return None
        number, text = int(found[3]), re.sub(r"\\(.)", r"\1", found[2])
    unknown = WindowsError(number, WindowsErrorKind.UNKNOWN, (text or "unknown error").rstrip(". "))
    return ERRORS.get(number, unknown)
