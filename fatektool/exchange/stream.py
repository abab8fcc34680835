"""Many requests in quick succession, as long as nothing unexpected is received.

After an answer to a read with the right length, the next request is sent at once, and the answer is examined
while the PLC works on that request. A write is sent when the one before it is acknowledged; it is encoded by
then::

    reads     request n+1 ─>  examine answer n, encode request n+2  <─ answer n+1
    writes    request n   ─>  encode request n+1  <─ answer n, examine it

The length of an answer, and all of it except values and checksum, is known before it is received. So a valid
answer is accepted without a decoder (``Codec.good_answer``). Anything else (a time-out, a wrong length or
checksum, input beside the answer, an error code) ends the stream: a decoder finds out what it was, the answer
that may still be received is outstanding, and the caller goes on with ``Link.ask``, after a fence.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, TypeVar

from fatektool.errors import FrameError, PlcBusy, PlcRefused, TransportError, TransportTimeout
from fatektool.exchange.receiver import READ_BYTES

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fatektool.exchange.link import Link
    from fatektool.exchange.sender import Encoded
    from fatektool.protocol.codec import Frame
    from fatektool.protocol.commands import Request

A = TypeVar("A")


def no_more() -> bool:
    """Return False: all requests are known."""
    return False


def ask_in_stream(
    link: Link,
    requests: Sequence[Request[A]],
    first: int,
    take: Callable[[A], None],
    more: Callable[[], bool] = no_more,
) -> bool:
    """Send one request after the other from ``requests[first]``, until the end or unexpected input.

    Args:
        link: the link.
        requests: all reads, or all writes.
        first: the one to begin with.
        take: gets each answer, in order.
        more: adds a read to ``requests`` while the PLC works on the one before; returns False if there is
            none.

    Returns:
        True if the request after the last answer was sent, and its outcome is not known.

    Raises:
        PlcRefused: a write is refused. If a read is refused, the caller finds out when it asks again.
        LineReadOnly: they write, and the line is read-only.
    """
    if link.receiver.drop_input() or link.receiver.needs_fence or link.echoes is not False:
        return False
    stream = _Stream(link, take)
    try:
        if requests[first].writes:
            return stream.write(requests, first)
        return stream.read(requests, first, more)
    except TransportError:
        stream.leave_outstanding(waited_for=True)
        return True
    except PlcRefused:
        raise
    except BaseException:  # an interrupt: the answer may still be received
        stream.leave_outstanding(waited_for=True)
        raise


class _Stream(Generic[A]):
    """Requests in a row; the last one sent is remembered, because its answer may still be received."""

    def __init__(self, link: Link, take: Callable[[A], None]) -> None:
        self._take = take
        self._state = link.state
        self._codec = link.codec
        self._read = link.transport.read
        self._clock = link.transport.clock
        self._counters = link.counters
        self._receiver = link.receiver
        self._sender = link.sender
        self._byte_time_s = link.byte_time_s
        self._wait_s = link.state.wait_s  # a late answer, which makes it longer, ends the stream
        self._request: Request[A] | None = None
        self._encoded: Encoded = (b"", 0)
        self._sent_at = 0.0

    def read(self, requests: Sequence[Request[A]], first: int, more: Callable[[], bool]) -> bool:
        """Send each request before the answer to the one before is examined; see ``ask_in_stream``."""
        encode, drain = self._sender.encode, self._state.transport.drain
        following = encode(requests[first])
        whole: bytes | None = None  # the last answer, if it is not examined yet
        place = first - 1
        ahead = True
        while ahead:
            place += 1
            before = self._encoded
            self._send(requests[place], following)
            if whole is not None and not self._examine(requests[place - 1], before, whole):
                self.leave_outstanding(waited_for=False)
                return True
            ahead = place + 1 < len(requests) or more()
            if ahead:
                following = encode(requests[place + 1])
            answer = self._receive(requests[place])
            if answer is None:
                return True
            if isinstance(answer, bytes):
                whole = answer
                if found := drain():
                    self._receiver.note_unasked(found)
                    break
            elif self._examine_frame(requests[place], self._encoded, answer):
                whole = None
                if self._receiver.drop_input():
                    break
            else:  # usually a refusal: no request is sent after it whose answer nobody would wait for
                return True
        return whole is not None and not self._examine(requests[place], self._encoded, whole)

    def write(self, requests: Sequence[Request[A]], first: int) -> bool:
        """Send each request when the one before is acknowledged; see ``ask_in_stream``."""
        count = len(requests)
        following = self._sender.encode(requests[first])
        for place in range(first, count):
            request = requests[place]
            self._send(request, following)
            if place + 1 < count:
                following = self._sender.encode(requests[place + 1])
            answer = self._receive(request)
            if answer is None:
                return True
            more = self._receiver.drop_input()
            if isinstance(answer, bytes):
                taken = self._examine(request, self._encoded, answer)
            else:
                taken = self._examine_frame(request, self._encoded, answer)
            if not taken:
                self.leave_outstanding(waited_for=True)
                return True
            if more:
                break
        return False

    def leave_outstanding(self, *, waited_for: bool) -> None:
        """Note that the answer to the last request sent may still be received.

        Args:
            waited_for: False if it is not waited for.
        """
        if self._request is not None:
            sent = self._sender.described(self._request, *self._encoded)
            self._receiver.outstanding.note_sent(sent, self._sent_at)
        if waited_for:
            self._receiver.note_no_answer()
        else:
            self._receiver.give_up_answer()

    def _send(self, request: Request[A], encoded: Encoded) -> None:
        self._request = request
        self._encoded = encoded
        self._sender.send(encoded[0])
        self._sent_at = self._clock()
        self._counters.exchanges += 1

    def _receive(self, request: Request[A]) -> bytes | Frame | None:
        """Bytes of the answer's length; a frame, if one of another length was received; else None."""
        size = self._codec.answer_bytes(request)
        limit_s = (len(self._encoded[0]) + size) * self._byte_time_s + self._wait_s
        try:
            data = self._read(READ_BYTES, limit_s)
        except TransportTimeout:
            data = b""
        self._counters.bytes_received += len(data)
        answer = data if len(data) == size else self._receive_rest(data, size, self._sent_at + limit_s)
        self._sender.note_end()
        return answer

    def _receive_rest(self, data: bytes, size: int, end: float) -> bytes | Frame | None:
        """The same, in pieces. Bytes that arrived in time are accepted, even if this process is delayed.

        Args:
            data: the bytes received so far.
            size: the answer's length.
            end: the end of its time, by the transport's clock.
        """
        decoder = self._receiver.decoder
        whole = b""
        looked = False
        while True:
            whole += data
            if len(whole) == size:
                decoder.clear()
                return whole
            decoder.feed(data)
            try:
                frame = decoder.next_frame()
            except FrameError as error:
                self._receiver.note_bad_bytes(error)
                self.leave_outstanding(waited_for=False)
                return None
            if frame is not None:
                return frame
            rest = end - self._clock()
            if rest <= 0 and looked:
                self._counters.timeouts += 1
                self.leave_outstanding(waited_for=True)
                return None
            looked = rest <= 0
            try:
                data = self._read(READ_BYTES, max(0.0, rest))
            except TransportTimeout:
                data = b""
            self._counters.bytes_received += len(data)

    def _examine(self, request: Request[A], encoded: Encoded, whole: bytes) -> bool:
        """Accept an answer of the right length if it is valid; else find out what it is.

        Raises:
            PlcRefused: a write is refused.
        """
        try:
            answer = self._codec.good_answer(request, encoded[0], whole)
        except FrameError:
            return self._examine_closely(request, encoded, whole)
        self._take(answer)
        self._state.answered.add(request.command)
        return True

    def _examine_closely(self, request: Request[A], encoded: Encoded, whole: bytes) -> bool:
        decoder = self._receiver.decoder
        decoder.feed(whole)
        try:
            frame = decoder.next_frame()
        except FrameError as error:
            self._receiver.note_bad_bytes(error)
            return False
        return frame is not None and self._examine_frame(request, encoded, frame)

    def _examine_frame(self, request: Request[A], encoded: Encoded, frame: Frame) -> bool:
        """Accept the answer in a frame; False if it is not one, or an error code.

        Raises:
            PlcRefused: a write is refused.
        """
        sent = self._sender.described(request, *encoded)
        try:
            if sent.answered_by(frame):
                self._take(self._codec.parse_answer(request, frame))
                self._state.answered.add(request.command)
                return True
        except FrameError:
            pass
        except PlcRefused:
            if request.writes:
                raise
            return False
        except PlcBusy:  # to be asked again, with pauses
            return False
        self._receiver.note_stray(frame)
        return False
