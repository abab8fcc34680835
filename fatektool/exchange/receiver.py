"""What is received beside the answers: noise, frames of other stations, answers that nobody waits for.

After any of it, answers may be out of step with requests, until a fence shows that nothing else can come:
``needs_fence``. ``unsolicited`` counts what nobody had asked for: an answer to an earlier request may have
been taken for that of a later one. Whoever sent many requests of one kind must then check their answers. An
answer that is still outstanding is not unsolicited, but late (``outstanding``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.callbacks import ignore
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
"""As many bytes are read at once."""

LONGEST_LISTENING_S: Final = 2.0
"""A PLC is listened to this much longer than its time-out, at most, before it is called silent."""


class Receiver:
    """The input of one link.

    Args:
        state: of the link.

    Attributes:
        decoder: cuts the input into frames.
        outstanding: the requests whose answers may still come.
        unsolicited: how often something came that nobody had asked for.
        needs_fence: True until a fence shows that nothing else can come.
        on_stray: is given each good frame that answers nothing asked then.
        on_bad_bytes: is given what was no frame.
        instead: what was received instead of an answer, for messages; empty for nothing.
        gateway_error: what a gateway answered instead of the PLC to the last request; None if it did not.
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
        self._stations_to_fence: set[int] = set()  # other stations, whose late answers may still come

    def change_station(self, station: int) -> bool:
        """Wait for another station's answers; True if an answer to an earlier request may still come from it.

        Answers carry their station, so those of the station before matter when it is asked again.

        Args:
            station: the other station; the state still has the one before.
        """
        if self.needs_fence:
            self._stations_to_fence.add(self._state.station)
        self.outstanding.change_station()
        may_come = station in self._stations_to_fence
        self._stations_to_fence.discard(station)
        self.needs_fence = self.needs_fence or may_come
        return may_come

    # --- what became of a request -----------------------------------------------------------------

    def fence_passed(self) -> None:
        """No answer to an earlier request can come any more."""
        self.needs_fence = False
        self.outstanding.forget()

    def note_no_answer(self) -> None:
        """The last request found no answer in time."""
        self.needs_fence = True
        self.outstanding.keep_last(waited_for=True)

    def give_up_answer(self) -> None:
        """The last request was sent, and nobody will wait for its answer."""
        self.needs_fence = True
        self.outstanding.keep_last(waited_for=False)

    # --- what came instead of an answer -----------------------------------------------------------

    def note_bad_bytes(self, error: FrameError) -> None:
        """Bytes came that are no frame."""
        self.needs_fence = True
        self.on_bad_bytes(error)
        if error.checksum:
            self._counters.checksum_errors += 1
            self.instead = f"a damaged frame ({error.message})"
        else:
            self._counters.garbled += 1
            self.instead = self.instead or f"{len(error.raw)} bytes that are no frame"

    def note_stray(self, frame: Frame, asked: Sent | None = None) -> None:
        """A good frame came that answers nothing asked now.

        Args:
            frame: the frame.
            asked: what is asked now, if anything is.
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
            pass  # the caller has said what is wrong with it
        elif asked is not None and frame.command == asked.code:
            self.wrong_number = True
            self.instead = (
                f"an answer with transaction number {frame.number:04X}, expected {asked.number:04X}, "
                "that of the request"
            )
        elif frame.command == Command.LOOPBACK:
            self.instead = self.instead or "another loopback's answer"
        else:
            self.instead = self.instead or f"an answer to another command ({frame.command:02X})"
        if frame.command != Command.LOOPBACK:  # an old fence's answer can be told from all others
            self.unsolicited += 1

    # --- when nothing is asked --------------------------------------------------------------------

    def drop_input(self) -> bool:
        """Before a request: drop the input, after a look at it, as it may show that answers are out of step.

        Returns:
            True if there was anything.
        """
        left = self.decoder.clear()
        found = self._transport.drain()
        if left or found:
            self.note_unasked(found, left)
        return bool(left or found)

    def note_unasked(self, found: bytes, left: int = 0) -> None:
        """Take note of what came and nobody had asked for.

        Args:
            found: bytes from the transport.
            left: how many bytes the decoder held that belonged to no frame.
        """
        self._counters.bytes_received += len(found)
        self.needs_fence = True
        if left:
            self.unsolicited += 1
        self._look_at(found)
        if self.decoder.clear():
            self.unsolicited += 1

    def listen_until(self, moment: float, *, or_late: bool = False) -> None:
        """Wait until a moment of the transport's clock, and take note of whatever comes.

        Args:
            moment: until when.
            or_late: end as soon as a late answer came.

        Raises:
            TransportClosed: the line is gone.
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
        """Before a PLC is called silent, or its connection made anew: is its answer only late?"""
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
