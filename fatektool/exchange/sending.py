"""How a request goes out: numbered where its protocol numbers them, and after the silence that it wants."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

from fatektool.protocol.commands import Loopback

if TYPE_CHECKING:
    from fatektool.exchange.link import Link
    from fatektool.protocol.codec import Frame
    from fatektool.protocol.commands import Request

_LEAST_QUIET_S: Final = 0.00175
"""Above 19200 baud a silence between frames grows no shorter (Modbus over serial line, section 2.5.1.1)."""


class Sent(NamedTuple):
    """A request as it goes out, and what its answer must bear.

    Attributes:
        raw: the frame.
        station: who is asked.
        code: the command in its frame.
        number: of it; 0 where there are none.
        size: length of its answer in bytes.
        data: what a loopback must bring back; None for any other request.
    """

    raw: bytes
    station: int
    code: int
    number: int
    size: int
    data: bytes | None

    def answered_by(self, frame: Frame) -> bool:
        """True if the frame may be its answer, as far as station, command and number tell."""
        return (frame.station, frame.command, frame.number) == (self.station, self.code, self.number)


class Sender:
    """The way out of one link.

    Args:
        link: whose requests; its transport and its codec's silence are known, and stay as they are.
    """

    def __init__(self, link: Link) -> None:
        self._link = link
        self._number = 0
        # A gateway keeps the silence before frames itself.
        quiet = link.codec.quiet_chars if link.transport.line is not None else 0.0
        self._quiet_s = max(quiet * link.byte_time_s, _LEAST_QUIET_S) if quiet else 0.0
        self._quiet_from = link.transport.clock()

    def prepare(self, request: Request[Any]) -> Sent:
        """A request as it goes out.

        Raises:
            UsageError: it cannot be said in this protocol.
        """
        codec, station = self._link.codec, self._link.station
        number = self._number = (self._number + 1) % codec.numbers
        return Sent(
            codec.encode(station, request, number),
            station,
            codec.code(request),
            number,
            codec.answer_bytes(request),
            request.data if isinstance(request, Loopback) else None,
        )

    def send(self, sent: Sent) -> None:
        """Write a request, when the line has been silent for as long as the protocol wants it."""
        link = self._link
        if self._quiet_s:
            link.hearing.listen_until(self._quiet_from + self._quiet_s)
        link.transport.write(sent.raw)
        link.hearing.expect(sent, (len(sent.raw) + sent.size) * link.byte_time_s, link.wait_s)

    def heard_out(self) -> None:
        """The line may be silent from now on."""
        if self._quiet_s:
            self._quiet_from = self._link.transport.clock()
