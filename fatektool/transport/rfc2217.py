"""A serial port behind a gateway that speaks RFC 2217: telnet, with the port's speed and format set over it.

pyserial has the protocol. What its port does beside that, and what becomes of it here:

- It refuses a time-out for writing, which the socket below can have.
- It waits for an answer to each order about DTR, RTS and flow control. A gateway whose port has no such wires
  may never give one (ser2net over a pseudo terminal), and a PLC needs none of them. So opening sends these
  orders and goes on; whoever sets DTR later, to hang a modem up, waits and is told.
- Its reader thread dies with a traceback where the gateway is gone, and whoever waits for an answer waits all
  the time there is. Here the end of the connection ends every wait.
- What the gateway said before it closed ("Port already in use") is kept for the message.
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
    """pyserial's port, that tells when the gateway is gone.

    Args:
        url: ``rfc2217://HOST:PORT``.
        write_timeout_s: how long the gateway may take no bytes.
        settings: speed, format and time-out for reading, as pyserial names them.
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
        """Connect, agree on RFC 2217, set speed and format.

        Raises:
            SerialException, ValueError, OSError: ``lost`` and ``said`` tell more of it.
        """
        super().open()
        self._opened = True
        self._socket.settimeout(self._write_timeout_s)

    def close(self) -> None:
        """Close the connection, also one that is broken already: pyserial leaves that open."""
        connection = self._socket
        super().close()
        if connection is not None:
            connection.close()

    def read(self, size: int = 1) -> bytes:
        """Read; of a connection that is gone, first what came before."""
        rest = self._unread() if self.lost and self.is_open else b""
        return rest or super().read(size)

    def write(self, data: Any, /) -> int | None:
        """Send all of it."""
        try:
            return super().write(data)
        except serial.SerialException as error:
            if isinstance(error.__context__, TimeoutError):
                raise serial.SerialTimeoutException("Write timeout") from error
            raise

    def rfc2217_set_control(self, value: bytes) -> None:
        """Set a control wire; while the port is opened, without waiting for the answer."""
        if self._opened:
            super().rfc2217_set_control(value)
        else:
            self._rfc2217_options["control"].set(value)

    def _telnet_read_loop(self) -> None:
        with contextlib.suppress(OSError):  # the gateway went while this thread was to answer it
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
        """Take what came and was not read."""
        data = bytearray()
        with contextlib.suppress(Empty):
            while True:
                data += self._read_buffer.get_nowait() or b""
        return bytes(data)
