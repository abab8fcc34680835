"""What all parts of a link share: which PLC is asked, how, and what is known of it and its line so far."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import LineReadOnly
from fatektool.exchange.counters import Counters

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Request
    from fatektool.transport.base import LineSettings, Transport

MARGIN: Final = 1.5
"""An answer is waited for, and a time-out recommended, this many times as long as the slowest answer took."""

MOST_EXTENSION: Final = 4
"""An answer is waited for at most this many times as long as the configured time-out."""


class LinkState:
    """Which PLC is asked, how, and what is known of it and its line.

    Args:
        transport: the medium, open.
        codec: the protocol.
        station: the PLC's station.
        line: speed and format, for wire times.
        timeout_s: the PLC's time to answer, beside wire time.
        retries: further tries per request.
        read_only: refuse every request that writes.

    Attributes:
        counters: what was sent and received so far.
        echoes: True if the line returns what is sent on it; None if that is not known.
        answered: the commands that this PLC has answered.
        late_s: the longest that an answer took that came too late, beside wire time; 0 if none did.
        extends_wait: False where every answer is to have the same time.
    """

    def __init__(
        self,
        transport: Transport,
        codec: Codec,
        station: int,
        line: LineSettings,
        *,
        timeout_s: float,
        retries: int,
        read_only: bool,
    ) -> None:
        self.transport = transport
        self.codec = codec
        self.station = station
        self.line = line
        self.byte_time_s = line.byte_time_s
        self.timeout_s = timeout_s
        self.retries = retries
        self.read_only = read_only
        self.extends_wait = True
        self.counters = Counters()
        self.echoes: bool | None = None
        self.answered: set[int] = set()
        self.late_s = 0.0
        self._assume_no_echo_on_tcp()

    @property
    def numbered(self) -> bool:
        """True if each answer carries the number of its request."""
        return self.codec.numbers > 1

    @property
    def wait_s(self) -> float:
        """How long an answer is waited for, beside wire time: longer where answers came late."""
        if not self.late_s or not self.extends_wait:
            return self.timeout_s
        return min(max(self.timeout_s, MARGIN * self.late_s), MOST_EXTENSION * self.timeout_s)

    def change_station(self, station: int) -> None:
        """Ask another station from now on; nothing is known of it yet."""
        self.station = station
        self.answered.clear()
        self.late_s = 0.0
        self._assume_no_echo_on_tcp()

    def _assume_no_echo_on_tcp(self) -> None:
        """A Modbus TCP server sends no echo. Not assumed of unit 0, so that a read goes before a write."""
        if self.numbered:
            self.echoes = None if self.station == 0 else False

    def must_learn_echo(self, request: Request[Any]) -> bool:
        """True where it is not known whether the line echoes, and this request needs that to be known.

        The echo of some requests reads as their answer. And a gateway passes a write to unit 0 on to every
        PLC behind it, none of which answers: so a read must show first that a single PLC answers there.
        """
        return self.echoes is None and (
            self.codec.echo_may_pass(request) or (request.writes and self.station == 0)
        )

    def require_permission(self, request: Request[Any]) -> None:
        """Check that this request may be sent at all.

        Raises:
            LineReadOnly: it writes, and the line is read-only.
        """
        if self.read_only and request.writes:
            raise LineReadOnly(f"{request.command.words} ({request.command:02X})")
