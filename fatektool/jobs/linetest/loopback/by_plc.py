"""The exchange of 4E: a PLC returns the characters of the request, in frames of its protocol.

The echo of such a request and its answer are equal. So before the first exchange another request is sent,
which shows whether the line echoes (``Attempts.learn_echo``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.errors import FrameError, LineError, PlcRefused, TransportClosed, TransportError
from fatektool.jobs.linetest.loopback.exchange import Exchanger
from fatektool.protocol.commands import Command, Loopback

if TYPE_CHECKING:
    from fatektool.exchange.link import Link
    from fatektool.jobs.linetest.loopback.result import Heard
    from fatektool.protocol.codec import Frame

_LEARNING_TRIES: Final = 3
_WORST_FIRST: Final = ("mismatch", "checksum", "garbled", "stale")


class PlcExchanger(Exchanger):
    """4E, once each."""

    def __init__(self, link: Link, heard: Heard) -> None:
        super().__init__(link, heard)
        self.characters = link.codec.loopback_alphabet
        self._seen: set[str] = set()  # in this exchange
        link.receiver.on_stray = self._on_stray
        link.receiver.on_bad_bytes = self._on_bad_bytes

    @property
    def bytes_received(self) -> int:
        """All bytes received so far."""
        return self._link.counters.bytes_received

    @property
    def echoes(self) -> bool | None:
        """True on a line that echoes what is sent; None if that is not known."""
        return self._link.echoes

    def begin(self) -> None:
        """Find out whether the line echoes. From now on the time-out is the same for every answer."""
        self._link.state.extends_wait = False
        self._link.state.late_s = 0.0
        self._learn_echo()

    def _learn_echo(self) -> bool | None:
        """Send a request whose answer differs from its echo; None if there is no answer."""
        for _ in range(_LEARNING_TRIES):
            self._link.receiver.drop_input()
            try:
                self._link.attempts.learn_echo()
            except TransportClosed:
                raise
            except LineError:
                if self._link.echoes is None:
                    continue
            break
        return self._link.echoes

    def end(self) -> None:
        """Let the time-out be extended again."""
        self._link.state.extends_wait = True

    def frame_bytes(self, data: bytes) -> int:
        """How many bytes carry these characters, one way."""
        return self._link.codec.answer_bytes(Loopback(data))

    def listen_until(self, moment: float) -> None:
        """Wait until a moment of the transport's clock, and take what is received meanwhile."""
        self._link.receiver.listen_until(moment)

    def ready(self) -> None:
        """Take what was received before this exchange."""
        self._link.receiver.drop_input()
        self._seen.clear()

    def _try(self, data: bytes) -> str | None:
        link, request = self._link, Loopback(data)
        heard, echoes = link.counters.bytes_received, link.counters.echoes
        try:
            link.attempts.once(request)
            if link.echoes is None:  # was it an answer or an echo?
                return None if self._learn_echo() is False else "timeout"
        except PlcRefused:  # or a late answer of one character, which looks the same
            return "stale" if any(len(data) == 1 for data in self.unanswered) else "refused"
        except TransportClosed:
            raise
        except (TransportError, FrameError):
            echo_bytes = link.codec.answer_bytes(request) * (link.counters.echoes - echoes)
            return self._worst_heard(link.counters.bytes_received - heard - echo_bytes)
        return None

    def _worst_heard(self, heard_bytes: int) -> str:
        """The kind of error of an exchange without its answer."""
        for kind in _WORST_FIRST:
            if kind in self._seen:
                return kind
        if heard_bytes <= 0:
            return "timeout"
        self._hear_noise(heard_bytes, b"")  # the beginning of a frame
        return "garbled"

    # --- what is received beside the answers ---------------------------------------------------------

    def _on_stray(self, frame: Frame) -> None:
        heard = self._heard
        if frame.station != self._link.station:
            heard.foreign[frame.station] = heard.foreign.get(frame.station, 0) + 1
            self._seen.add("mismatch")
        elif frame.command != Command.LOOPBACK or frame.data in self._earlier:
            if frame.command == Command.LOOPBACK and frame.data == self._answered:
                heard.twice += 1
            else:
                heard.late += 1
                heard.late_s = max(heard.late_s, self._link.state.late_s)
            self._seen.add("stale")
        else:
            self._seen.add("mismatch")

    def _on_bad_bytes(self, error: FrameError) -> None:
        self._seen.add("checksum" if error.checksum else "garbled")
        self._hear_noise(len(error.raw), error.raw)
