"""What ends a command cleanly, as Ctrl-C does.

::

    SIGTERM            kill, systemd, a shutdown
    SIGHUP             a closed terminal or SSH session; not under nohup, which has it ignored
    Ctrl-Break         on Windows
    console closed     the window is closed, or the user logs off, on Windows
"""

from __future__ import annotations

import signal
import sys
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from types import FrameType

_SIGNALS: Final = ("SIGTERM", "SIGHUP")


def end_cleanly() -> None:
    """Have each of these raise KeyboardInterrupt in the main thread."""
    for name in _SIGNALS:
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _interrupt)
    if sys.platform == "win32":
        from fatektool.system.console import end_with_console

        end_with_console()


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt
