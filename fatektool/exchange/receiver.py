"""Input other than the expected answers: noise, frames of other stations, unexpected answers.

After such input, answers may be shifted against requests, until a fence shows that nothing else can be
received: ``needs_fence``. ``unsolicited`` counts input that answers no request: an answer to an earlier
request may have been taken for that of a later one, so the answers to many requests of one kind must be
checked. An answer that is outstanding is not unsolicited, but late (``outstanding``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.callbacks import ignore
from fatektool.counts import counted
from fatektool.errors import FrameError, TransportTimeout
from fatektool.exchange.outstanding import Outstanding
from fatektool.exchange.state import MOST_EXTENSION
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.errors import GatewayTimeout
    from fatektool.exchange.sent import Sent
    from fatektool.exchange.state import LinkState
    from fatektool.protocol.codec import Frame

READ_BYTES: Final = 4096
"""The most bytes of one read."""

LONGEST_LISTENING_S: Final = 2.0
"""Before a PLC is reported as silent, its answer is waited for at most this much longer than its time-out."""


class Receiver:
    """The input of one link.

    Args:
        state: of the link.

    Attributes:
        decoder: splits the input into frames.
        outstanding: the requests whose answers may still be received.
        unsolicited: the number of inputs that answer no request.
        needs_fence: True until a fence shows that nothing else can be received.
        on_stray: gets each valid frame that answers no open request.
        on_bad_bytes: gets bytes that are not a frame.
        instead: what was received instead of an answer, for messages; empty for nothing.
        gateway_error: the answer of a gateway, instead of the PLC, to the last request; None if there is
            none.
        wrong_number: True if an answer had a transaction number that no request had.
    """

    def __init__(self, state: LinkState) -> None:
        self.decoder = state.codec.decoder()
        self.outstanding = Outstanding(state)
        self.unsolicited = 0
        self.needs_fence = False
        self.on_stray: Callable[[Frame], object] = ignore
        self.on_bad_bytes: Callable[[FrameError], object] = ignore
        self.instead = ""
        self.gateway_error: GatewayTimeout | None = None
        self.wrong_number = False
        self._state = state
        self._counters = state.counters
        self._transport = state.transport
        self._stations_to_fence: set[int] = set()  # other stations, whose late answers may still be received

    def change_station(self, station: int) -> bool:
        """Expect another station's answers; True if one to an earlier request may still be received from it.

        Answers carry their station, so those of the previous station matter only when it is asked again.

        Args:
            station: the other station; the state still has the previous one.
        """
        if self.needs_fence:
            self._stations_to_fence.add(self._state.station)
        self.outstanding.change_station()
        may_come = station in self._stations_to_fence
        self._stations_to_fence.discard(station)
        self.needs_fence = self.needs_fence or may_come
        return may_come

    # --- the outcome of a request -----------------------------------------------------------------

    def fence_passed(self) -> None:
        """Note that no answer to an earlier request can be received any more."""
        self.needs_fence = False
        self.outstanding.forget()

    def note_no_answer(self) -> None:
        """Note that the last request has no answer in time."""
        self.needs_fence = True
        self.outstanding.keep_last(waited_for=True)

    def give_up_answer(self) -> None:
        """Note that the answer to the last request is not waited for."""
        self.needs_fence = True
        self.outstanding.keep_last(waited_for=False)

    # --- input instead of an answer ---------------------------------------------------------------

    def note_bad_bytes(self, error: FrameError) -> None:
        """Note bytes that are not a frame."""
        self.needs_fence = True
        self.on_bad_bytes(error)
        if error.checksum:
            self._counters.checksum_errors += 1
            self.instead = f"a damaged frame ({error.message})"
        else:
            self._counters.garbled += 1
            self.instead = self.instead or f"{counted(len(error.raw), 'byte')} without a valid frame"

    def note_stray(self, frame: Frame, asked: Sent | None = None) -> None:
        """Note a valid frame that answers no open request.

        Args:
            frame: the frame.
            asked: the open request; None if there is none.
        """
        self._counters.strays += 1
        self.needs_fence = True
        if frame.station != self._state.station:
            self.instead = f"a frame of station {frame.station}"
        elif not self.outstanding.take_late(frame):
            self._note_unsolicited(frame, asked)
        self.on_stray(frame)

    def _note_unsolicited(self, frame: Frame, asked: Sent | None) -> None:
        if asked is not None and (frame.command, frame.number) == (asked.code, asked.number):
            pass  # the caller has set ``instead``
        elif asked is not None and frame.command == asked.code:
            self.wrong_number = True
            self.instead = (
                f"an answer with transaction number {frame.number:04X}, expected {asked.number:04X} "
                "as in the request"
            )
        elif frame.command == Command.LOOPBACK:
            self.instead = self.instead or "another loopback's answer"
        else:
            self.instead = self.instead or f"an answer to another command ({frame.command:02X})"
        if frame.command != Command.LOOPBACK:  # the answer to an old fence differs from all others
            self.unsolicited += 1

    # --- without an open request ------------------------------------------------------------------

    def drop_input(self) -> bool:
        """Before a request: drop the input, after a check whether it shows that answers are shifted.

        Returns:
            True if there was anything.
        """
        left = self.decoder.clear()
        found = self._transport.drain()
        if left or found:
            self.note_unasked(found, left)
        return bool(left or found)

    def note_unasked(self, found: bytes, left: int = 0) -> None:
        """Note input without a request.

        Args:
            found: bytes from the transport.
            left: the number of bytes in the decoder that belonged to no frame.
        """
        self._counters.bytes_received += len(found)
        self.needs_fence = True
        if left:
            self.unsolicited += 1
        self._look_at(found)
        if self.decoder.clear():
            self.unsolicited += 1

    def listen_until(self, moment: float, *, or_late: bool = False) -> None:
        """Wait until a time of the transport's clock, and note all input.

        Args:
            moment: the time.
            or_late: end as soon as a late answer is received.

        Raises:
            TransportClosed: the connection or the device is lost.
        """
        while (rest := moment - self._transport.clock()) > 0 and not (or_late and self._state.late_s):
            try:
                found = self._transport.read(READ_BYTES, rest)
            except TransportTimeout:
                continue
            self._counters.bytes_received += len(found)
            self.needs_fence = True
            self._look_at(found)

    def listen_for_late(self) -> None:
        """Check whether an answer is only late, before the PLC is reported as silent or connected again."""
        since = self.outstanding.since
        if since is not None and not self._state.late_s and not self.instead:
            timeout_s = self._state.timeout_s
            longest_s = min(MOST_EXTENSION * timeout_s, timeout_s + LONGEST_LISTENING_S)
            self.listen_until(since + longest_s, or_late=True)

    def _look_at(self, found: bytes) -> None:
        self.decoder.feed(found)
        while True:
            try:
                frame = self.decoder.next_frame()
            except FrameError as error:
                self.note_bad_bytes(error)
                self.unsolicited += 1
                continue
            if frame is None:
                return
            self.note_stray(frame)
