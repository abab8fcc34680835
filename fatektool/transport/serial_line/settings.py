"""Speed, format, parity check and wires of a serial port that pyserial has open."""

from __future__ import annotations

from typing import Any, Final

from fatektool.transport.base import LineSettings
from fatektool.transport.serial_line.errors import open_error

PTY_FORMAT: Final = "8N1"
PORT_ERRORS: Final = (OSError, ValueError, NotImplementedError)
"""What pyserial raises: SerialException is an OSError, and the last is its word for what a system lacks."""


def of_pty(line: LineSettings) -> LineSettings:
    """What a pseudo terminal takes: the speed alone."""
    return LineSettings(line.baud, PTY_FORMAT)


def set_line(target: str, line: LineSettings, port: Any) -> None:
    """Another speed and format for an open port.

    Raises:
        LineError: it does not take these.
    """
    try:
        port.apply_settings(
            {
                "baudrate": line.baud,
                "bytesize": line.data_bits,
                "parity": line.parity,
                "stopbits": line.stop_bits,
            }
        )
    except PORT_ERRORS as error:
        raise open_error(target, line, error) from error
    except Exception as error:  # as when opening
        if type(error).__name__ != "error" and "://" not in target:
            raise
        raise open_error(target, line, error) from error


def check_parity(descriptor: int, line: LineSettings) -> bool:
    """Have the driver check the parity of what it receives, or leave that if the line has none.

    Args:
        descriptor: of an open port.
        line: its speed and format.

    Returns:
        False if the driver cannot.
    """
    import termios

    try:
        settings = termios.tcgetattr(descriptor)
        settings[0] &= ~(termios.INPCK | termios.IGNPAR | termios.PARMRK)
        if line.parity != "N":
            settings[0] |= termios.INPCK
        termios.tcsetattr(descriptor, termios.TCSANOW, settings)
    except termios.error:
        return False
    return True


def set_dtr(port: Any, *, on: bool) -> bool:
    """Switch DTR; False if the port says that it has none."""
    try:
        port.dtr = on
    except (OSError, ValueError, TypeError, AttributeError):  # a pty has none; a closed port has none either
        return False
    return True
