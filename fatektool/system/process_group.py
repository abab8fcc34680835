"""A program that is ended with all that it started: a process group, on Windows a job object."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Sequence

_OWN_GROUP: Final = getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0) | getattr(
    subprocess, "CREATE_NO_WINDOW", 0
)
_LOOK_S: Final = 0.2
"""A wait of Windows for the end of a process is not ended by Ctrl-C."""


class ProcessGroup:
    """A program without a terminal of its own, so that Ctrl-C in this one does not reach it.

    Args:
        command: the program and its arguments; on Windows also a whole command line.
        options: for ``subprocess.Popen``.

    Raises:
        OSError: it cannot be started.
        ValueError: a word of the command is not possible on this system.
    """

    def __init__(self, command: str | Sequence[str], **options: Any) -> None:
        self.process: subprocess.Popen[bytes] = subprocess.Popen(  # noqa: S603  # by the caller
            command, stdin=subprocess.DEVNULL, start_new_session=True, creationflags=_OWN_GROUP, **options
        )
        self._job: Any = None
        if sys.platform == "win32":
            from fatektool.system.windows_processes import Job

            handle = int(self.process._handle)  # type: ignore[attr-defined]  # noqa: SLF001  # its only place
            self._job = Job.of(handle)

    def wait(self, time_limit_s: float) -> int:
        """Wait for the end of the program; Ctrl-C ends the wait, also on Windows.

        Returns:
            its exit code.

        Raises:
            TimeoutExpired: it did not end in time.
        """
        until = time.perf_counter() + time_limit_s
        while True:
            rest_s = max(0.0, until - time.perf_counter())
            try:
                return self.process.wait(min(_LOOK_S, rest_s))
            except subprocess.TimeoutExpired:
                if rest_s <= _LOOK_S:
                    raise

    def terminate(self) -> None:
        """Ask the program and its children to end; on Windows end them."""
        self._signal(signal.SIGTERM)

    def kill(self) -> None:
        """End the program and its children, and wait for the program."""
        self._signal(getattr(signal, "SIGKILL", signal.SIGTERM))
        self.process.wait()

    def close(self) -> None:
        """Release what the system keeps for the group; what the program left in the background goes on."""
        if self._job is not None:
            self._job.close()

    def _signal(self, number: signal.Signals) -> None:
        if self._job is not None:
            self._job.end()
        elif sys.platform == "win32":
            self.process.terminate()
        else:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.process.pid, number)
