"""The interface of all transports, and the settings of a serial line.

Contract of a transport:

- ``read`` returns at least one byte, or raises ``TransportTimeout`` (sometimes too early: the caller checks
  the clock) or ``TransportClosed``;
- ``write`` writes all bytes in one call;
- ``drain`` returns what was received already, without waiting;
- ``close`` may be called twice.

Errors of the operating system become the project's own in transports and nowhere else.
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Final

from fatektool.checks import OneOf, WholeNumber
from fatektool.value import Value, frozen

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType
    from typing import Self

WRITE_TIMEOUT_S: Final = 5.0
"""How long a write may block, because of flow control or a pty that nobody reads."""

MOST_SAID: Final = 120
"""The first bytes of a connection that are kept: a gateway may send the reason why it closes it."""

DRAIN_LIMIT: Final = 1 << 16
"""At most so many bytes are drained: a line that never stops sending is not read for ever."""


class LineFormat(OneOf):
    """Data bits, parity and stop bits of a serial line, in either case."""

    def __init__(self) -> None:
        super().__init__(
            (f"{bits}{parity}{stop}" for bits in "5678" for parity in "NEOMS" for stop in ("1", "1.5", "2")),
            expected="data bits, parity and stop bits such as 7E1 or 8N1",
        )

    def _taken(self, value: object) -> str | None:
        return super()._taken(value.upper()) if isinstance(value, str) else None


BAUD: Final = WholeNumber(50, 4_000_000)
FORMAT: Final = LineFormat()


@frozen
class LineSettings(Value):
    """A serial line's speed and format; the factory setting is 9600 7E1 [E:factory].

    Raises:
        UsageError: an invalid speed or format.
    """

    baud: int = 9600
    format: str = "7E1"

    def __post_init__(self) -> None:
        BAUD.require("baud", self.baud)
        object.__setattr__(self, "format", FORMAT.require("format", self.format))

    @property
    def data_bits(self) -> int:
        """5 to 8."""
        return int(self.format[0])

    @property
    def parity(self) -> str:
        """One of N E O M S."""
        return self.format[1]

    @property
    def stop_bits(self) -> float:
        """1, 1.5 or 2."""
        return float(self.format[2:])

    @property
    def byte_time_s(self) -> float:
        """Seconds that one byte takes on the wire: start bit, data, parity, stop bits."""
        return (1 + self.data_bits + (self.parity != "N") + self.stop_bits) / self.baud

    def __str__(self) -> str:
        return f"{self.baud} {self.format}"


class Transport(ABC):
    """A medium that carries bytes to a PLC and back.

    Attributes:
        name: its name in messages.
        clock: the clock of its time-outs, in seconds.
        serial_settings: speed and format of a serial line as text, "9600 7E1"; None for another medium.
    """

    name: str
    serial_settings: str | None = None
    clock: Callable[[], float] = staticmethod(time.perf_counter)

    @abstractmethod
    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read 1 to ``max_bytes`` bytes, as soon as there are any; a datagram is returned whole.

        Raises:
            TransportTimeout: nothing was received within ``timeout_s`` seconds.
            TransportClosed: the connection or the device is lost.
        """

    @abstractmethod
    def write(self, data: bytes) -> None:
        """Write all of ``data``.

        Raises:
            TransportTimeout: the write blocks.
            TransportClosed: the connection or the device is lost.
        """

    @abstractmethod
    def drain(self) -> bytes:
        """Return what was received already; empty if that is nothing, or the medium is lost."""

    @abstractmethod
    def close(self) -> None:
        """Close the medium; may be called again."""

    def configure(self, settings: LineSettings) -> None:  # noqa: B027  # most media have no speed of their own
        """Set speed and format, if the medium has any.

        Raises:
            LineError: it does not have these.
        """

    def set_dtr(self, *, on: bool) -> bool:  # noqa: ARG002  # most media have no such wire
        """Switch Data Terminal Ready, with which a modem hangs up; returns False if there is none."""
        return False

    def renew(self) -> None:  # noqa: B027  # most media have nothing to renew
        """After a long silence: close a connection, so that the next write makes a new one."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class WrappedTransport(Transport):
    """A transport that changes part of what another does.

    Args:
        inner: the other.
    """

    def __init__(self, inner: Transport) -> None:
        self._inner = inner
        self.name = inner.name
        self.serial_settings = inner.serial_settings
        self.clock = inner.clock

    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read from the other."""
        return self._inner.read(max_bytes, timeout_s)

    def write(self, data: bytes) -> None:
        """Write to the other."""
        self._inner.write(data)

    def drain(self) -> bytes:
        """Drain the other."""
        return self._inner.drain()

    def configure(self, settings: LineSettings) -> None:
        """Set the other's speed and format."""
        self._inner.configure(settings)
        self.serial_settings = self._inner.serial_settings

    def set_dtr(self, *, on: bool) -> bool:
        """Switch the other's DTR."""
        return self._inner.set_dtr(on=on)

    def renew(self) -> None:
        """Renew the other."""
        self._inner.renew()

    def close(self) -> None:
        """Close the other."""
        self._inner.close()
