"""Where a URL of pyserial leads: to a device of this computer, or to a port of another.

::

    rfc2217://HOST:PORT, socket://HOST:PORT     a port of another computer
    spy://DEVICE?…, alt://DEVICE?…              a device of this one
    hwgrep://REGEX&…                            the first device whose description it matches
    loop://                                     nowhere: what is written is read

Two targets that lead to the same place are one line: they share its lock, and are not asked at once.
"""

from __future__ import annotations

import os
import re
from typing import Final
from urllib.parse import urlsplit

from fatektool.errors import FatektoolError, LineError, UsageError

NETWORK: Final = ("rfc2217://", "socket://")
AROUND_A_DEVICE: Final = ("spy://", "alt://")
SEARCH: Final = "hwgrep://"
LOOP: Final = "loop://"


_SEARCHES: Final = "expected hwgrep://REGEX, such as 'hwgrep://FT232' or 'hwgrep://0403:6001'"


def require_place(target: str) -> None:
    """Check that a URL names what it must name: host and port, a device, what to search for.

    Raises:
        UsageError: it does not.
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
    """Host and port of a URL that leads to another computer; None for any other target.

    Raises:
        UsageError: it names no host or no port.
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
            hint=f"such as {scheme}://192.168.2.3:4001; the port is the gateway's",
        )
    return host, port


def device_of(target: str) -> str | None:
    """The device behind a target; None if that leads to none.

    Raises:
        LineError: a search that finds none.
        UsageError: a search that is none.
    """
    if "://" not in target:
        return target
    if target.lower().startswith(AROUND_A_DEVICE):
        return target.partition("://")[2].partition("?")[0]
    if target.lower().startswith(SEARCH):
        return _found(target)
    return None


def line_of(target: str) -> str:
    """What a serial target's line is called: the same for all names of one device or URL, host aside.

    A search that finds nothing, or finds it later, stands for itself.
    """
    try:
        device = device_of(target)
    except FatektoolError:
        device = None
    if device is None:
        return target.upper()
    return device.upper() if os.name == "nt" else os.path.realpath(device)  # COM3 is a name, not a path


def _found(target: str) -> str:
    """The device that pyserial's own search finds, as its handler reads the URL."""
    from serial import SerialException
    from serial.urlhandler.protocol_hwgrep import Serial

    try:
        return str(Serial().from_url(target))
    except (ValueError, re.error) as error:
        raise UsageError(f"{target}: invalid search: {error}", hint=_SEARCHES) from error
    except SerialException as error:
        raise LineError(
            f"{target}: no serial port here has such a name or description",
            hint="'fatektool ports' lists those here; is the adapter plugged in?",
        ) from error
