r"""A modem in its command state: a line to it, a result from it (ITU-T V.250).

::

    AT…\r  ->      \r\nBUSY\r\n      in words (V1)
                   7\r               in figures (V0)
                   AT…\r             the command itself, while echo is on (E1)
    during a call:  +++ within silence  ->  command state again, the call still up

Figures above 8 differ from maker to maker, but for 10, so they are no result: the modem is asked for words.
"""

from __future__ import annotations

import re
from enum import Enum
from typing import TYPE_CHECKING, Final

from fatektool.errors import TransportTimeout

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.transport.base import Transport

_READ_BYTES: Final = 256
_LONGEST_LINE: Final = 200
_SAMPLE_BYTES: Final = 32
_MORE_THAN_GUARD: Final = 1.1
_END: Final = re.compile(rb"[\r\n]")


class Result(Enum):
    """What ends a command."""

    OK = "OK"
    CONNECT = "CONNECT"
    NO_CARRIER = "NO CARRIER"
    ERROR = "ERROR"
    NO_DIALTONE = "NO DIALTONE"
    BUSY = "BUSY"
    NO_ANSWER = "NO ANSWER"
    VOICE = "VOICE"
    BARRED = "BLACKLISTED"


_FIGURES: Final = {
    "0": Result.OK,
    "1": Result.CONNECT,
    "3": Result.NO_CARRIER,
    "4": Result.ERROR,
    "5": Result.CONNECT,
    "6": Result.NO_DIALTONE,
    "7": Result.BUSY,
    "8": Result.NO_ANSWER,
    "10": Result.CONNECT,
}
_BEGINNINGS: Final = {
    "CONNECT": Result.CONNECT,
    "+CME ERROR": Result.ERROR,
    "NO DIAL TONE": Result.NO_DIALTONE,
    "DELAYED": Result.BARRED,
    "BLACKLISTED": Result.BARRED,
}


def result_of(line: str) -> Result | None:
    """What a line means; None for one that ends nothing: an echo, RING, CARRIER 9600.

    Args:
        line: without its end.
    """
    text = line.strip().upper()
    if text in _FIGURES:
        return _FIGURES[text]
    for beginning, result in _BEGINNINGS.items():
        if text.startswith(beginning):
            return result
    try:
        return Result(text)
    except ValueError:
        return None


class ModemCommands:
    """Talks to a modem.

    Args:
        port: the modem's serial port.
        guard_s: silence that the modem wants around ``+++``.
        note: is told the dialogue.

    Attributes:
        heard: the first bytes that came since the last command.
    """

    def __init__(self, port: Transport, guard_s: float, note: Callable[[str], None]) -> None:
        self.heard = b""
        self._port = port
        self._guard_s = guard_s * _MORE_THAN_GUARD
        self._note = note

    def ask(self, command: str, wait_s: float) -> Result | None:
        """Give a command, and wait so many seconds for its result; None if none came.

        Raises:
            TransportError: the port is gone.
        """
        self._port.drain()
        self._note(f"to the modem: {command}")
        self._port.write(f"{command}\r".encode())
        return self.result(wait_s)

    def result(self, wait_s: float) -> Result | None:
        """Wait so many seconds for a result; what stands behind it in the input is dropped.

        Raises:
            TransportClosed: the port is gone.
        """
        self.heard = b""
        line = b""
        deadline = self._port.clock() + wait_s
        while (rest := deadline - self._port.clock()) > 0:
            try:
                data = self._port.read(_READ_BYTES, rest)
            except TransportTimeout:
                continue
            data = bytes(byte & 0x7F for byte in data)  # the eighth may be the modem's parity
            self.heard = (self.heard + data)[:_SAMPLE_BYTES]
            *lines, line = _END.split(line + data)
            line = line[-_LONGEST_LINE:]
            for each in lines:
                text = each.decode("ascii")
                if text.strip():
                    self._note(f"from the modem: {text.strip()!r}")
                result = result_of(text)
                if result is not None:
                    return result
        return None

    def rest(self, seconds: float) -> None:
        """Let time pass; what comes is dropped.

        Raises:
            TransportClosed: the port is gone.
        """
        deadline = self._port.clock() + seconds
        while (left := deadline - self._port.clock()) > 0:
            try:
                self._port.read(_READ_BYTES, left)
            except TransportTimeout:
                continue

    def escape(self, wait_s: float) -> Result | None:
        """From a call to the command state, by ``+++`` within silence; the call stays up.

        Args:
            wait_s: for the result, beside the silence.

        Raises:
            TransportError: the port is gone.
        """
        self.rest(self._guard_s)
        self._note("to the modem: +++")
        self._port.write(b"+++")
        return self.result(self._guard_s + wait_s)
