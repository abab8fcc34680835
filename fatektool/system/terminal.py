"""Whether a stream is a terminal: on Windows ``isatty`` is true also for NUL, from which nobody answers."""

from __future__ import annotations

import ctypes
import sys
from typing import TextIO


def is_terminal(stream: TextIO) -> bool:
    """True for a terminal, on Windows for a console."""
    return stream.isatty() and has_console_mode(stream.fileno())


def has_console_mode(descriptor: int) -> bool:
    """True if a descriptor is of a console; always on other systems, where ``isatty`` knows a terminal."""
    if sys.platform != "win32":
        return True
    import msvcrt

    mode = ctypes.c_uint32()
    handle = ctypes.c_void_p(msvcrt.get_osfhandle(descriptor))
    return bool(ctypes.windll.kernel32.GetConsoleMode(handle, ctypes.byref(mode)))
