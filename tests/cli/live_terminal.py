"""A command on a real terminal, whose screen is what an emulator makes of all that comes."""

from __future__ import annotations

import os
import signal
import struct
from typing import TYPE_CHECKING

import pyte
import pytest

from tests.cli.terminal import Terminal

if os.name != "posix":
    pytest.skip("POSIX alone: pseudo terminals", allow_module_level=True)

import fcntl
import termios

if TYPE_CHECKING:
    from collections.abc import Callable


class LiveTerminal(Terminal):
    """A terminal with a screen."""

    def __init__(self, *words: object, columns: int = 80, lines: int = 24, **more: str) -> None:
        self.screen = pyte.Screen(columns, lines)
        self._stream = pyte.ByteStream(self.screen)
        more = {"PYTHONUTF8": "1"} | more
        super().__init__(*words, columns=columns, lines=lines, stdout=None, **more)

    @property
    def lines(self) -> list[str]:
        """What is on the screen."""
        return [line.rstrip() for line in self.screen.display]

    def until(self, holds: str | Callable[[list[str]], bool]) -> list[str]:
        """Read until a text is on a screen drawn to its end, or something holds of it; give the screen."""
        while not (self._is_whole and self._has(holds)):
            data = os.read(self.master, 65536)
            self.raw += data.decode(errors="replace")
            self._stream.feed(data)
        return self.lines

    @property
    def _is_whole(self) -> bool:
        """True if nothing is below the cursor: there each drawing of the screen ends."""
        return not any(self.lines[self.screen.cursor.y + 1 :])

    def _has(self, holds: str | Callable[[list[str]], bool]) -> bool:
        return holds in "\n".join(self.lines) if isinstance(holds, str) else holds(self.lines)

    def resize(self, columns: int, lines: int) -> None:
        """Make the window another size."""
        self.screen.resize(lines, columns)
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))
        os.kill(self.process.pid, signal.SIGWINCH)

    @property
    def shows_keys(self) -> bool:
        """True if the terminal shows what is typed, and hands it on line by line: as it was."""
        flags = termios.tcgetattr(self.master)[3]
        return bool(flags & termios.ECHO and flags & termios.ICANON)
