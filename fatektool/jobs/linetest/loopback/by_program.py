"""The exchange with the user's own ladder program, which returns each frame that it receives.

Such a frame has no station, no command and no checksum. So an answer is recognised by its text alone, and no
request can show whether a two-wire line echoes: an echo is counted as an answer. It arrives faster than any
answer can, and the diagnosis reports that (``raw_rules``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fatektool.errors import TransportTimeout
from fatektool.jobs.linetest.loopback.exchange import Exchanger

if TYPE_CHECKING:
    from fatektool.exchange.link import Link
    from fatektool.jobs.linetest.loopback.result import Heard
    from fatektool.jobs.linetest.raw_frame import RawFrame

_READ_BYTES: Final = 4096
_MOST_KEPT: Final = 1 << 14
"""So many of the last bytes are kept while an answer is waited for."""


class RawExchanger(Exchanger):
    """Texts in the frames of the ladder program, once each.

    Args:
        link: its line, time-out and baud rate are used, not its protocol.
        heard: counts what is received beside the answers.
        frame: start and end code.
    """

    echoes = None
    bytes_received = 0

    def __init__(self, link: Link, heard: Heard, frame: RawFrame) -> None:
        super().__init__(link, heard)
        self.characters = frame.characters(link.line.data_bits)
        self._frame = frame
        self._transport = link.transport

    def begin(self) -> None:
        """There is nothing to find out before the first exchange."""

    def end(self) -> None:
        """Nothing was set."""

    def frame_bytes(self, data: bytes) -> int:
        """How many bytes carry these characters, one way."""
        return len(self._frame.wrap(data))

    def listen_until(self, moment: float) -> None:
        """Wait until a moment of the transport's clock, and take what is received meanwhile."""
        self._overhear(self._receive(moment))

    def ready(self) -> None:
        """Take what was received before this exchange."""
        found = self._transport.drain()
        self.bytes_received += len(found)
        self._overhear(found)

    def _try(self, data: bytes) -> str | None:
        wanted = self._frame.wrap(data)
        try:
            self._transport.write(wanted)
        except TransportTimeout:
            return "timeout"
        wire_s = 2 * len(wanted) * self._link.byte_time_s
        got = self._receive(self._transport.clock() + wire_s + self._link.timeout_s, wanted)
        before, found, after = got.partition(wanted)
        if not found:
            kind = self._kind_of(got, len(wanted))
            self._overhear(got)
            return kind
        self._overhear(before)
        self._answered = data
        self._overhear(after)
        return None

    def _receive(self, moment: float, wanted: bytes | None = None) -> bytes:
        """What is received until then, or until the expected frame is complete."""
        got = b""
        while (wanted is None or wanted not in got) and (rest := moment - self._transport.clock()) > 0:
            try:
                data = self._transport.read(_READ_BYTES, rest)
            except TransportTimeout:
                continue
            self.bytes_received += len(data)
            got = (got + data)[-_MOST_KEPT:]
        return got

    def _kind_of(self, got: bytes, size: int) -> str:
        """The kind of error of an exchange without its answer."""
        if not got:
            return "timeout"
        if any(self._frame.wrap(text) in got for text in self._earlier):
            return "stale"
        return "mismatch" if self._frame.holds_frame(got, size) else "garbled"

    def _overhear(self, found: bytes) -> None:
        """Count bytes that are not the expected answer."""
        for text in self.unanswered:
            found, late = self._without(found, text)
            self._heard.late += late
        if self._answered is not None:
            found, twice = self._without(found, self._answered)
            self._heard.twice += twice
        self._hear_noise(len(found), found)

    def _without(self, found: bytes, text: bytes) -> tuple[bytes, int]:
        """The bytes without the frame of this text, and 1 if it was there."""
        before, there, after = found.partition(self._frame.wrap(text))
        return before + after, len(there) and 1
