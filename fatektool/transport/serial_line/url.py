"""The device or the gateway of a URL of pyserial.

::

    rfc2217://HOST:PORT, socket://HOST:PORT     a gateway
    spy://DEVICE?…, alt://DEVICE?…              a device of this computer
    hwgrep://REGEX&…                            the first device whose description matches
    loop://                                     none: every byte written is received

Two targets with the same device or gateway are one line: they have one lock, and are used one after the
other.
"""

from __future__ import annotations

import os
import re
from typing import Final
from urllib.parse import urlsplit

from fatektool.errors import FatektoolError, LineError, UsageError
from fatektool.files.portable_name import WINDOWS
from fatektool.transport.serial_line.windows import port_name

NETWORK: Final = ("rfc2217://", "socket://")
AROUND_A_DEVICE: Final = ("spy://", "alt://")
SEARCH: Final = "hwgrep://"
LOOP: Final = "loop://"


_SEARCHES: Final = 'expected hwgrep://REGEX, such as "hwgrep://FT232" or "hwgrep://0403:6001"'


def require_place(target: str) -> None:
    """Check that a URL has what its scheme needs: host and port, a device, or a text to search for.

    Raises:
        UsageError: it is missing.
    """
    scheme, _, rest = target.partition("://")
    scheme = f"{scheme.lower()}://"
    if scheme in NETWORK:
        host_of(target)
    elif scheme in AROUND_A_DEVICE and not rest.partition("?")[0]:
        raise UsageError(f"{target}: expected {scheme}PORT", hint=f"such as {scheme}/dev/ttyUSB0")
    elif scheme == SEARCH and not rest.partition("&")[0]:
        raise UsageError(f"{target}: expected a text to search for", hint=_SEARCHES)


def host_of(target: str) -> tuple[str, int] | None:
    """Host and port of a URL with a gateway; None for any other target.

    Raises:
        UsageError: host or port is missing.
    """
    if not target.lower().startswith(NETWORK):
        return None
    try:
        parts = urlsplit(target)
        host, port = parts.hostname, parts.port
    except ValueError:
        host = port = None
    if not host or not port:
        scheme = target.partition("://")[0].lower()
        raise UsageError(
            f"{target}: expected {scheme}://HOST:PORT",
            hint=f"such as {scheme}://192.168.2.3:4001, with the port of the gateway",
        )
    return host, port


def device_of(target: str) -> str | None:
    """The device of a target; None if it has none.

    Raises:
        LineError: a search that finds none.
        UsageError: an invalid search.
    """
    if "://" not in target:
        return target
    if target.lower().startswith(AROUND_A_DEVICE):
        return target.partition("://")[2].partition("?")[0]
    if target.lower().startswith(SEARCH):
        return _found(target)
    return None


def line_name(target: str) -> str:
    """The name of a serial target's line: the same for all names of one device or URL without a host.

    A search that finds nothing, or finds it later, is its own name.
    """
    try:
        device = device_of(target)
    except FatektoolError:
        device = None
    if device is None:
        return target.upper()
    return port_name(device).upper() if WINDOWS else os.path.realpath(device)  # COM3 is not a path


def opened_name(target: str) -> str:
    """The name by which pyserial opens a target: on Windows it takes no ``COM10:`` and no ``//./COM10``."""
    return port_name(target) if WINDOWS and "://" not in target else target


def _found(target: str) -> str:
    """The device that pyserial's own search finds."""
    from serial import SerialException
    from serial.urlhandler.protocol_hwgrep import Serial

    try:
        return str(Serial().from_url(target))
    except (ValueError, re.error) as error:
        raise UsageError(f"{target}: invalid search: {error}", hint=_SEARCHES) from error
    except SerialException as error:
        raise LineError(
            f"{target}: no serial port has such a name or description",
            hint="check that the adapter is plugged in; 'fatektool ports' lists the serial ports",
        ) from error
