"""Speed, format, parity check and DTR of a serial port that pyserial has opened."""

from __future__ import annotations

from typing import Any, Final

from fatektool.transport.base import LineSettings
from fatektool.transport.serial_line.errors import open_error

PTY_FORMAT: Final = "8N1"
PORT_ERRORS: Final = (OSError, ValueError, NotImplementedError)
"""The errors of pyserial: SerialException is an OSError; the last is for what a system does not have."""


def of_pty(settings: LineSettings) -> LineSettings:
    """The settings of a pseudo terminal: only the speed is used."""
    return LineSettings(settings.baud, PTY_FORMAT)


def configure_port(target: str, settings: LineSettings, port: Any) -> None:
    """Set speed and format of an open port.

    Raises:
        LineError: it does not have these.
    """
    try:
        port.apply_settings(
            {
                "baudrate": settings.baud,
                "bytesize": settings.data_bits,
                "parity": settings.parity,
                "stopbits": settings.stop_bits,
            }
        )
    except PORT_ERRORS as error:
        raise open_error(target, settings, error) from error
    except Exception as error:  # as when opening
        if type(error).__name__ != "error" and "://" not in target:
            raise
        raise open_error(target, settings, error) from error


def check_parity(descriptor: int, settings: LineSettings) -> bool:
    """Have the driver check the parity of received bytes; no check if the format has no parity.

    Args:
        descriptor: of an open port.
        settings: its speed and format.

    Returns:
        False if the driver cannot.
    """
    import termios

    try:
        attributes = termios.tcgetattr(descriptor)
        attributes[0] &= ~(termios.INPCK | termios.IGNPAR | termios.PARMRK)
        if settings.parity != "N":
            attributes[0] |= termios.INPCK
        termios.tcsetattr(descriptor, termios.TCSANOW, attributes)
    except termios.error:
        return False
    return True


def set_dtr(port: Any, *, on: bool) -> bool:
    """Switch DTR; returns False if the port has none."""
    try:
        port.dtr = on
    except (OSError, ValueError, TypeError, AttributeError):  # a pty or a closed port has none
        return False
    return True
