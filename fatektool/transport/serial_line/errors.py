"""What pyserial raises, in the project's words, each with its next step."""

from __future__ import annotations

import errno
from typing import TYPE_CHECKING

from fatektool.errors import FatektoolError, LineError, PortBusy, TransportClosed, UsageError

if TYPE_CHECKING:
    from fatektool.transport.base import LineSettings


def open_error(target: str, line: LineSettings, error: Exception) -> FatektoolError:
    """A target that cannot be opened, in the project's words.

    Args:
        target: as the user wrote it.
        line: speed and format asked for.
        error: what pyserial, a URL handler of its, or termios raised.
    """
    cause: BaseException = error
    if type(error.__context__).__name__ == "error":  # of termios: pyserial keeps its number as text only
        cause = error.__context__ or error
    if wrong := _wrong_url(target, error):
        return wrong
    number, text = getattr(error, "errno", None), str(error)
    if number is None and len(cause.args) == 2 and isinstance(cause.args[0], int):
        number, text = cause.args
    if number in {errno.EBUSY, errno.EAGAIN, errno.EWOULDBLOCK} or "exclusively lock" in text:
        return PortBusy(
            f"{target}: another program has the port open",
            hint="close it (a terminal, the vendor's program), or wait and run again",
        )
    if number == errno.ENOENT or "FileNotFoundError" in text:
        return LineError(
            f"{target}: no such port",
            hint="'fatektool ports' lists the serial ports here; is the adapter plugged in?",
        )
    if number in {errno.EACCES, errno.EPERM} or "PermissionError" in text:
        return LineError(
            f"{target}: no right to use the port",
            hint="on Linux join the group that owns it (often dialout) and log in again",
        )
    if number in {errno.EINVAL, errno.ENOTTY} or isinstance(error, ValueError):
        return LineError(
            f"{target}: cannot be used as a serial port at {line}: {text}",
            hint="check the name, --baud and --format against what the adapter can do",
        )
    hint = "check the URL" if "://" in target else "try 'fatektool ports'"
    return LineError(f"{target}: cannot open: {text}", hint=hint)


def network_error(
    target: str, line: LineSettings, error: Exception, *, lost: bool = False, said: str = ""
) -> FatektoolError:
    """A URL of another computer that cannot be opened, in the project's words.

    Args:
        target: as the user wrote it.
        line: speed and format asked for.
        error: what pyserial raised.
        lost: True if the gateway closed the connection that it had accepted.
        said: what it said before.
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
            f"{target}: the other side is there and does not speak RFC 2217",
            hint="for a port that carries bare bytes use tcp:// or socket://; else set the gateway's port to "
            "RFC 2217 (telnet)",
        )
    if "parameter change" in str(error) or "rejected value" in str(error):
        return LineError(
            f"{target}: the gateway does not set its serial port to {line}",
            hint="check --baud and --format; or set the port in the gateway, and use tcp:// or socket://",
        )
    return LineError(f"{target}: cannot open: {error}", hint="check the URL, and that the gateway is on")


def _wrong_url(target: str, error: Exception) -> UsageError | None:
    """The error of a URL that pyserial does not understand; None for any other."""
    if isinstance(error, ValueError) and str(error).startswith("invalid URL, protocol"):
        return UsageError(
            f"{target}: no such kind of target: {target.partition('://')[0]}://",
            hint="expected a serial port such as /dev/ttyUSB0 or COM3, tcp://, udp://, rfc2217://, "
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
    """The error of a connection that is gone.

    Args:
        target: as the user wrote it.
        said: what it said in plain text before; empty for nothing.
    """
    words = f", after it said {said!r}" if said else ""
    return TransportClosed(
        f"{target}: the connection to the gateway was closed or broke{words}",
        hint="is the gateway on, and the cable in? Another program may hold its only connection, or its "
        "serial port is not there",
        may_return=True,
    )
