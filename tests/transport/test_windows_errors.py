"""A serial port of Windows that cannot be opened or is lost, by what pyserial raises there."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import pytest
import serial

from fatektool.errors import LineError, PortBusy, TransportClosed
from fatektool.transport.base import LineSettings
from fatektool.transport.open import open_transport
from fatektool.transport.serial_line.port import SerialTransport
from fatektool.transport.serial_line.windows import ERRORS
from fatektool.transport.target import Target
from tests.rows import each

if TYPE_CHECKING:
    from collections.abc import Callable

LINE = LineSettings(9600, "7E1")

OPENED = "could not open port 'COM3': {}"
SET_UP = "Cannot configure port, something went wrong. Original message: {}"
BUSY, MISSING, SETTINGS, BROKEN, UNPLUGGED = (
    "another program has the port open",
    "no such port",
    "--baud and --line",
    "driver",
    "plug it in again",
)
WHEN_OPENED = [
    (OPENED, "PermissionError(13, 'Access is denied.', None, 5)", BUSY),
    (OPENED, "PermissionError(13, 'Zugriff verweigert', None, 5)", BUSY),
    (OPENED, "PermissionError(13, 'The process cannot access the file …', None, 32)", BUSY),
    (OPENED, "PermissionError(13, 'Die angeforderte Ressource wird bereits verwendet.', None, 170)", BUSY),
    (OPENED, "FileNotFoundError(2, 'The system cannot find the file specified.', None, 2)", MISSING),
    (OPENED, "FileNotFoundError(2, 'Das System kann den angegebenen Pfad nicht finden.', None, 3)", MISSING),
    (OPENED, "OSError(22, 'The filename, directory name, or volume label is incorrect', None, 123)", MISSING),
    (OPENED, "OSError(22, 'A device attached to the system is not functioning.', None, 31)", BROKEN),
    (SET_UP, "OSError(22, 'A device attached to the system is not functioning.', None, 31)", BROKEN),
    (SET_UP, "OSError(22, 'The parameter is incorrect.', None, 87)", SETTINGS),
    (SET_UP, "OSError(22, 'Falscher Parameter.', None, 87)", SETTINGS),
    (OPENED, "OSError(22, 'Incorrect function.', None, 1)", "not a serial port"),
    (SET_UP, "PermissionError(13, 'The device does not recognize the command.', None, 22)", UNPLUGGED),
    (OPENED, "OSError(22, 'The semaphore timeout period has expired.', None, 121)", UNPLUGGED),
    (OPENED, "OSError(22, 'A device which does not exist was specified.', None, 433)", UNPLUGGED),
    (OPENED, "OSError(22, 'The device isn\\'t connected: \"COM3\"', None, 1167)", UNPLUGGED),
]
WHILE_USED = [
    ("ClearCommError failed ({})", "PermissionError(13, 'Access is denied.', None, 5)"),
    ("ClearCommError failed ({})", "PermissionError(13, 'Das Gerät erkennt den Befehl nicht.', None, 22)"),
    ("ReadFile failed ({})", "OSError(22, 'A device attached to the system is not functioning.', None, 31)"),
    ("WriteFile failed ({})", "OSError(22, 'A device which does not exist was specified.', None, 433)"),
    ("GetOverlappedResult failed ({})", "OSError(22, 'The device is not connected.', None, 1167)"),
]


def refusal(monkeypatch: pytest.MonkeyPatch, error: Exception) -> LineError:
    def open_port(*_: object, **__: object) -> Any:
        raise error

    monkeypatch.setattr(serial, "serial_for_url", open_port)
    with ExitStack() as stack, pytest.raises(LineError) as caught:
        open_transport(Target.parse("COM3"), LINE, stack, lock_wait_s=0)
    return caught.value


@each(("frame", "cause", "words"), WHEN_OPENED)
def test_a_port_that_windows_does_not_open(frame: str, cause: str, words: str) -> None:
    with pytest.MonkeyPatch.context() as monkeypatch:
        error = refusal(monkeypatch, serial.SerialException(frame.format(cause)))
    assert words in f"{error.message}; {error.hint}"
    assert isinstance(error, PortBusy) == (words == BUSY)
    assert "dialout" not in str(error)
    assert "Error(" not in str(error)
    assert error.exit_code == 3


def test_a_speed_that_windows_refuses_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    cause = SET_UP.format("OSError(22, 'The parameter is incorrect.', None, 87)")
    assert str(refusal(monkeypatch, serial.SerialException(cause))) == (
        "COM3: cannot be used as a serial port at 9600 7E1: the driver does not accept this baud rate or "
        "format (Windows error 87); check the name; check that the adapter supports this --baud and --line"
    )


def test_the_number_of_an_error_of_the_system(monkeypatch: pytest.MonkeyPatch) -> None:
    error = PermissionError(13, "Access is denied.")
    error.winerror = 5  # type: ignore[attr-defined, unused-ignore]  # as Windows sets it
    assert isinstance(refusal(monkeypatch, error), PortBusy)


def test_a_number_that_is_not_in_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    error = refusal(monkeypatch, serial.SerialException(OPENED.format("OSError(22, 'Neu', None, 4711)")))
    assert "4711" in error.message


class Port:
    """What pyserial's port of Windows does when the adapter is pulled out."""

    def __init__(self, error: Exception) -> None:
        self._error = error
        self.closed = False

    @property
    def in_waiting(self) -> int:
        raise self._error

    def read(self, _size: int) -> bytes:
        raise self._error

    def write(self, _data: bytes) -> int:
        raise self._error

    def close(self) -> None:
        self.closed = True


@each(("frame", "cause"), WHILE_USED)
def test_a_port_that_is_lost(frame: str, cause: str) -> None:
    number = int(cause.rstrip(")").rpartition(", ")[2])
    uses: list[Callable[[SerialTransport], object]] = [
        lambda port: port.read(1, 0.1),
        lambda port: port.write(b"\2"),
    ]
    for use in uses:
        port = Port(serial.SerialException(frame.format(cause)))
        with pytest.raises(TransportClosed) as caught:
            use(SerialTransport("COM3", LINE, port))
        assert caught.value.message.startswith("COM3: the port is lost: ")
        assert caught.value.message.endswith(f"{ERRORS[number].text} (Windows error {number})")
        assert caught.value.hint == "check that the adapter is plugged in, and run again"
        assert port.closed


def test_the_table_has_each_number_once() -> None:
    assert [found.number for found in ERRORS.values()] == list(ERRORS)
    assert list(ERRORS) == sorted(ERRORS)
