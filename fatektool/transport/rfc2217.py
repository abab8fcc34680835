"""A serial port behind an RFC 2217 gateway: telnet, with speed and format of the port set through it.

pyserial implements the protocol. The differences of its port, and what this class changes:

- It has no write time-out. This class sets one on the socket.
- It waits for an answer to each command for DTR, RTS and flow control. A gateway whose port has no such lines
  may never answer (ser2net with a pseudo terminal), and a PLC needs none of them. So opening sends these
  commands without waiting; setting DTR later, to hang up a modem, waits for the answer.
- Its reader thread ends with a traceback if the connection is lost, and a read then waits for its whole
  time-out. Here the end of the connection ends every wait.
- Text that the gateway sends before it closes ("Port already in use") is kept for the message.
"""

from __future__ import annotations

import contextlib
from queue import Empty
from typing import Any, Final

import serial
from serial.rfc2217 import INACTIVE, REALLY_INACTIVE, Serial

from fatektool.transport.said import said_text

_LEAST_RECEIVE_S: Final = 0.05


class Rfc2217Port(Serial):
    """pyserial's port, which also detects a lost connection.

    Args:
        url: ``rfc2217://HOST:PORT``.
        write_timeout_s: how long a write may block, in seconds.
        settings: speed, format and read time-out, by pyserial's names.
    """

    _socket: Any
    _read_buffer: Any
    _telnet_options: Any
    _rfc2217_options: Any

    def __init__(self, url: str, write_timeout_s: float, **settings: Any) -> None:
        self._write_timeout_s = max(write_timeout_s, _LEAST_RECEIVE_S)
        self._opened = False
        self.lost = False
        self.said = ""
        super().__init__(None, **settings)
        self.port = url

    def open(self) -> None:
        """Connect, negotiate RFC 2217, set speed and format.

        Raises:
            SerialException, ValueError, OSError: see also ``lost`` and ``said``.
        """
        super().open()
        self._opened = True
        self._socket.settimeout(self._write_timeout_s)

    def close(self) -> None:
        """Close the connection, also a broken one, which pyserial leaves open."""
        connection = self._socket
        super().close()
        if connection is not None:
            connection.close()

    def read(self, size: int = 1) -> bytes:
        """Read; after the end of the connection, first what was received before."""
        rest = self._unread() if self.lost and self.is_open else b""
        return rest or super().read(size)

    def write(self, data: Any, /) -> int | None:
        """Send all of ``data``."""
        try:
            return super().write(data)
        except serial.SerialException as error:
            if isinstance(error.__context__, TimeoutError):
                raise serial.SerialTimeoutException("Write timeout") from error
            raise

    def rfc2217_set_control(self, value: bytes) -> None:
        """Set a control line; while the port is being opened, without waiting for the answer."""
        if self._opened:
            super().rfc2217_set_control(value)
        else:
            self._rfc2217_options["control"].set(value)

    def _telnet_read_loop(self) -> None:
        with contextlib.suppress(OSError):  # the connection ended while this thread answered
            super()._telnet_read_loop()  # type: ignore[misc]
        if not self._opened:
            self.said = said_text(self._unread())
        if not self.is_open:  # closed from here
            return
        self.lost = True
        for option in self._telnet_options:
            option.state, option.active = INACTIVE, False
        for order in self._rfc2217_options.values():
            order.state = REALLY_INACTIVE

    def _unread(self) -> bytes:
        """Return what was received and not read."""
        data = bytearray()
        with contextlib.suppress(Empty):
            while True:
                data += self._read_buffer.get_nowait() or b""
        return bytes(data)
