"""The errors of pyserial as the project's own, each with its next step."""

from __future__ import annotations

import errno
import os
from typing import TYPE_CHECKING, Final

from fatektool.errors import FatektoolError, LineError, PortBusy, TransportClosed, UsageError
from fatektool.transport.nearly import meant, next_step
from fatektool.transport.serial_line.windows import WindowsErrorKind, windows_error

if TYPE_CHECKING:
    from fatektool.transport.base import LineSettings


def open_error(target: str, settings: LineSettings, error: Exception) -> FatektoolError:
    """The error for a target that cannot be opened.

    Args:
        target: as the user wrote it.
        settings: speed and format.
        error: of pyserial, one of its URL handlers, or termios.
    """
    cause: BaseException = error
    if type(error.__context__).__name__ == "error":  # of termios: pyserial keeps its number only as text
        cause = error.__context__ or error
    if wrong := _wrong_url(target, error) or _windows_error(target, settings, error):
        return wrong
    number, text = getattr(error, "errno", None), str(error)
    if number is None and len(cause.args) == 2 and isinstance(cause.args[0], int):
        number, text = cause.args
    if number in {errno.EBUSY, errno.EAGAIN, errno.EWOULDBLOCK} or "exclusively lock" in text:
        return PortBusy(
            f"{target}: another program has the port open",
            hint="close that program (a terminal, the vendor's software), or wait and run again",
        )
    if number == errno.ENOENT or "FileNotFoundError" in text:
        return LineError(f"{target}: no such port", hint=next_step(target))
    if number in {errno.EACCES, errno.EPERM} or "PermissionError" in text:
        return LineError(
            f"{target}: no permission to use the port",
            hint="on Linux add your user to the group that owns it (often dialout), and log in again",
        )
    if number in {errno.EINVAL, errno.ENOTTY} or isinstance(error, ValueError):
        return LineError(
            f"{target}: cannot be used as a serial port at {settings}: {text}",
            hint="check the name; check that the adapter supports this --baud and --line",
        )
    hint = "check the URL" if "://" in target else "'fatektool ports' lists the serial ports"
    return LineError(f"{target}: cannot open: {text}", hint=hint)


def _windows_error(target: str, settings: LineSettings, error: Exception) -> LineError | None:
    """The error for a port that Windows does not open or set up; None if it is of another system."""
    found = windows_error(error)
    if found is None:
        return None
    match found.kind:
        case WindowsErrorKind.MISSING:
            return LineError(f"{target}: no such port", hint=next_step(target))
        case WindowsErrorKind.BUSY if os.path.isdir(target):  # noqa: PTH112  # pathlib is loaded later
            return LineError(f"{target}: is a folder, not a serial port", hint=next_step(target))
        case WindowsErrorKind.BUSY:
            return PortBusy(
                f"{target}: another program has the port open ({found})",
                hint="close that program (a terminal, the vendor's software), or wait and run again",
            )
        case WindowsErrorKind.NOT_SUPPORTED:
            return LineError(
                f"{target}: cannot be used as a serial port at {settings}: {found.text} ({found})",
                hint="check the name; check that the adapter supports this --baud and --line",
            )
        case other:
            return LineError(f"{target}: {found.text} ({found})", hint=_HINTS[other])


_HINTS: Final = {
    WindowsErrorKind.BROKEN: "unplug the adapter and plug it in again; if that does not help, install its "
    "manufacturer's driver",
    WindowsErrorKind.GONE: "check that the adapter is plugged in; unplug it, plug it in again and run again",
    WindowsErrorKind.UNKNOWN: "check the adapter, its driver and the name; 'fatektool ports' lists the "
    "serial ports",
}


def port_lost(target: str, reason: object) -> TransportClosed:
    """The error of a device that was opened, and fails while it is used.

    Args:
        target: as the user wrote it.
        reason: the error of pyserial or the system, or the reason in words.
    """
    found = windows_error(reason) if isinstance(reason, Exception) else None
    text = f"{found.text} ({found})" if found else str(reason)
    return TransportClosed(
        f"{target}: the port is lost: {text}",
        hint="check that the adapter is plugged in, and run again",
    )


def network_error(
    target: str, settings: LineSettings, error: Exception, *, lost: bool = False, said: str = ""
) -> FatektoolError:
    """The error for a URL of a gateway that cannot be opened.

    Args:
        target: as the user wrote it.
        settings: speed and format.
        error: of pyserial.
        lost: True if the gateway closed the connection that it had accepted.
        said: text that it sent before; empty for none.
    """
    cause = error.__context__
    if wrong := _wrong_url(target, error):
        return wrong
    if lost:
        return gateway_closed(target, said)
    if isinstance(cause, OSError) and str(error).startswith("Could not open port"):
        host, _, port = target.partition("://")[2].partition("?")[0].rstrip("/").rpartition(":")
        return TransportClosed(
            f"{target}: cannot connect to {host} port {port}: {cause.strerror or cause}",
            hint="check address and port, and that the gateway is on",
            may_return=isinstance(cause, ConnectionError),
        )
    if "does not seem to support RFC2217" in str(error):
        return LineError(
            f"{target}: the other side accepts the connection, but does not use RFC 2217",
            hint="for a raw TCP port use tcp:// or socket://; else set the port of the gateway to RFC 2217 "
            "(telnet)",
        )
    if "parameter change" in str(error) or "rejected value" in str(error):
        return LineError(
            f"{target}: the gateway does not set its serial port to {settings}",
            hint="check --baud and --line; or set the port in the gateway, and use tcp:// or socket://",
        )
    return LineError(f"{target}: cannot open: {error}", hint="check the URL, and that the gateway is on")


def _wrong_url(target: str, error: Exception) -> UsageError | None:
    """The error for a URL that pyserial cannot parse; None if ``error`` is another one."""
    if isinstance(error, ValueError) and str(error).startswith("invalid URL, protocol"):
        return UsageError(
            f"{target}: unknown kind of target: {target.partition('://')[0]}://",
            hint=meant(target)
            or "expected a serial port such as /dev/ttyUSB0 or COM3, tcp://, udp://, rfc2217://, "
            "socket://, hwgrep://, spy:// or sim:",
        )
    if any(isinstance(each, KeyError) for each in (error, error.__context__)):
        reason = "unknown option or value"
    elif "expected a string in the form" in str(error):
        reason = str(error).partition('": ')[2]
    else:
        return None
    return UsageError(f"{target}: invalid options: {reason}", hint="correct what follows the question mark")


def gateway_closed(target: str, said: str) -> TransportClosed:
    """The error for a connection that is lost.

    Args:
        target: as the user wrote it.
        said: text that the gateway sent before; empty for none.
    """
    reason = f", after it sent {said!r}" if said else ""
    return TransportClosed(
        f"{target}: the connection to the gateway was closed or lost{reason}",
        hint="check that the gateway is on, and its cable. Another program may use its only connection, "
        "or its serial port is missing",
        may_return=True,
    )
