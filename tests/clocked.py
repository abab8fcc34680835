"""Media of this process on a clock of the test's: they read and write for real, and wait by that clock."""

from __future__ import annotations

from contextlib import ExitStack, contextmanager
from itertools import count
from typing import TYPE_CHECKING, Any, Protocol
from unittest.mock import patch

from fatektool import connection
from fatektool.errors import TransportTimeout
from fatektool.transport import tcp, udp
from fatektool.transport.base import WrappedTransport
from fatektool.transport.serial_line import port as serial_port

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fatektool.transport.base import Transport


_LOOK_S = 0.005
"""How long a client waits for real before it asks whether anything can come."""
_LOOKS = 1000
"""How often it asks: then what was on its way is lost, such as in a terminal that was full."""


class Clock(Protocol):
    """A clock that may jump, and is told of what its clients do."""

    def now(self) -> float:
        """Seconds."""

    def skip(self, seconds: float) -> None:
        """Sleep."""

    def opened(self, *, keeps: bool) -> None:
        """A client comes; on a medium that ``keeps`` them it is given what was for the one before."""

    def closed(self) -> None:
        """A client goes."""

    def asked(self, size: int) -> None:
        """A client writes so many bytes."""

    def read(self, size: int) -> None:
        """A client has read so many bytes."""

    def jump(self, deadline: float, *, sure: bool = False) -> None:
        """Jump to when the next piece is due, or to a deadline; stay where something may be on its way.

        Args:
            deadline: of the client that waits.
            sure: nothing can be on its way any more.
        """


class Clocked(WrappedTransport):
    """A medium on such a clock.

    Args:
        inner: the medium.
        clock: the clock.
    """

    def __init__(self, inner: Transport, clock: Clock) -> None:
        super().__init__(inner)
        self._clock = clock
        self._closed = False
        self.clock = clock.now
        clock.opened(keeps=inner.serial_settings is not None)

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        deadline = self.clock() + timeout_s
        for look in count():
            rest_s = deadline - self.clock()
            try:
                data = self._inner.read(max_bytes, _LOOK_S if look % 2 and rest_s > 0 else 0.0)
            except TransportTimeout:
                if rest_s <= 0:
                    break
                self._clock.jump(deadline, sure=look > _LOOKS)
            else:
                self._clock.read(len(data))
                return data
        raise TransportTimeout(f"{self.name}: nothing received within {timeout_s:.3f} s")

    def write(self, data: bytes) -> None:
        self._clock.asked(len(data))
        self._inner.write(data)

    def drain(self) -> bytes:
        data = self._inner.drain()
        self._clock.read(len(data))
        return data

    def close(self) -> None:
        self._inner.close()
        if not self._closed:
            self._closed = True
            self._clock.closed()


@contextmanager
def clocked(clock: Clock, belongs: Callable[[str], bool]) -> Iterator[None]:
    """Have clients of this process wait by a clock, those whose address (or path of a port) belongs to it."""

    def wrapping(module: Any, name: str, address_of: Callable[..., str]) -> Any:
        make = getattr(module, name)

        def made(*words: Any, **named: Any) -> Transport:
            inner: Transport = make(*words, **named)
            return Clocked(inner, clock) if belongs(address_of(*words)) else inner

        return patch.object(module, name, made)

    def of_sockets(scheme: str) -> Callable[..., str]:
        return lambda _, address, *__: f"{scheme}://{address[0]}:{address[1]}"

    with ExitStack() as stack:
        stack.enter_context(wrapping(tcp, "TcpTransport", of_sockets("tcp")))
        stack.enter_context(wrapping(udp, "UdpTransport", of_sockets("udp")))
        stack.enter_context(wrapping(serial_port, "open_serial", lambda path, *_: str(path)))
        stack.enter_context(patch.object(connection, "sleep", clock.skip))
        yield
