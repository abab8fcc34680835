"""Discovery of Ethernet modules by UDP: undocumented, but used by a driver that runs in plants.

::

    13 0C 2F 9B 77 70 89 AA    to UDP port 111 of an address that the user gives, also a broadcast address
    09 50 83 04 5A 22 00 22    the same
    <- to UDP port 53238       351 bytes or more: firmware, MAC, address, gateway, mask, name, description,
                               FACON port (01F4 = 500), Modbus port (01F6 = 502); their offsets are unknown

So only the sender and the bytes of an answer are returned: [E:discovery].
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
        address: IP address of the sender.
        port: UDP port of the sender.
        data: its bytes.
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
    """Send the requests once, to this address only, and receive answers.

    Args:
        host: a name or address, also a broadcast address (192.168.2.255).
        port: UDP port of the modules.
        listen_s: how long to wait for answers, in seconds.
        answer_port: UDP port of this computer, to which modules answer.
        on_answer: gets each new answer at once.

    Raises:
        LineError: unknown name, the port is in use on this computer, or sending fails.
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
                hint="check the address and the network of this computer",
            ) from error
        until = time.perf_counter() + listen_s
        while (rest := until - time.perf_counter()) > 0 and len(found) < _MOST_ANSWERS:
            caller.settimeout(rest)
            try:
                data, sender = caller.recvfrom(_DATAGRAM)
            except TimeoutError:
                break
            except OSError:  # some systems report here that the port of the other side is closed
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
            f"UDP port {port} of this computer cannot be used: {error.strerror or error}",
            hint="modules answer only to this port: close the other program that uses it",
        ) from error
