"""Sending of requests: numbered if the protocol numbers them, after the pause that it requires."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fatektool.exchange.sent import Sent
from fatektool.protocol.commands import Loopback

if TYPE_CHECKING:
    from fatektool.exchange.receiver import Receiver
    from fatektool.exchange.state import LinkState
    from fatektool.protocol.commands import Request

Encoded = tuple[bytes, int]
"""A request to be sent: its frame, and its transaction number (0 if the protocol has none)."""

_LEAST_QUIET_S: Final = 0.00175
"""Above 19200 baud the pause between frames is fixed (Modbus over serial line, section 2.5.1.1)."""


class Sender:
    """The output of one link.

    Args:
        state: of the link; its transport and its codec's pause do not change.
        receiver: reads in the pause, and gets what was sent.

    Attributes:
        shapes: the shapes of the answers to all requests since the last fence (``Codec.shape``); empty if
            fences are unique.
    """

    def __init__(self, state: LinkState, receiver: Receiver) -> None:
        self.shapes: set[bytes] = set()
        self._state = state
        self._receiver = receiver
        self._number = 0
        self._numbers = state.codec.numbers
        self._unique_fences = state.codec.unique_fences
        # A gateway keeps the pause between frames itself.
        quiet = state.codec.quiet_chars if state.transport.serial_settings is not None else 0.0
        self._quiet_s = max(quiet * state.byte_time_s, _LEAST_QUIET_S) if quiet else 0.0
        self._quiet_from = state.transport.clock()

    def encode(self, request: Request[Any]) -> Encoded:
        """A request to be sent; its answer may be received from now on, until the next fence.

        Raises:
            UsageError: the protocol cannot express it.
            LineReadOnly: it writes, and the line is read-only.
        """
        state = self._state
        if request.writes:
            state.require_permission(request)
            state.counters.writes += 1
        if not self._unique_fences:
            self.note_asked(request)
        if self._numbers > 1:
            self._number = (self._number + 1) % self._numbers
        number = self._number
        return state.codec.encode(state.station, request, number), number

    def described(self, request: Request[Any], raw: bytes, number: int) -> Sent:
        """A request with what its answer must contain.

        Args:
            request: the request.
            raw: its frame.
            number: its transaction number.
        """
        codec = self._state.codec
        return Sent(
            raw,
            self._state.station,
            codec.code(request),
            number,
            codec.answer_bytes(request),
            request.data if isinstance(request, Loopback) else None,
        )

    def note_asked(self, request: Request[Any]) -> None:
        """Remember the shape of the answer to a request; it may be received until the next fence."""
        if not self._unique_fences:
            self.shapes.add(self._state.codec.shape(request))

    def send(self, raw: bytes) -> None:
        """Write a frame, after the line was silent for as long as the protocol requires."""
        if self._quiet_s:
            self._receiver.listen_until(self._quiet_from + self._quiet_s)
        self._state.transport.write(raw)

    def note_end(self) -> None:
        """Note that an exchange is over: the line may be silent from now on."""
        if self._quiet_s:
            self._quiet_from = self._state.transport.clock()
