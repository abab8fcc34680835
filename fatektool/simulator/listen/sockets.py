"""The sockets of the listeners, bound to an address."""

from __future__ import annotations

import os
import socket

from fatektool.errors import LineError

READ_BYTES = 65536
_MAX_PORT = 0xFFFF


def bound(kind: socket.SocketKind, scheme: str, host: str, port: int) -> socket.socket:
    """A socket at this address; LineError if it cannot be used."""
    shown = f"{scheme}://{f'[{host}]' if ':' in host else host}:{port}"
    if not 0 <= port <= _MAX_PORT:  # getaddrinfo would use it modulo 65536
        raise LineError(f"cannot listen on {shown}: expected a port from 0 to {_MAX_PORT}", address=shown)
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=kind, flags=socket.AI_PASSIVE)[0]
        opened = socket.socket(family, kind)
    except (OSError, UnicodeError, OverflowError) as error:
        raise _cannot_listen(shown, error) from error
    try:
        # On Windows the option would let two servers share a port.
        if kind == socket.SOCK_STREAM and os.name == "posix":
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        opened.bind(address)
        opened.settimeout(0)
    except (OSError, OverflowError) as error:
        opened.close()
        raise _cannot_listen(shown, error) from error
    return opened


def _cannot_listen(shown: str, error: Exception) -> LineError:
    reason = getattr(error, "strerror", None) or str(error)
    return LineError(
        f"cannot listen on {shown}: {reason}",
        hint="choose another port, or 0 for any free one",
        address=shown,
    )


def address_of(scheme: str, opened: socket.socket) -> str:
    """The address of a socket, as text."""
    host, port = opened.getsockname()[:2]
    return f"{scheme}://[{host}]:{port}" if ":" in host else f"{scheme}://{host}:{port}"
