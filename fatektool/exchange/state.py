"""What all parts of a link share: the PLC, the settings, and what is known of the PLC and its line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.errors import LineReadOnly
from fatektool.exchange.counters import Counters

if TYPE_CHECKING:
    from fatektool.protocol.codec import Codec
    from fatektool.protocol.commands import Request
    from fatektool.transport.base import LineSettings, Transport

MARGIN: Final = 1.5
"""The wait for an answer, and a recommended time-out, in multiples of the slowest answer's time."""

MOST_EXTENSION: Final = 4
"""The longest wait for an answer, in multiples of the configured time-out."""


class LinkState:
    """The PLC, the settings, and what is known of the PLC and its line.

    Args:
        transport: the medium, open.
        codec: the protocol.
        station: the PLC's station.
        line: speed and format, for wire times.
        timeout_s: the PLC's time to answer, in seconds, without wire time.
        retries: retries per request.
        read_only: refuse every request that writes.

    Attributes:
        counters: of what was sent and received.
        echoes: True if the line echoes what is sent; None if not known.
        answered: the commands that this PLC has answered.
        late_s: the longest time of a late answer, in seconds, without wire time; 0 if none was late.
        extends_wait: False if every answer has the same time.
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
        """Seconds to wait for an answer, without wire time: longer after late answers."""
        if not self.late_s or not self.extends_wait:
            return self.timeout_s
        return min(max(self.timeout_s, MARGIN * self.late_s), MOST_EXTENSION * self.timeout_s)

    def change_station(self, station: int) -> None:
        """Send requests to another station from now on; nothing is known of it yet."""
        self.station = station
        self.answered.clear()
        self.late_s = 0.0
        self._assume_no_echo_on_tcp()

    def _assume_no_echo_on_tcp(self) -> None:
        """A Modbus TCP server sends no echo. For unit 0 that is open, so that a read precedes a write."""
        if self.numbered:
            self.echoes = None if self.station == 0 else False

    def must_learn_echo(self, request: Request[Any]) -> bool:
        """True if it is not known whether the line echoes, and this request needs to know.

        The echo of some requests equals their answer. And a gateway passes on a write to unit 0 to all PLCs
        on its line, and none of them answers: so a read must show first that a single PLC answers there.
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
