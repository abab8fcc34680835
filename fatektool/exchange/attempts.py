"""One try of one request: send it, then read until its answer is received or its time is over.

A two-wire line may echo every byte. The echo of most requests differs from every answer; the echo of 4E,
STOP and RUN does not. So before the first of those, another request shows whether this line echoes; from then
on the first copy is the echo and the second the answer.

Deadline = wire time of request and longest answer at this baud + the PLC's time. A late answer that is
received in the meantime extends it, because this PLC needs more time.
"""

from __future__ import annotations

import contextlib
from operator import eq
from typing import TYPE_CHECKING, Any, Final, TypeVar

from fatektool.errors import (
    FrameError,
    GatewayTimeout,
    PlcBusy,
    PlcRefused,
    TransportClosed,
    TransportTimeout,
)
from fatektool.exchange.receiver import READ_BYTES
from fatektool.protocol.commands import Loopback

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fatektool.exchange.receiver import Receiver
    from fatektool.exchange.sender import Sender
    from fatektool.exchange.sent import Sent
    from fatektool.exchange.state import LinkState
    from fatektool.protocol.codec import Frame
    from fatektool.protocol.commands import Request

A = TypeVar("A")

LONGEST_PAUSE_S: Final = 5.0
"""Between two requests to a PLC that is busy."""

_MOST_KEPT: Final = 4096
_SILENT_TRIES_BEFORE_RENEWAL: Final = 2


