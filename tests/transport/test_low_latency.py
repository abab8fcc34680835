"""``--low-latency``: what the driver is asked, seen at the system calls, and read back from a real one.

A pty's name is what keeps it from being asked, so here it is taken for a port like others.
"""

from __future__ import annotations

import os
import sys
from array import array
from typing import TYPE_CHECKING, Any

import pytest

from fatektool.cli import run
from fatektool.errors import LineError
from fatektool.transport.base import LineSettings
from fatektool.transport.serial_line import port as serial_port
from fatektool.transport.serial_line.port import open_serial

if sys.platform != "linux":
    pytest.skip("the setting is Linux's", allow_module_level=True)

import fcntl
import termios

if TYPE_CHECKING:
    from collections.abc import Iterator

ASYNC_LOW_LATENCY = 1 << 13  # linux/tty_flags.h
FLAGS = 4  # of the integers of a serial_struct, linux/serial.h: type, line, port, irq, flags
OTHER_FLAGS = 0x40
LINE = LineSettings(9600, "8N1")
REAL_PORT = "/dev/ttyS0"


@pytest.fixture
def port(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A pty that is not taken for one."""
    master, slave = os.openpty()
    monkeypatch.setattr(serial_port, "_is_pty", lambda _: False)
    yield os.ttyname(slave)
    os.close(master)
    os.close(slave)


class Driver:
    """What a USB adapter's driver does with the two requests; the others are the pty's."""

    def __init__(self) -> None:
        self.kept = array("i", [0] * 32)
        self.kept[FLAGS] = OTHER_FLAGS
        self.asked: list[str] = []
        self._ioctl: Any = fcntl.ioctl

    def ioctl(self, descriptor: int, request: int, argument: Any = 0, *rest: Any) -> Any:
        if request == termios.TIOCGSERIAL:
            self.asked.append("get")
            argument[:] = self.kept
            return 0
        if request == termios.TIOCSSERIAL:
            self.asked.append("set")
            self.kept[:] = argument
            return 0
        return self._ioctl(descriptor, request, argument, *rest)


@pytest.fixture
def driver(monkeypatch: pytest.MonkeyPatch) -> Driver:
    found = Driver()
    monkeypatch.setattr(fcntl, "ioctl", found.ioctl)
    return found


def nobody_answers(port: str) -> list[str]:
    """A status that soon gives up."""
    words = ["--format", "8N1", "--baud", "115200", "--timeout", "0.001", "--retries", "0"]
    return ["status", "-p", port, *words]


def test_on_asks_the_driver(port: str, driver: Driver) -> None:
    notes: list[str] = []
    open_serial(port, LINE, note=notes.append).close()
    assert driver.asked == ["get", "set"]
    assert driver.kept[FLAGS] == OTHER_FLAGS | ASYNC_LOW_LATENCY  # and what else it had is kept
    assert not [note for note in notes if "latency" in note]


def test_off_does_not(port: str, driver: Driver) -> None:
    open_serial(port, LINE, low_latency=False).close()
    assert driver.asked == []
    assert driver.kept[FLAGS] == OTHER_FLAGS


def test_a_pty_is_not_asked(driver: Driver) -> None:
    master, slave = os.openpty()
    open_serial(os.ttyname(slave), LINE).close()
    os.close(master)
    os.close(slave)
    assert driver.asked == []


@pytest.mark.parametrize(
    ("options", "asked"),
    [((), ["get", "set"]), (("--low-latency",), ["get", "set"]), (("--no-low-latency",), [])],
    ids=["usually", "on", "off"],
)
def test_the_option(port: str, driver: Driver, options: tuple[str, ...], asked: list[str]) -> None:
    assert run([*nobody_answers(port), *options]) == LineError.exit_code
    assert driver.asked == asked


def test_a_refusal_is_told_and_no_more(port: str, capsys: pytest.CaptureFixture[str]) -> None:
    """The system itself refuses: a pty has no such setting."""
    notes: list[str] = []
    transport = open_serial(port, LINE, note=notes.append)
    transport.write(b"\x02")
    transport.close()
    assert [note for note in notes if note.startswith(f"{port}: the driver has no low-latency mode: ")]

    assert run([*nobody_answers(port), "-v"]) == LineError.exit_code
    assert "has no low-latency mode" in capsys.readouterr().err
    assert run(nobody_answers(port)) == LineError.exit_code
    assert "low latency" not in capsys.readouterr().err


def flags_of(path: str) -> int:
    held = array("i", [0] * 32)
    descriptor = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        fcntl.ioctl(descriptor, termios.TIOCGSERIAL, held)
    finally:
        os.close(descriptor)
    return held[FLAGS]


def test_a_real_driver_keeps_it() -> None:
    """Where there is a serial port, and the right to set it: what was set is read back."""
    import serial

    try:
        before = flags_of(REAL_PORT)
        with serial.Serial(REAL_PORT) as real:
            real.set_low_latency_mode(False)
    except (OSError, ValueError) as error:
        pytest.skip(f"no serial port to set here: {error}")
    try:
        open_serial(REAL_PORT, LINE, low_latency=False).close()
        assert not flags_of(REAL_PORT) & ASYNC_LOW_LATENCY
        open_serial(REAL_PORT, LINE).close()
        assert flags_of(REAL_PORT) & ASYNC_LOW_LATENCY
    finally:
        with serial.Serial(REAL_PORT) as real:
            real.set_low_latency_mode(bool(before & ASYNC_LOW_LATENCY))
