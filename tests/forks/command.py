"""Commands as processes that need not start Python: children of a process that has loaded the program.

To start Python and to load the program takes a quarter of a second, to fork some milliseconds. A child has
standard streams, a folder, an environment, signals, an end and a terminal of its own, as any process has. It
shares the interpreter's start: what is tested of that, such as the encoding by the locale, needs
``subprocess``. So does everything where there is no fork.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
import threading
from functools import cache
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from tests.root import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from types import TracebackType
    from typing import Self

COMMAND = [sys.executable, "-m", "fatektool"]
PIPE = subprocess.PIPE
CAN_FORK = hasattr(os, "fork") and hasattr(socket, "send_fds")


@cache
def server() -> str:
    """Start the process that makes the children; where it listens. It ends with this one."""
    folder = tempfile.TemporaryDirectory(prefix="fatektool-forks-")
    path = Path(folder.name) / "s"
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.forks.server", str(path)],
        cwd=ROOT,
        stdin=PIPE,
        start_new_session=True,  # what ends a terminal's processes does not end it
    )
    while not path.exists():
        if process.poll() is not None:
            raise RuntimeError(f"the server of forks ended with {process.returncode}")
        threading.Event().wait(0.005)  # it says nothing when it listens

    def end() -> None:
        process.communicate()
        folder.cleanup()

    atexit.register(end)
    return str(path)


class Forked:
    """A command that runs, as ``subprocess.Popen`` has it.

    Args:
        words: the command line behind ``fatektool``.
        stdin, stdout, stderr: a descriptor or file; ``PIPE``; None for this process's own.
        environment: all of it.
        folder: where it runs; None for the present one.
        closed: which of the three standard descriptors it has not.
        terminal: True if standard error is to be its controlling terminal.
        text: False if its pipes take and give bytes.
        limits: the most of what the system gives it, by the name in ``resource``.
    """

    def __init__(
        self,
        words: Iterable[object],
        *,
        stdin: int | IO[bytes] | None = None,
        stdout: int | IO[bytes] | None = None,
        stderr: int | IO[bytes] | None = None,
        environment: dict[str, str] | None = None,
        folder: Path | None = None,
        closed: Sequence[int] = (),
        terminal: bool = False,
        text: bool = True,
        limits: dict[str, int] | None = None,
    ) -> None:
        self.args = [str(word) for word in words]
        self.returncode: int | None = None
        self.stdin: IO[Any] | None = None
        self.stdout: IO[Any] | None = None
        self.stderr: IO[Any] | None = None
        given: list[int] = []
        ours: list[int] = []
        for number, (name, stream) in enumerate((("stdin", stdin), ("stdout", stdout), ("stderr", stderr))):
            if stream == PIPE:
                ends = os.pipe()
                kept, its = (ends[1], ends[0]) if name == "stdin" else ends
                mode = "w" if name == "stdin" else "r"
                opened = os.fdopen(kept, mode, encoding="utf-8") if text else os.fdopen(kept, f"{mode}b")
                setattr(self, name, opened)
                ours.append(its)
                given.append(its)
            elif stream == subprocess.DEVNULL:
                given.append(os.open(os.devnull, os.O_RDWR))
                ours.append(given[-1])
            elif stream is None:
                given.append(number)
            else:
                given.append(stream if isinstance(stream, int) else stream.fileno())
        numbers = [number for number in range(3) if number not in closed]
        order = (
            self.args,
            str(folder or Path.cwd()),
            {os.fsencode(key): os.fsencode(value) for key, value in (environment or os.environ).items()},
            numbers,
            terminal,
            limits or {},
        )
        from tests.forks import client  # which POSIX has

        client.SOCKET = server()
        self._line, self.pid = client.ask(order, [given[number] for number in numbers])
        for descriptor in ours:
            os.close(descriptor)

    def poll(self) -> int | None:
        """Its exit code; None if it runs."""
        if self.returncode is None and select.select([self._line], [], [], 0)[0]:
            return self.wait()
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait for its end; its exit code."""
        if self.returncode is None:
            if not select.select([self._line], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired(self.args, timeout or 0.0)
            from tests.forks import client

            self.returncode = client.told(self._line)
            self._line.close()
        return self.returncode

    def send_signal(self, number: int) -> None:
        if self.poll() is None:
            os.kill(self.pid, number)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)

    def terminate(self) -> None:
        self.send_signal(signal.SIGTERM)

    def communicate(self, given: Any = None, timeout: float | None = None) -> tuple[Any, Any]:
        """Give it its input, and read its output to the end."""
        if self.stdin is not None:
            with contextlib.suppress(BrokenPipeError):  # it reads no more
                if given:
                    self.stdin.write(given)
                self.stdin.close()
        texts: dict[str, Any] = {"stdout": None, "stderr": None}

        def read(name: str) -> None:
            stream = getattr(self, name)
            if stream is not None and not stream.closed:
                texts[name] = stream.read()
                stream.close()

        reader = threading.Thread(target=read, args=("stderr",))
        reader.start()
        read("stdout")
        reader.join()
        self.wait(timeout)
        return texts["stdout"], texts["stderr"]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for stream in (self.stdout, self.stderr, self.stdin):
            if stream is not None:
                stream.close()
        self.wait()


Process = Forked | subprocess.Popen[str]
"""A command that runs, forked where that can be done."""
