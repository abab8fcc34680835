"""Which Ethernet modules answer to a call on UDP: undocumented, and used by a driver that runs in plants.

::

    13 0C 2F 9B 77 70 89 AA    to UDP port 111 of an address that the user names, a broadcast address too
    09 50 83 04 5A 22 00 22    the same
    <- to UDP port 53238       351 bytes or more: firmware, MAC, address, gateway, mask, name, description,
                               FACON port (01F4 = 500), Modbus port (01F6 = 502); at which places is not known

So of an answer its sender and its bytes are given, and nothing is read out of them: [E:discovery].
"""

from __future__ import annotations

import socket
import time
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.errors import LineError

if TYPE_CHECKING:
    from collections.abc import Callable

REQUESTS: Final = (bytes.fromhex("130C2F9B777089AA"), bytes.fromhex("095083045A220022"))
MODULE_PORT: Final = 111
ANSWER_PORT: Final = 53238
SHORTEST_ANSWER: Final = 351
_DATAGRAM: Final = 65535
_MOST_ANSWERS: Final = 1024


class Answer(NamedTuple):
    """One answer.

    Attributes:
        address: of its sender.
        port: of its sender.
        data: all of it.
    """

    address: str
    port: int
    data: bytes


def discover(
    host: str,
    port: int = MODULE_PORT,
    *,
    listen_s: float,
    answer_port: int = ANSWER_PORT,
    on_answer: Callable[[Answer], object] = lambda _: None,
) -> list[Answer]:
    """Call once, to this address alone, and listen.

    Args:
        host: a name or address, one of a network (192.168.2.255) too.
        port: of the modules.
        listen_s: for how long.
        answer_port: of this computer, to which they answer.
        on_answer: is told each answer at once; the same one again is left out.

    Raises:
        LineError: the name is not known, the port is in use here, or nothing can be sent there.
    """
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
    except (OSError, UnicodeError) as error:
        raise LineError(
            f"{host}: no such address: {getattr(error, 'strerror', None) or error}",
            hint="give an address such as 192.168.2.3, or 192.168.2.255 for all of that network",
        ) from error
    found: dict[Answer, None] = {}
    with socket.socket(family, socket.SOCK_DGRAM) as caller:
        caller.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        _take_port(caller, answer_port)
        try:
            for request in REQUESTS:
                caller.sendto(request, address)
        except OSError as error:
            raise LineError(
                f"cannot send to {host}, UDP port {port}: {error.strerror or error}",
                hint="check the address and this computer's network",
            ) from error
        until = time.monotonic() + listen_s
        while (rest := until - time.monotonic()) > 0 and len(found) < _MOST_ANSWERS:
            caller.settimeout(rest)
            try:
                data, sender = caller.recvfrom(_DATAGRAM)
            except TimeoutError:
                break
            except OSError:  # some systems report here that a port is closed over there
                continue
            answer = Answer(str(sender[0]), int(sender[1]), data)
            if data not in REQUESTS and answer not in found:
                found[answer] = None
                on_answer(answer)
    return list(found)


def _take_port(caller: socket.socket, port: int) -> None:
    try:
        caller.bind(("", port))
    except OSError as error:
        raise LineError(
            f"UDP port {port} of this computer cannot be had: {error.strerror or error}",
            hint="modules answer to this port alone: end the other program that listens there",
        ) from error
