"""What a medium is to the rest of the package, and how long a byte takes on a serial line.

Contract of a transport:

- ``read`` gives at least one byte, or raises ``TransportTimeout`` (now and then before its time: whoever
  waits looks at the clock) or ``TransportClosed``;
- ``write`` writes all, in one piece;
- ``drain`` gives what lies in the input already, without waiting;
- ``close`` may be called twice.

Errors of the operating system become the project's here and nowhere else.
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from fatektool.checks import OneOf, WholeNumber
from fatektool.value import Value

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType
    from typing import Self

WRITE_TIMEOUT_S: Final = 5.0
"""How long a medium may refuse to take a request: a flow control that never lets go, a dead pty."""

MOST_SAID: Final = 120
"""So many of the first bytes of a connection are kept: in them a gateway may say why it closes it."""

DRAIN_LIMIT: Final = 1 << 16
"""A line that babbles on is not drained for ever."""


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


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LineSettings(Value):
    """A serial line's speed and format; the factory setting is 9600 7E1 [E:factory].

    Raises:
        UsageError: a speed or format that no line has.
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
        name: the medium in words, for messages.
        clock: the clock by which its time-outs run, in seconds.
        line: port parameters in words for a serial line, else None.
    """

    name: str
    line: str | None = None
    clock: Callable[[], float] = staticmethod(time.monotonic)

    @abstractmethod
    def read(self, max_bytes: int, timeout_s: float) -> bytes:
        """Read 1 to ``max_bytes`` bytes, whatever is there first; a datagram comes whole.

        Raises:
            TransportTimeout: nothing came within ``timeout_s`` seconds.
            TransportClosed: the other side or the device is gone.
        """

    @abstractmethod
    def write(self, data: bytes) -> None:
        """Write all of ``data``.

        Raises:
            TransportTimeout: the medium takes no bytes.
            TransportClosed: the other side or the device is gone.
        """

    @abstractmethod
    def drain(self) -> bytes:
        """Take what lies in the input already; empty if nothing does, or the medium is gone."""

    @abstractmethod
    def close(self) -> None:
        """Close the medium; again is fine."""

    def set_line(self, line: LineSettings) -> None:  # noqa: B027  # most media have no speed of their own
        """Take another speed and format, if the medium has any.

        Raises:
            LineError: it does not take these.
        """

    def set_dtr(self, *, on: bool) -> bool:  # noqa: ARG002  # most media have no such wire
        """Switch Data Terminal Ready, at whose fall a modem hangs up; False where there is none."""
        return False

    def renew(self) -> None:  # noqa: B027  # most media have nothing to renew
        """Start afresh after a long silence: a connection is made anew at the next write."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
