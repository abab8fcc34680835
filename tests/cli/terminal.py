"""A command on a real terminal: a pty that is its controlling terminal, so that ^C is a signal."""

from __future__ import annotations

import contextlib
import os
import re
import struct
from typing import TYPE_CHECKING

import pytest

from tests.cli.running import environment
from tests.forks.command import Forked

if os.name != "posix":
    pytest.skip("POSIX alone: pseudo terminals", allow_module_level=True)

import fcntl
import termios

if TYPE_CHECKING:
    from types import TracebackType
    from typing import Self

_ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


class Terminal:
    """Runs a command with stdin, stdout and stderr on a pty; ``stdout`` may go elsewhere."""

    def __init__(
        self, *words: object, columns: int = 80, lines: int = 24, stdout: int | None = None, **more: str
    ) -> None:
        self.master, slave = os.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))
        self.process = Forked(
            words,
            stdin=slave,
            stdout=slave if stdout is None else stdout,
            stderr=slave,
            environment=environment(**more),
            terminal=True,
        )
        os.close(slave)
        self.raw = ""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        os.close(self.master)

    @property
    def text(self) -> str:
        """What is on it, without escapes."""
        return _ESCAPE.sub("", self.raw).replace("\r\n", "\n")

    def read_until(self, words: str) -> None:
        while words not in self.text:
            self.raw += os.read(self.master, 65536).decode(errors="replace")

    def read_until_like(self, pattern: str) -> None:
        """Read until a regular expression is on it."""
        while not re.search(pattern, self.text):
            self.raw += os.read(self.master, 65536).decode(errors="replace")

    def type(self, keys: str) -> None:
        os.write(self.master, keys.encode())

    def end(self) -> int:
        """Read to the end; give the exit code."""
        with contextlib.suppress(OSError):  # EIO: the other side is closed
            while data := os.read(self.master, 65536):
                self.raw += data.decode(errors="replace")
        return self.process.wait()
