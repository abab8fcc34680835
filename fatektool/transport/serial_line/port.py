"""A serial port, by pyserial: a device, or any of pyserial's URLs.

A device on Linux or macOS is read and written through its file descriptor, with ``poll``: with pyserial, a
new time-out for each read would configure the port again each time. Other ports (Windows, URLs) keep one
short time-out, and wait longer in a loop.

pyserial sends parity, but does not check it in received bytes. So the driver is asked to check it: a byte
with wrong parity is read as 00, and its frame is invalid. The 8-bit checksum alone accepts one damaged answer
in a few hundred.

A pseudo terminal has neither parity nor 7 bits, and Linux refuses such a format from its second opening on.
So it is opened as 8N1, at the given speed: nothing is lost, because a pty passes 8 bits.
"""

from __future__ import annotations

import contextlib
import os
import sys
from typing import TYPE_CHECKING, Any, Final

from fatektool.callbacks import ignore
from fatektool.errors import TransportTimeout
from fatektool.transport.base import DRAIN_LIMIT, MOST_SAID, WRITE_TIMEOUT_S, LineSettings, Transport
from fatektool.transport.said import said_text
from fatektool.transport.serial_line.errors import gateway_closed, network_error, open_error, port_lost
from fatektool.transport.serial_line.settings import (
    PORT_ERRORS,
    check_parity,
    configure_port,
    of_pty,
    set_dtr,
)
from fatektool.transport.serial_line.url import SEARCH, device_of, host_of, opened_name
from fatektool.transport.wait import readable, writable

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.errors import TransportClosed

_SLICE_S: Final = 0.02


def open_serial(
    target: str, settings: LineSettings, *, low_latency: bool = True, note: Callable[[str], None] = ignore
) -> Transport:
    """Open a serial port for this process alone.

    Args:
        target: a device or a pyserial URL.
        settings: speed and format.
        low_latency: on Linux, ask the driver to pass on received bytes at once (a USB adapter otherwise adds
            up to 16 ms to each exchange).
        note: gets details, for ``-v``.

    Raises:
        PortBusy: another program has the port open.
        LineError: no such port, no permission, or it does not have this speed or format.
    """
    host = host_of(target)
    device = None if host else device_of(target)
    pty = device is not None and _is_pty(device)
    if target.lower().startswith(SEARCH) and device is not None:
        note(f"{target} is {device}")
        return open_serial(device, settings, low_latency=low_latency, note=note)
    if pty:
        note(f"{target} is a pseudo terminal, which has no {settings.format}: opened as 8N1")
    port = _open(opened_name(target), of_pty(settings) if pty else settings)
    if low_latency and not pty and sys.platform == "linux" and "://" not in target:
        try:
            port.set_low_latency_mode(True)
        except PORT_ERRORS as error:
            note(f"{target}: the driver has no low-latency mode: {error}")
    if hasattr(port, "fd") and os.name == "posix" and "://" not in target:  # spy:// must do the reading
        if not (pty or check_parity(port.fd, settings)):
            note(f"{target}: the driver does not check the parity of received bytes")
        return DeviceTransport(target, settings, port, pty=pty)
    return SerialTransport(target, settings, port, pty=pty, again=None if host is None else _open)


def _open(target: str, settings: LineSettings) -> Any:
    import serial

    options: dict[str, Any] = {
        "baudrate": settings.baud,
        "bytesize": settings.data_bits,
        "parity": settings.parity,
        "stopbits": settings.stop_bits,
        "timeout": _SLICE_S,
    }
    if target.lower().startswith("rfc2217://"):
        from fatektool.transport.rfc2217 import Rfc2217Port

        gateway = Rfc2217Port(target, WRITE_TIMEOUT_S, **options)
        try:
            gateway.open()
        except PORT_ERRORS as error:
            lost = gateway.lost or isinstance(error, ConnectionError)
            raise network_error(target, settings, error, lost=lost, said=gateway.said) from error
        return gateway
    try:
        return serial.serial_for_url(target, write_timeout=WRITE_TIMEOUT_S, exclusive=True, **options)
    except PORT_ERRORS as error:
        if host_of(target):
            raise network_error(target, settings, error) from error
        raise open_error(target, settings, error) from error
    except Exception as error:  # an error class of a URL handler or of termios
        if type(error).__name__ != "error" and "://" not in target:
            raise
        raise open_error(target, settings, error) from error


def _is_pty(device: str) -> bool:
    if os.name != "posix":
        return False
    with contextlib.suppress(OSError):
        real = os.path.realpath(device)
        return real.startswith(("/dev/pts/", "/dev/ttyp", "/dev/ttys0", "/dev/ttys1"))
    return False


