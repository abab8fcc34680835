"""Keys as they are pressed, and the terminal as it was when all is over.

While the keys are read, the terminal hands each on at once and shows none; Ctrl-C and Ctrl-Z stay signals.
What comes from elsewhere (a round, another size, Ctrl-Z) wakes who waits for a key.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import sys
import threading
import time
from typing import TYPE_CHECKING, Any, Final, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import TracebackType
    from typing import Self

SEQUENCES: Final = {
    "\x1b[A": "up",
    "\x1bOA": "up",
    "\x1b[B": "down",
    "\x1bOB": "down",
    "\x1b[5~": "pgup",
    "\x1b[6~": "pgdn",
    "\x1b[H": "home",
    "\x1bOH": "home",
    "\x1b[1~": "home",
    "\x1b[F": "end",
    "\x1bOF": "end",
    "\x1b[4~": "end",
    "\x1b": "esc",
    "\r": "enter",
    "\n": "enter",
    "\x7f": "backspace",
    "\x08": "backspace",
}
_WINDOWS: Final = {"H": "up", "P": "down", "I": "pgup", "Q": "pgdn", "G": "home", "O": "end"}
_SEQUENCE: Final = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]?|O.?)")
"""A sequence of ECMA-48, or of keys in application mode; it may end too early."""
_BEGUN: Final = re.compile(rb"\x1b(?:\[[0-?]*[ -/]*|O)?\Z")
_SEQUENCE_S: Final = 0.05
"""A sequence may come in pieces: so long the rest of one is waited for."""
_LOOK_S: Final = 0.05


class Keys(Protocol):
    """A source of keys, for a ``with`` statement."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def wake(self) -> None:
        """Have ``read`` return; from any thread."""

    def read(self) -> list[str]:
        """Wait for keys, or to be woken; give the names of the keys, ``""`` for the end of them."""


def keys_of(text: str) -> Iterator[str]:
    """The names of keys: ``up``, ``enter``, or the character; of unknown sequences nothing."""
    while text:
        known = max((each for each in SEQUENCES if text.startswith(each)), key=len, default="")
        unknown = _SEQUENCE.match(text) if known == "\x1b" else None
        if unknown is not None:
            text = text[unknown.end() :]
            continue
        yield SEQUENCES[known] if known else text[0]
        text = text[len(known) or 1 :]


class PosixKeys:
    """The keys of the terminal that is standard input; none if it is no terminal.

    Args:
        on_stop: is called around a stop by Ctrl-Z: it puts the terminal's screen back, and gives what brings
            it up again.
    """

    def __init__(self, on_stop: Callable[[], Callable[[], object]]) -> None:
        self._on_stop = on_stop
        self._input = sys.stdin.fileno() if sys.stdin.isatty() else None
        self._before: list[Any] = []
        self._handlers: dict[int, Any] = {}
        self._is_to_stop = False
        self._wake, self._woken = -1, -1

    def __enter__(self) -> Self:
        self._woken, self._wake = os.pipe()
        for end in (self._woken, self._wake):
            os.set_blocking(end, False)
        for number, handler in ((signal.SIGWINCH, self._resized), (signal.SIGTSTP, self._stopped)):
            if signal.getsignal(number) is not signal.SIG_IGN:
                self._handlers[number] = signal.signal(number, handler)
        self._take()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._give_back()
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        woken, wake, self._woken, self._wake = self._woken, self._wake, -1, -1
        for end in (woken, wake):
            os.close(end)

    def wake(self) -> None:
        """Have ``read`` return; from any thread."""
        with contextlib.suppress(OSError):  # it is full, or closed: it will wake, or nobody waits
            os.write(self._wake, b"\0")

    def read(self) -> list[str]:
        """Wait for keys, or to be woken."""
        from select import select

        sources = [self._woken] if self._input is None else [self._woken, self._input]
        ready: list[int] = []
        while not ready:  # a signal that comes just before a wait does not interrupt it
            ready, _, _ = select(sources, [], [], _LOOK_S)
        if self._woken in ready:
            os.read(self._woken, 4096)
        if self._is_to_stop:
            self._stop()
        if self._input is None or self._input not in ready:
            return []
        data = os.read(self._input, 1024)
        while data and is_begun(data) and select([self._input], [], [], _SEQUENCE_S)[0]:
            data += os.read(self._input, 1024)
        return [*keys_of(data.decode("utf-8", "replace"))] if data else [""]

    def _take(self) -> None:
        if self._input is None:
            return
        import termios

        self._before = termios.tcgetattr(self._input)
        raw = termios.tcgetattr(self._input)
        raw[3] &= ~(termios.ICANON | termios.ECHO)
        raw[6][termios.VMIN], raw[6][termios.VTIME] = 1, 0
        termios.tcsetattr(self._input, termios.TCSADRAIN, raw)

    def _give_back(self) -> None:
        if self._input is None or not self._before:
            return
        import termios

        with contextlib.suppress(termios.error, OSError):  # the terminal is gone
            termios.tcsetattr(self._input, termios.TCSADRAIN, self._before)

    def _resized(self, *_: object) -> None:
        self.wake()

    def _stopped(self, *_: object) -> None:
        self._is_to_stop = True
        self.wake()

    def _stop(self) -> None:
        """Stop as Ctrl-Z asks for, with the terminal as it was; go on when the shell says so."""
        self._is_to_stop = False
        bring_up = self._on_stop()
        self._give_back()
        ours = signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGTSTP)
        signal.signal(signal.SIGTSTP, ours)
        self._take()
        bring_up()


def is_begun(data: bytes) -> bool:
    """True if bytes end within a sequence or a character."""
    if _BEGUN.search(data):
        return True
    try:
        data.decode("utf-8")
    except UnicodeDecodeError as error:
        return error.end == len(data) and error.reason == "unexpected end of data"
    return False


class WindowsKeys:
    """The keys of a Windows console.

    Args:
        on_stop: is not needed: no process is stopped there.
    """

    def __init__(self, on_stop: Callable[[], Callable[[], object]]) -> None:
        del on_stop
        self._woken = threading.Event()
        self._size = os.terminal_size((0, 0))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._woken.clear()

    def wake(self) -> None:
        """Have ``read`` return; from any thread."""
        self._woken.set()

    def read(self) -> list[str]:
        """Wait for keys, or to be woken, or for another size of the window."""
        import msvcrt

        console: Any = msvcrt  # other systems know nothing of it
        while True:
            found: list[str] = []
            while sys.stdin.isatty() and console.kbhit():
                key = console.getwch()
                found += [_WINDOWS.get(console.getwch(), "")] if key in "\0\xe0" else keys_of(key)
            size = os.get_terminal_size() if sys.stdout.isatty() else self._size
            if found or self._woken.is_set() or size != self._size:
                self._woken.clear()
                self._size = size
                return [key for key in found if key]
            time.sleep(_LOOK_S)


def terminal_keys(on_stop: Callable[[], Callable[[], object]]) -> Keys:
    """The keys of this computer's terminals."""
    return WindowsKeys(on_stop) if os.name == "nt" else PosixKeys(on_stop)
