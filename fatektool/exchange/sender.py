"""How requests are sent: numbered where the protocol numbers them, after the pause that it requires."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.exchange.sent import Sent
from fatektool.protocol.commands import Loopback

if TYPE_CHECKING:
    from fatektool.exchange.receiver import Receiver
    from fatektool.exchange.state import LinkState
    from fatektool.protocol.commands import Request

_LEAST_QUIET_S: Final = 0.00175
"""Above 19200 baud the pause between frames gets no shorter (Modbus over serial line, section 2.5.1.1)."""


class Sender:
    """The output of one link.

    Args:
        state: of the link; its transport and its codec's pause stay as they are.
        receiver: listens in the pause, and is told what was sent.

    Attributes:
        shapes: what the answers to all requests since the last fence look like (``Codec.shape``).
    """

    def __init__(self, state: LinkState, receiver: Receiver) -> None:
        self.shapes: set[bytes] = set()
        self._state = state
        self._receiver = receiver
        self._number = 0
        # A gateway keeps the pause between frames itself.
        quiet = state.codec.quiet_chars if state.transport.line is not None else 0.0
        self._quiet_s = max(quiet * state.byte_time_s, _LEAST_QUIET_S) if quiet else 0.0
        self._quiet_from = state.transport.clock()

    def prepare(self, request: Request[Any]) -> Sent:
        """A request as it is sent; its answer may come from now on, until the next fence.

        Raises:
            UsageError: the protocol cannot express it.
            LineReadOnly: it writes, and the line is read-only.
        """
        state = self._state
        codec, station = state.codec, state.station
        state.require_permission(request)
        self.note_asked(request)
        state.counters.writes += request.writes
        number = self._number = (self._number + 1) % codec.numbers
        return Sent(
            codec.encode(station, request, number),
            station,
            codec.code(request),
            number,
            codec.answer_bytes(request),
            request.data if isinstance(request, Loopback) else None,
        )

    def note_asked(self, request: Request[Any]) -> None:
        """Remember what the answer to a request looks like; it may come at any time until the next fence."""
        self.shapes.add(self._state.codec.shape(request))

    def send(self, sent: Sent) -> None:
        """Write a request, once the line has been silent for as long as the protocol requires."""
        if self._quiet_s:
            self._receiver.listen_until(self._quiet_from + self._quiet_s)
        self._state.transport.write(sent.raw)
        self._receiver.outstanding.note_sent(sent)

    def note_end(self) -> None:
        """An exchange is over: the line may be silent from now on."""
        if self._quiet_s:
            self._quiet_from = self._state.transport.clock()
