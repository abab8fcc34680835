r"""A modem in its command state: commands to it, results from it (ITU-T V.250).

::

    AT…\r  ->      \r\nBUSY\r\n      a result as text (V1)
                   7\r               a result as a number (V0)
                   AT…\r             the command itself, while echo is on (E1)
    during a call:  +++ between silences  ->  command state, the call stays up

Numbers above 8, except 10, differ between makers, so they are not used: the modem is set to text.
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
    """The result that ends a command."""

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
    """The result in a line; None for another line, such as an echo, RING, or CARRIER 9600.

    Args:
        line: without its line end.
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
    """Sends commands to a modem, and receives results.

    Args:
        port: the serial port of the modem.
        guard_s: silence before and after ``+++``, in seconds.
        note: gets each command and result, for ``-v``.

    Attributes:
        heard: the first bytes received since the last command.
    """

    def __init__(self, port: Transport, guard_s: float, note: Callable[[str], None]) -> None:
        self.heard = b""
        self._port = port
        self._guard_s = guard_s * _MORE_THAN_GUARD
        self._note = note

    def ask(self, command: str, wait_s: float) -> Result | None:
        """Send a command and wait so many seconds for its result; None if there is none.

        Raises:
            TransportError: the port is lost.
        """
        self._port.drain()
        self._note(f"to the modem: {command}")
        self._port.write(f"{command}\r".encode())
        return self.result(wait_s)

    def result(self, wait_s: float) -> Result | None:
        """Wait so many seconds for a result; bytes after it are dropped.

        Raises:
            TransportClosed: the port is lost.
        """
        self.heard = b""
        line = b""
        deadline = self._port.clock() + wait_s
        while (rest := deadline - self._port.clock()) > 0:
            try:
                data = self._port.read(_READ_BYTES, rest)
            except TransportTimeout:
                continue
            data = bytes(byte & 0x7F for byte in data)  # the eighth bit may be parity
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
        """Wait so many seconds; received bytes are dropped.

        Raises:
            TransportClosed: the port is lost.
        """
        deadline = self._port.clock() + seconds
        while (left := deadline - self._port.clock()) > 0:
            try:
                self._port.read(_READ_BYTES, left)
            except TransportTimeout:
                continue

    def escape(self, wait_s: float) -> Result | None:
        """Go from a call to the command state, with ``+++`` between silences; the call stays up.

        Args:
            wait_s: seconds to wait for the result, in addition to the silence.

        Raises:
            TransportError: the port is lost.
        """
        self.rest(self._guard_s)
        self._note("to the modem: +++")
        self._port.write(b"+++")
        return self.result(self._guard_s + wait_s)
