"""One exchange of a loopback test: what the loop of the test needs, whatever the frame is.

::

    loopback            the loop: what to send next, when to end, figures
    └─ Exchanger        one exchange -> None for a good one, or the kind of its error
       ├─ PlcExchanger  4E, in frames of the protocol
       └─ RawExchanger  the frame of the user's own ladder program

A broken connection is one failed exchange; if it breaks again before one was good, the test ends.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from typing import TYPE_CHECKING, Final

from fatektool.errors import TransportClosed

if TYPE_CHECKING:
    from fatektool.exchange.link import Link
    from fatektool.jobs.linetest.loopback.result import Heard

REMEMBERED: Final = 16
_SAMPLE_BYTES: Final = 64


class Exchanger(ABC):
    """Sends characters and waits for the same ones.

    Args:
        link: the line.
        heard: counts what is received beside the answers.

    Attributes:
        characters: what may be sent, in rising order.
        unanswered: what was sent and is not answered yet, the latest ones.
    """

    characters: bytes

    def __init__(self, link: Link, heard: Heard) -> None:
        self.unanswered: list[bytes] = []
        self._link = link
        self._heard = heard
        self._earlier: deque[bytes] = deque(maxlen=REMEMBERED)
        self._answered: bytes | None = None
        self._hung_up = False

    @property
    @abstractmethod
    def bytes_received(self) -> int:
        """All bytes received so far."""

    @property
    @abstractmethod
    def echoes(self) -> bool | None:
        """True on a line that echoes what is sent; None if that is not known."""

    @abstractmethod
    def begin(self) -> None:
        """Learn what must be known before the first exchange."""

    @abstractmethod
    def end(self) -> None:
        """The test is over."""

    @abstractmethod
    def frame_bytes(self, data: bytes) -> int:
        """How many bytes carry these characters, one way."""

    @abstractmethod
    def listen_until(self, moment: float) -> None:
        """Wait until a moment of the transport's clock, and take what is received meanwhile."""

    @abstractmethod
    def ready(self) -> None:
        """Take what was received before, so that it is not taken for the next answer."""

    @abstractmethod
    def _try(self, data: bytes) -> str | None:
        """Exchange once; None if the answer is good, else the kind of the error."""

    def exchange(self, data: bytes) -> str | None:
        """Send characters once; None if they were returned, else the kind of the error.

        Raises:
            TransportClosed: the line is lost.
        """
        try:
            error = self._try(data)
        except TransportClosed:  # a gateway may close it once; the next request connects again
            if self._hung_up:
                raise
            self._hung_up = True
            error = "timeout"
        self._earlier.append(data)
        if error is None:
            self._hung_up = False
            self._answered = data
            self.unanswered.clear()
        else:
            self.unanswered = [*self.unanswered[1 - REMEMBERED :], data]
        return error

    def _hear_noise(self, count: int, sample: bytes) -> None:
        self._heard.noise_bytes += count
        if len(self._heard.noise) < _SAMPLE_BYTES:
            self._heard.noise += sample[: _SAMPLE_BYTES - len(self._heard.noise)]