class Attempts:
    """The tries of one link.

    Args:
        state: of the link.
        receiver: its input.
        sender: its output.
    """

    def __init__(self, state: LinkState, receiver: Receiver, sender: Sender) -> None:
        self._state = state
        self._receiver = receiver
        self._sender = sender
        self._silent = 0  # tries in a row for which nothing was received
        self._received = bytearray()  # in this try, its beginning

    def learn_echo(self) -> None:
        """Send a request whose echo differs from its answer, to learn whether the line echoes.

        A refusal is an answer too: the PLC is there, and a refusal is not an echo.

        Raises:
            LineError: the result is still unknown after this try.
        """
        state, receiver = self._state, self._receiver
        with contextlib.suppress(PlcRefused, PlcBusy):
            self.once(state.codec.probe)
        if state.echoes is None:
            receiver.needs_fence = True
            receiver.instead = receiver.instead or "more than one answer"
            raise FrameError("more than the answer was received: it is not known whether the line echoes")

    def once(self, request: Request[A]) -> A:
        """Send a request once and wait for its answer.

        Before a request whose echo equals its answer, the caller must know whether the line echoes.

        Raises:
            TransportTimeout, TransportClosed, FrameError: this try has failed, and a fence is needed.
            PlcRefused, PlcBusy: the answer is an error code.
            LineReadOnly: it writes, and the line is read-only.
        """
        self._renew_if_silent()
        counters, receiver = self._state.counters, self._receiver
        sent = self._sender.described(request, *self._sender.encode(request))
        receiver.instead, receiver.gateway_error = "", None
        counters.exchanges += 1
        self._received.clear()
        try:
            self._sender.send(sent.raw)
            receiver.outstanding.note_sent(sent, self._state.transport.clock())
            return self._await(request, sent)
        except GatewayTimeout as error:
            counters.timeouts += 1
            receiver.needs_fence = True
            receiver.gateway_error = error
            raise
        except TransportTimeout:
            counters.timeouts += 1
            receiver.note_no_answer()
            if not receiver.instead and not self._state.late_s:
                self._silent += 1
            raise
        except (PlcRefused, PlcBusy):
            raise
        except BaseException:  # an interrupt too: the answer may still be received
            receiver.note_no_answer()
            raise
        finally:
            self._sender.note_end()

    def wait_while_busy(self, attempt: int) -> None:
        """Wait for a PLC that is busy, longer each time.

        Args:
            attempt: the number of waits before this one.
        """
        state = self._state
        if attempt < state.retries:
            pause_s = min(state.timeout_s * 2**attempt, LONGEST_PAUSE_S)
            self._receiver.listen_until(state.transport.clock() + pause_s)

    def _renew_if_silent(self) -> None:
        """Connect again after a long silence, unless the PLC is late: its answer comes on this connection."""
        if self._silent < _SILENT_TRIES_BEFORE_RENEWAL:
            return
        self._silent = 0
        transport = self._state.transport
        if "://" in transport.name:  # other media have no connection: a late answer is received later
            with contextlib.suppress(TransportClosed):
                self._receiver.listen_for_late()
        if not self._state.late_s:
            transport.renew()

    def _await(self, request: Request[A], sent: Sent) -> A:
        state, receiver = self._state, self._receiver
        codec = state.codec
        may_pass = codec.echo_may_pass(request)
        echo_due = state.echoes is True
        wire_s = (len(sent.raw) + sent.size) * state.byte_time_s
        began = state.transport.clock()
        for frame in self._frames(sent.size, began + wire_s):
            if frame.raw == sent.raw and (echo_due or not may_pass):
                self._note_echo()
                echo_due = False
            elif not sent.answered_by(frame):
                receiver.note_stray(frame, sent)
            else:
                try:
                    answer = codec.parse_answer(request, frame)
                except FrameError as error:
                    receiver.instead = error.message
                    receiver.note_stray(frame, sent)
                    continue
                except (PlcRefused, PlcBusy):
                    self._note_answer(request, sent, frame)
                    raise
                if isinstance(request, Loopback) and answer != request.data:
                    receiver.note_stray(frame, sent)
                    continue
                self._note_answer(request, sent, frame)
                return answer
        raise TransportTimeout(f"{state.transport.name}: no answer in time")

    def _note_answer(self, request: Request[Any], sent: Sent, frame: Frame) -> None:
        state = self._state
        self._silent = 0
        self._receiver.outstanding.note_answer(frame)
        state.answered.add(request.command)
        if state.echoes is None and not state.codec.echo_may_pass(request):
            beside = bytes(self._received).replace(frame.raw, b"", 1)
            if not _like_echo(beside, sent.raw):
                state.echoes = False

    def _frames(self, size: int, from_s: float) -> Iterator[Frame]:
        """The whole frames that are received in time; bad bytes between them are dropped and counted.

        Bytes that arrived in time are accepted, even if a busy computer delayed this process: once the time
        is over, what is there is read, in one piece.

        Args:
            size: of the answer, in bytes.
            from_s: when the PLC's time begins.

        Raises:
            FrameError: the answer, damaged.
        """
        state, receiver, transport = self._state, self._receiver, self._state.transport
        looked = False
        while True:
            try:
                frame = receiver.decoder.next_frame()
            except FrameError as error:
                receiver.note_bad_bytes(error)
                if error.checksum and len(error.raw) == size:  # waiting is useless
                    raise
                continue
            if frame is not None:
                yield frame
                continue
            rest = max(0.0, from_s + state.wait_s - transport.clock())
            if looked and not rest:
                if receiver.decoder.expect_no_more():
                    continue
                return
            looked = not rest
            try:
                data = transport.read(READ_BYTES, rest)
            except TransportTimeout:
                continue
            state.counters.bytes_received += len(data)
            self._received += data[: _MOST_KEPT - len(self._received)]
            receiver.decoder.feed(data)

    def _note_echo(self) -> None:
        state, receiver = self._state, self._receiver
        state.counters.echoes += 1
        receiver.instead = "its own request only (the line echoes)"
        if state.echoes is False:  # fences so far may have been their own echo
            receiver.needs_fence = True
            receiver.unsolicited += 1
        state.echoes = True


def _like_echo(beside: bytes, raw: bytes) -> bool:
    """True if the bytes may contain an echo of the request, even a damaged one: half of it in its place."""
    if len(beside) < len(raw):  # too few bytes even for that
        return False
    return any(2 * sum(map(eq, beside[at:], raw)) >= len(raw) for at in range(len(beside)))
