"""What is heard on a line beside the answers: noise, strangers, answers that nobody waits for.

All of it leaves a *doubt*, which a fence takes away. What could mean that an earlier answer was taken for
another's is also a *suspicion*: whoever sent many requests of one kind must look at their answers again.

An answer that is still owed to an earlier request is no suspicion when it comes: it was to be expected. It is
late, and how late tells how long this PLC takes to answer.
"""

from __future__ import annotations

from collections import deque
from math import inf
from typing import TYPE_CHECKING, Final, NamedTuple

from fatektool.errors import FrameError, TransportTimeout
from fatektool.exchange.counters import Counters
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.errors import GatewayTimeout
    from fatektool.exchange.sending import Sent
    from fatektool.protocol.codec import Decoder, Frame
    from fatektool.transport.base import Transport

_READ_BYTES: Final = 4096
_MOST_OWED: Final = 64
"""Of the oldest, which come first, none may be pushed out by the fences that are asked meanwhile."""


class Awaited(NamedTuple):
    """A request whose answer may still come.

    Attributes:
        sent: the request.
        since: when it and its answer could have crossed the wire: from then on the PLC's time runs.
        given_s: how long the answer was to be waited for then.
        waited_for: False if nobody waited for its answer.
        before_s: how long the one took that was taken for its answer, if another comes.
    """

    sent: Sent
    since: float
    given_s: float
    waited_for: bool = True
    before_s: float = 0.0

    def is_answered_by(self, frame: Frame) -> bool:
        """True if the frame may be its answer."""
        return self.sent.answered_by(frame) and self.sent.data in {None, frame.data}


