"""A serial port of Windows that cannot be opened or is lost, by what pyserial raises there."""

from __future__ import annotations

from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

import pytest
import serial

from fatektool.errors import LineError, PortBusy, TransportClosed, TransportTimeout
from fatektool.transport.base import LineSettings
from fatektool.transport.open import open_transport
from fatektool.transport.serial_line import url
from fatektool.transport.serial_line.port import SerialTransport
from fatektool.transport.serial_line.windows import ERRORS, WindowsErrorKind
from fatektool.transport.target import Target
from tests.platforms import posix
from tests.rows import each
from tests.transport.windows_kernel import Kernel, windows_ports

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fatektool.transport.base import Transport

LINE = LineSettings(9600, "7E1")
WORDS = {
    WindowsErrorKind.MISSING: "no such port",
    WindowsErrorKind.BUSY: "another program has the port open",
    WindowsErrorKind.NOT_SUPPORTED: "--baud and --line",
    WindowsErrorKind.BROKEN: "manufacturer's driver",
    WindowsErrorKind.GONE: "check that the adapter is plugged in",
}
TEXTS = ("Access is denied.", "Zugriff verweigert", "Das Gerät: \"COM3\" isn't connected (1, 'x', None, 9)")
pytestmark = posix("there it is pyserial's own port that is imitated here")


@pytest.fixture
def kernel(monkeypatch: pytest.MonkeyPatch) -> Kernel:
    return windows_ports(monkeypatch)


@contextmanager
def port(name: str = "COM3") -> Iterator[Transport]:
    with ExitStack() as stack:
        found = open_transport(Target.parse(name), LINE, stack, lock_wait_s=0, low_latency=False)
        assert isinstance(found, SerialTransport)
        yield found


def refusal(kernel: Kernel, function: str, number: int) -> LineError:
    kernel.failing = {function: number}
    with ExitStack() as stack, pytest.raises(LineError) as caught:
        open_transport(Target.parse("COM3"), LINE, stack, lock_wait_s=0)
    return caught.value


@pytest.mark.parametrize("function", ["CreateFileW", "SetCommState"])
def test_a_port_that_windows_does_not_open(kernel: Kernel, function: str) -> None:
    """Each number of the table, in opening and in setting up, in whatever language the system is."""
    for number, known in ERRORS.items():
        for kernel.text in TEXTS:
            error = refusal(kernel, function, number)
            said = f"{error.message}; {error.hint}"
            assert WORDS[known.kind] in said
            assert isinstance(error, PortBusy) == (known.kind is WindowsErrorKind.BUSY)
            assert known.kind is WindowsErrorKind.MISSING or f"Windows error {number}" in said
            assert error.exit_code == 3
            for wrong in ("dialout", "Error(", kernel.text, "permission"):
                assert wrong not in said


@each(
    ("number", "kind"),
    [
        *((number, WindowsErrorKind.BUSY) for number in (5, 32)),
        *((number, WindowsErrorKind.GONE) for number in (22, 121, 433, 1167)),
        (31, WindowsErrorKind.BROKEN),
        (87, WindowsErrorKind.NOT_SUPPORTED),
        (2, WindowsErrorKind.MISSING),
    ],
)
def test_what_the_numbers_mean_that_adapters_have(number: int, kind: WindowsErrorKind) -> None:
    """Source: winerror.h, and what users of pyserial report."""
    assert ERRORS[number].kind is kind


def test_a_speed_that_windows_refuses_is_named(kernel: Kernel) -> None:
    assert str(refusal(kernel, "SetCommState", 87)) == (
        "COM3: cannot be used as a serial port at 9600 7E1: the driver does not accept this baud rate or "
        "format (Windows error 87); check the name; check that the adapter supports this --baud and --line"
    )


def test_a_number_that_is_not_in_the_table(kernel: Kernel) -> None:
    """The system's own text: pyserial's has the form of a value of Python."""
    for kernel.text in TEXTS:
        error = refusal(kernel, "CreateFileW", 4711)
        assert error.message == f"COM3: {kernel.text.rstrip('.')} (Windows error 4711)"


def test_the_number_of_an_error_of_the_system(monkeypatch: pytest.MonkeyPatch) -> None:
    error = PermissionError(13, "Access is denied.")
    error.winerror = 5  # type: ignore[attr-defined, unused-ignore]  # as Windows sets it

    def open_port(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(serial, "serial_for_url", open_port)
    with ExitStack() as stack, pytest.raises(PortBusy):
        open_transport(Target.parse("COM3"), LINE, stack, lock_wait_s=0)


def reading(used: Transport) -> object:
    return used.read(1, 0.0)


def writing(used: Transport) -> object:
    used.write(b"\2")
    return None


@each(
    ("function", "use"),
    [
        ("ClearCommError", reading),
        ("ReadFile", reading),
        ("GetOverlappedResult", reading),
        ("WriteFile", writing),
    ],
)
def test_a_port_that_is_lost(function: str, use: Callable[[Transport], object]) -> None:
    """The adapter is removed while it is used: each number, in each function that has it."""
    for number in [*ERRORS, 4711]:
        if number == 995 and function == "GetOverlappedResult":  # pyserial takes it for no error
            continue
        with pytest.MonkeyPatch.context() as patched:
            kernel = windows_ports(patched)
            with port() as used:
                kernel.failing = {function: number}
                with pytest.raises(TransportClosed) as caught:
                    use(used)
                text = ERRORS[number].text if number in ERRORS else "Access is denied"
                assert caught.value.message == f"COM3: the port is lost: {text} (Windows error {number})"
                assert caught.value.hint == "check that the adapter is plugged in, and run again"
                with pytest.raises(TransportClosed):  # it stays closed
                    use(used)


def test_a_write_that_windows_aborts_is_no_write(kernel: Kernel) -> None:
    """pyserial takes it for no error, and returns how many bytes were written."""
    with port() as used:
        kernel.failing = {"GetOverlappedResult": 995}
        with pytest.raises(TransportClosed, match="only 0 of 1 bytes were written"):
            writing(used)


def test_a_port_that_is_silent_is_not_lost(kernel: Kernel) -> None:
    with port() as used:
        for kernel.failing in ({}, {"GetOverlappedResult": 995}):
            with pytest.raises(TransportTimeout):
                reading(used)
        kernel.failing = {}
        writing(used)


@each(
    ("name", "file"),
    [
        ("COM3", "COM3"),
        ("com3:", "COM3"),
        ("COM10", r"\\.\COM10"),
        ("com10:", r"\\.\COM10"),
        (r"\\.\com10", r"\\.\COM10"),
        ("//./COM3", "COM3"),
        ("CNCA0", "CNCA0"),
    ],
)
def test_the_file_that_windows_opens(name: str, file: str) -> None:
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(url, "WINDOWS", True)
        kernel = windows_ports(patched)
        with port(name):
            pass
        assert kernel.files == [file]


def test_the_table_has_each_number_once() -> None:
    assert [found.number for found in ERRORS.values()] == list(ERRORS)
    assert list(ERRORS) == sorted(ERRORS)