class SerialTransport(Transport):
    """A port that is read through pyserial: on Windows, or with a URL.

    After a connection to a gateway is lost, the next ``write`` makes a new one, as over TCP.

    Args:
        name: the target, for messages.
        settings: speed and format.
        port: the open port of pyserial.
        pty: True for a pseudo terminal with a URL.
        again: opens a new connection to a gateway; None for a device.
    """

    def __init__(
        self,
        name: str,
        settings: LineSettings,
        port: Any,
        *,
        pty: bool = False,
        again: Callable[[str, LineSettings], Any] | None = None,
    ) -> None:
        self.name = name
        self.serial_settings = str(settings)
        self._settings = settings
        self._port = port
        self._pty = pty
        self._again = again
        self._closed = False
        self._first = bytearray()

    def _gone(self, error: Exception) -> TransportClosed:
        self.close()
        if self._again is not None:
            return gateway_closed(self.name, said_text(bytes(self._first)))
        return port_lost(self.name, error)

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read what is received first, at most ``max_bytes``."""
        deadline = self.clock() + timeout_s
        while not (data := self._read_slice(max_bytes)):
            if self.clock() >= deadline:
                raise TransportTimeout(f"{self.name}: nothing received within {timeout_s:.3f} s")
        return data

    def _read_slice(self, max_bytes: int) -> bytes:
        try:
            data = bytes(self._port.read(min(max_bytes, max(1, self._port.in_waiting))))
        except (OSError, ValueError, TypeError, AttributeError) as error:  # of pyserial, after it is closed
            raise self._gone(error) from error
        if len(self._first) <= MOST_SAID:
            self._first += data
        return data

    def write(self, data: bytes) -> None:
        """Write all of ``data``; after a connection to a gateway is lost, connect first."""
        if self._closed and self._again is not None:
            self._port = self._again(self.name, self._settings)
            self._closed = False
            self._first.clear()
        try:
            written = self._port.write(data)
        except (OSError, ValueError, TypeError, AttributeError) as error:
            if type(error).__name__ == "SerialTimeoutException":
                self.renew()
                raise TransportTimeout(f"{self.name}: the write blocked for {WRITE_TIMEOUT_S:g} s") from error
            raise self._gone(error) from error
        if isinstance(written, int) and written < len(data):  # Windows aborts it when the adapter is removed
            raise self._gone(OSError(f"only {written} of {len(data)} bytes were written"))

    def drain(self) -> bytes:
        """Return what was received already."""
        taken = bytearray()
        with contextlib.suppress(OSError, ValueError, TypeError, AttributeError):
            while len(taken) < DRAIN_LIMIT and (waiting := self._port.in_waiting):
                taken += self._port.read(min(waiting, 4096))
        return bytes(taken)

    def configure(self, settings: LineSettings) -> None:
        """Set speed and format."""
        if not (self._closed and self._again):  # else it is set with the next connection
            configure_port(self.name, of_pty(settings) if self._pty else settings, self._port)
        self._settings = settings
        self.serial_settings = str(settings)

    def renew(self) -> None:
        """Close the connection to a gateway; the next ``write`` makes a new one."""
        if self._again is not None:
            self.close()

    def set_dtr(self, *, on: bool) -> bool:
        """Switch DTR; returns False if the port has none."""
        return set_dtr(self._port, on=on)

    def close(self) -> None:
        """Close the port."""
        if self._closed:
            return
        self._closed = True
        connection = getattr(self._port, "_socket", None)  # of a URL; pyserial leaves a lost one open
        with contextlib.suppress(OSError, ValueError):
            self._port.close()
        if connection is not None:
            connection.close()


class DeviceTransport(Transport):
    """A device on a POSIX system, through its file descriptor."""

    def __init__(self, name: str, settings: LineSettings, port: Any, *, pty: bool = False) -> None:
        self.name = name
        self.serial_settings = str(settings)
        self._port = port
        self._pty = pty
        self._descriptor: int = port.fd
        self._readable: Callable[[float], bool] = readable(self._descriptor)
        self._writable: Callable[[float], bool] = writable(self._descriptor)

    def _gone(self, reason: object) -> TransportClosed:
        self.close()
        return port_lost(self.name, reason)

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read what is received first, at most ``max_bytes``."""
        if self._descriptor < 0:
            raise self._gone("closed")
        if not self._readable(timeout_s):
            raise TransportTimeout(f"{self.name}: nothing received within {timeout_s:.3f} s")
        try:
            data = os.read(self._descriptor, max_bytes)
        except BlockingIOError:
            raise TransportTimeout(f"{self.name}: nothing received") from None
        except OSError as error:
            raise self._gone(error.strerror) from error
        if not data:
            raise self._gone("end of file")
        return data

    def write(self, data: bytes) -> None:
        """Write all of ``data``."""
        if self._descriptor < 0:
            raise self._gone("closed")
        rest = data
        while rest:
            try:
                rest = rest[os.write(self._descriptor, rest) :]
            except BlockingIOError:
                if not self._writable(WRITE_TIMEOUT_S):
                    raise TransportTimeout(
                        f"{self.name}: the write blocked for {WRITE_TIMEOUT_S:g} s"
                    ) from None
            except OSError as error:
                raise self._gone(error.strerror) from error

    def drain(self) -> bytes:
        """Return what was received already."""
        if self._descriptor < 0 or not self._readable(0.0):  # there is nothing, as good as always
            return b""
        taken = bytearray()
        with contextlib.suppress(OSError):
            while len(taken) < DRAIN_LIMIT and (data := os.read(self._descriptor, 4096)):
                taken += data
        return bytes(taken)

    def configure(self, settings: LineSettings) -> None:
        """Set speed and format; of a pty, only the speed."""
        configure_port(self.name, of_pty(settings) if self._pty else settings, self._port)
        if not self._pty:  # pyserial has just switched it off
            check_parity(self._descriptor, settings)
        self.serial_settings = str(settings)

    def set_dtr(self, *, on: bool) -> bool:
        """Switch DTR; returns False if the port has none."""
        return set_dtr(self._port, on=on)

    def close(self) -> None:
        """Close the port."""
        self._descriptor = -1
        with contextlib.suppress(OSError):
            self._port.close()
