"""What is heard on a line beside the answers: noise, strangers, answers that nobody waits for.

All of it leaves a *doubt*, which a fence takes away. What could mean that an earlier answer was taken for
another's is also a *suspicion*: whoever sent many requests of one kind must look at their answers again.

An answer that is still owed to an earlier request is no suspicion when it comes: it was to be expected.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.counters import Counters
from fatektool.errors import FrameError, TransportTimeout
from fatektool.protocol.commands import Command

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.codec import Decoder, Frame
    from fatektool.transport.base import Transport

_MOST_PATIENCE: Final = 4
_READ_BYTES: Final = 4096


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
        patience: by how much a PLC that answers late gets more time.
        on_stray: is shown each good frame that answers nothing asked then.
        on_bad_bytes: is shown what was no frame.
        words: what was heard instead of an answer, for messages; empty for silence.
    """

    def __init__(self, transport: Transport, decoder: Decoder, station: int) -> None:
        self.decoder = decoder
        self.counters = Counters()
        self.suspicions = 0
        self.doubt = False
        self.patience = 1
        self.on_stray: Callable[[Frame], object] = _to_nobody
        self.on_bad_bytes: Callable[[FrameError], object] = _to_nobody
        self.words = ""
        self._transport = transport
        self._station = station
        self._doubtful: set[int] = set()  # other stations, whose late answers may still come
        self._owed = 0  # requests without an answer since the last fence: as many may still come
        self._given_up = 0  # those of them whose answer was not even waited for

    def turn_to(self, station: int) -> bool:
        """Wait for another station's answers from now on; True if an earlier one of it may still come.

        Answers bear their station's number, so those of the station before matter when it is asked again.
        """
        if self.doubt:
            self._doubtful.add(self._station)
        self._station = station
        self._owed = self._given_up = 0
        self.patience = 1
        known = station in self._doubtful
        self._doubtful.discard(station)
        self.doubt = self.doubt or known
        return known

    def fenced(self) -> None:
        """A fence came down: nothing can be on its way any more."""
        self.doubt = False
        self._owed = self._given_up = 0

    def lost(self) -> None:
        """A request found no answer in time."""
        self.doubt = True
        self._owed += 1

    def give_up(self) -> None:
        """A request is on its way whose answer nobody will wait for."""
        self.doubt = True
        self._given_up += 1

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

    def stray(self, frame: Frame) -> None:
        """A good frame that answers nothing asked now."""
        self.counters.strays += 1
        self.on_stray(frame)
        self.doubt = True
        if frame.station != self._station:
            self.words = f"station {frame.station} instead"
            return
        self.words = self.words or f"an answer to another command ({frame.command:02X})"
        if frame.command == Command.LOOPBACK:
            return  # an old fence, which can be told from everything else
        if self._given_up:
            self._given_up -= 1
        elif self._owed:  # it came, but late: give this PLC more time from now on
            self._owed -= 1
            self.patience = min(2 * self.patience, _MOST_PATIENCE)
        else:
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

    def listen_until(self, moment: float) -> None:
        """Wait until a moment of the transport's clock, and look at whatever comes unasked.

        Raises:
            TransportClosed: the line is gone.
        """
        while (rest := moment - self._transport.clock()) > 0:
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