class Hearing:
    """The state of the input of one line.

    Args:
        transport: the medium.
        decoder: cuts its input into frames.
        station: whose answers are waited for.

    Attributes:
        counters: what was seen so far.
        suspicions: how often something came that may have been an answer gone astray.
        doubt: True until a fence proves that nothing else can come.
        late_s: the longest that an answer took that came too late, beside wire time; 0 if none did.
        on_stray: is shown each good frame that answers nothing asked then.
        on_bad_bytes: is shown what was no frame.
        words: what was heard instead of an answer, for messages; empty for silence.
        gateway: what a gateway said instead of an answer to the last request; None if none did.
        misnumbered: True if an answer bore a number that no request had.
    """

    def __init__(self, transport: Transport, decoder: Decoder, station: int) -> None:
        self.decoder = decoder
        self.counters = Counters()
        self.suspicions = 0
        self.doubt = False
        self.late_s = 0.0
        self.on_stray: Callable[[Frame], object] = _to_nobody
        self.on_bad_bytes: Callable[[FrameError], object] = _to_nobody
        self.words = ""
        self.gateway: GatewayTimeout | None = None
        self.misnumbered = False
        self._transport = transport
        self._station = station
        self._doubtful: set[int] = set()  # other stations, whose late answers may still come
        self._answered_at = -inf  # when the last one of several answers that were due came
        self._awaited: Awaited | None = None  # the last request
        self._owed: deque[Awaited] = deque(maxlen=_MOST_OWED)  # those without an answer since the last fence

    @property
    def owed_since(self) -> float | None:
        """Since when the oldest answer is owed; None if there is none."""
        return self._owed[0].since if self._owed else None

    def expect(self, sent: Sent, wire_s: float, wait_s: float) -> None:
        """A request went out.

        Args:
            sent: the request.
            wire_s: of it and its answer.
            wait_s: how long its answer will be waited for beside that.
        """
        self._awaited = Awaited(sent, self._transport.clock() + wire_s, wait_s)

    def turn_to(self, station: int) -> bool:
        """Wait for another station's answers from now on; True if an earlier one of it may still come.

        Answers bear their station's number, so those of the station before matter when it is asked again.
        """
        if self.doubt:
            self._doubtful.add(self._station)
        self._station = station
        self._awaited = None
        self._owed.clear()
        self.late_s = 0.0
        known = station in self._doubtful
        self._doubtful.discard(station)
        self.doubt = self.doubt or known
        return known

    def fenced(self) -> None:
        """A fence came down: nothing can be on its way any more."""
        self.doubt = False
        self._owed.clear()

    def lost(self) -> None:
        """The last request found no answer in time."""
        self._owe(waited_for=True)

    def give_up(self) -> None:
        """The last request is on its way, and nobody will wait for its answer."""
        self._owe(waited_for=False)

    def _owe(self, *, waited_for: bool) -> None:
        self.doubt = True
        if self._awaited is not None:
            sent = self._awaited.sent._replace(raw=b"")
            self._owed.append(self._awaited._replace(sent=sent, waited_for=waited_for))
            self._awaited = None

    def answered(self, frame: Frame) -> None:
        """An answer was taken. If the like was owed, it may be that one, and this one's still comes."""
        if not self._owed or self._awaited is None:
            return
        for place, owed in enumerate(self._owed):
            if owed.is_answered_by(frame):
                self._answered_at = now = self._transport.clock()
                self._owed[place] = owed._replace(since=self._awaited.since, before_s=now - owed.since)
                return

    def bad_bytes(self, error: FrameError) -> None:
        """Bytes that are no frame."""
        self.doubt = True
        self.on_bad_bytes(error)
        if error.checksum:
            self.counters.checksum_errors += 1
            self.words = f"a damaged frame ({error.message})"
        else:
            self.counters.garbled += 1
            self.words = self.words or f"{len(error.raw)} bytes that are no frame"

    def stray(self, frame: Frame, asked: Sent | None = None) -> None:
        """A good frame that answers nothing asked now.

        Args:
            frame: it.
            asked: what is asked now, if anything is.
        """
        self.counters.strays += 1
        self.doubt = True
        if frame.station != self._station:
            self.words = f"station {frame.station} instead"
        else:
            owed = next((owed for owed in self._owed if owed.is_answered_by(frame)), None)
            if owed is None:
                self._answer_to_nothing(frame, asked)
            else:
                self._owed.remove(owed)
                if owed.waited_for:  # it came, but late: this PLC gets more time from now on
                    self.late_s = max(self.late_s, self._took_s(owed), owed.before_s)
            self._answered_at = self._transport.clock()
        self.on_stray(frame)

    def _took_s(self, owed: Awaited) -> float:
        """How long a PLC took for an answer that has just come.

        It does one thing after the other, so the time counts from its answer before. If that makes less than
        the answer was waited for, something else took the time, and counts all the same.
        """
        now = self._transport.clock()
        took_s = now - max(owed.since, self._answered_at)
        return took_s if took_s > owed.given_s else now - owed.since

    def _answer_to_nothing(self, frame: Frame, asked: Sent | None) -> None:
        if asked is not None and (frame.command, frame.number) == (asked.code, asked.number):
            pass  # the caller has said what is wrong with it
        elif asked is not None and frame.command == asked.code:
            self.misnumbered = True
            self.words = (
                f"an answer with transaction number {frame.number:04X}, expected {asked.number:04X}, "
                "that of the request"
            )
        elif frame.command == Command.LOOPBACK:
            self.words = self.words or "another loopback's answer"
        else:
            self.words = self.words or f"an answer to another command ({frame.command:02X})"
        if frame.command != Command.LOOPBACK:  # an old fence can be told from everything else
            self.suspicions += 1

    def drop_input(self) -> bool:
        """Before a request: look at what lies in the input, as it may tell of an answer that went astray.

        True if there was anything.
        """
        left = self.decoder.clear()
        found = self._transport.drain()
        if not left and not found:
            return False
        self.counters.bytes_heard += len(found)
        self.doubt = True
        if left:
            self.suspicions += 1
        self._overhear(found)
        if self.decoder.clear():
            self.suspicions += 1
        return True

    def listen_until(self, moment: float, *, or_late: bool = False) -> None:
        """Wait until a moment of the transport's clock, and look at whatever comes unasked.

        Args:
            moment: until when.
            or_late: end as soon as an answer came late.

        Raises:
            TransportClosed: the line is gone.
        """
        while (rest := moment - self._transport.clock()) > 0 and not (or_late and self.late_s):
            try:
                found = self._transport.read(_READ_BYTES, rest)
            except TransportTimeout:
                continue
            self.counters.bytes_heard += len(found)
            self.doubt = True
            self._overhear(found)

    def _overhear(self, found: bytes) -> None:
        """Look at bytes that nobody asked for."""
        self.decoder.feed(found)
        while True:
            try:
                frame = self.decoder.next_frame()
            except FrameError as error:
                self.bad_bytes(error)
                self.suspicions += 1
                continue
            if frame is None:
                return
            self.stray(frame)


def _to_nobody(_: object) -> None:
    pass
