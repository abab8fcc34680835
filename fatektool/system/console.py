"""The console of Windows: what happens at Ctrl-Break, when its window is closed, or the user logs off.

The system then calls a handler in a thread of its own. The handler interrupts the main thread, as Ctrl-C
does. If the console is closed, the system ends the process as soon as the handler returns, or after five
seconds. So the handler waits for the end.
"""

from __future__ import annotations

import _thread
import ctypes
import sys
import time
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Callable

_BREAK: Final = 1  # CTRL_BREAK_EVENT
_ENDING: Final = {2, 5, 6}  # CTRL_CLOSE_EVENT, CTRL_LOGOFF_EVENT, CTRL_SHUTDOWN_EVENT
_MOST_S: Final = 20.0
_kept: list[Any] = []


def end_with_console() -> None:
    """Interrupt the main thread at these events; nothing on other systems."""
    if sys.platform == "win32" and not _kept:
        handler = ctypes.WINFUNCTYPE(ctypes.c_int, ctypes.c_uint32)(handle)
        _kept.append(handler)  # the system keeps only its address
        ctypes.windll.kernel32.SetConsoleCtrlHandler(handler, 1)


def handle(
    event: int,
    interrupt: Callable[[], object] = _thread.interrupt_main,
    wait: Callable[[float], object] = time.sleep,
) -> bool:
    """Handle an event of the console.

    Args:
        event: its number.
        interrupt: interrupts the main thread.
        wait: waits at most so many seconds for the end of the process.

    Returns:
        False for an event that is left to Python: Ctrl-C.
    """
    if event != _BREAK and event not in _ENDING:
        return False
    interrupt()
    if event in _ENDING:
        wait(_MOST_S)
    return True
