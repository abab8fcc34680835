"""One try of one exchange: send, then read until its answer is there or its time is over.

A two-wire line may echo every byte. The echo of most requests can be told from any answer by its content;
that of 4E, STOP and RUN cannot. So before the first of those it is learned, from a request of the former
kind, whether this line echoes; from then on the first copy is the echo and the second the answer.

Deadline = wire time of request and longest answer at this baud + the PLC's time. A late answer that comes in
the meantime moves it: this PLC needs more.
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
from fatektool.protocol.commands import Loopback

if TYPE_CHECKING:
    from fatektool.exchange.link import Link
    from fatektool.exchange.sending import Sent
    from fatektool.protocol.codec import Frame
    from fatektool.protocol.commands import Request

A = TypeVar("A")

_READ_BYTES: Final = 4096
_MOST_KEPT: Final = 4096
_SILENT_TRIES_BEFORE_RENEWAL: Final = 2


class Attempts:
    """The tries of one link.

    Args:
        link: whose requests.
    """

    def __init__(self, link: Link) -> None:
        self._link = link
        self._silent = 0
        self._heard = bytearray()  # of this try, its beginning

    def learn_echo(self) -> None:
        """Ask what cannot be mistaken for its own echo, and hear whether the line echoes.

        A refusal is an answer too: who refuses is there, and it is no echo.

        Raises:
            LineError: nothing was learnt by this try; the PLC may not even have answered.
        """
        link = self._link
        with contextlib.suppress(PlcRefused, PlcBusy):
            self.once(link.codec.probe)
        if link.echoes is None:
            link.hearing.doubt = True
            link.hearing.words = link.hearing.words or "more than one answer"
            raise FrameError("something beside the answer: it may have been an echo or not")

    def once(self, request: Request[A]) -> A:
        """Send a request once and wait for its answer.

        Whether the line echoes is the caller's to know before it sends what its own echo would answer.

        Raises:
            TransportTimeout, TransportClosed, FrameError: this try has failed, and left a doubt.
            PlcRefused, PlcBusy: the answer is an error code.
            LineReadOnly: it writes, and the line may only be read.
        """
        link = self._link
        self._renew_if_silent()
        sent = link.prepare(request)
        link.hearing.words, link.hearing.gateway = "", None
        link.counters.exchanges += 1
        self._heard.clear()
        try:
            link.sender.send(sent)
            return self._await(request, sent)
        except GatewayTimeout as error:
            link.counters.timeouts += 1
            link.hearing.doubt = True
            link.hearing.gateway = error
            raise
        except TransportTimeout:
            link.counters.timeouts += 1
            link.hearing.lost()
            if not link.hearing.words and not link.hearing.late_s:
                self._silent += 1
            raise
        except (PlcRefused, PlcBusy):
            raise
        except BaseException:  # an interrupt too: the answer may still come
            link.hearing.lost()
            raise
        finally:
            link.sender.heard_out()

    def _renew_if_silent(self) -> None:
        """Connect anew after a long silence, unless the PLC is late: its answer comes on this connection."""
        if self._silent < _SILENT_TRIES_BEFORE_RENEWAL:
            return
        self._silent = 0
        link = self._link
        if "://" in link.transport.name:  # what else has no connection to lose: a late answer is heard later
            with contextlib.suppress(TransportClosed):
                link.listen_for_late()
        if not link.hearing.late_s:
            link.transport.renew()

    def _await(self, request: Request[A], sent: Sent) -> A:
        link = self._link
        codec, hearing = link.codec, link.hearing
        may_pass = codec.echo_may_pass(request)
        echo_due = link.echoes is True
        wire_s = (len(sent.raw) + sent.size) * link.byte_time_s
        began = link.transport.clock()
        while True:
            frame = self._next_frame(sent.size, began + wire_s)
            if frame.raw == sent.raw and (echo_due or not may_pass):
                self._hear_echo()
                echo_due = False
            elif not sent.answered_by(frame):
                hearing.stray(frame, sent)
            else:
                try:
                    answer = codec.parse_answer(request, frame)
                except FrameError as error:
                    hearing.words = error.message
                    hearing.stray(frame, sent)
                    continue
                except (PlcRefused, PlcBusy):
                    self._was_answered(request, sent, frame)
                    raise
                if isinstance(request, Loopback) and answer != request.data:
                    hearing.stray(frame, sent)
                    continue
                self._was_answered(request, sent, frame)
                return answer

    def _was_answered(self, request: Request[Any], sent: Sent, frame: Frame) -> None:
        link = self._link
        self._silent = 0
        link.hearing.answered(frame)
        link.answered.add(request.command)
        if link.echoes is None and not link.codec.echo_may_pass(request):
            beside = bytes(self._heard).replace(frame.raw, b"", 1)
            if not _like_echo(beside, sent.raw):
                link.echoes = False

    def _next_frame(self, size: int, from_s: float) -> Frame:
        """The next whole frame; bad bytes on the way are dropped and counted.

        What has come in time counts, though a busy computer may have kept this process from looking.

        Args:
            size: of the answer, in bytes.
            from_s: when the PLC's time begins.
        """
        link = self._link
        hearing, transport = link.hearing, link.transport
        looked = False
        while True:
            try:
                frame = hearing.decoder.next_frame()
            except FrameError as error:
                hearing.bad_bytes(error)
                if error.checksum and len(error.raw) == size:  # the answer, damaged: no use in waiting
                    raise
                continue
            if frame is not None:
                return frame
            rest = max(0.0, from_s + link.wait_s - transport.clock())
            if looked and not rest:
                if hearing.decoder.expect_no_more():
                    continue
                raise TransportTimeout(f"{transport.name}: no answer in time")
            looked = not rest
            try:
                data = transport.read(_READ_BYTES, rest)
            except TransportTimeout:
                continue
            link.counters.bytes_heard += len(data)
            self._heard += data[: _MOST_KEPT - len(self._heard)]
            hearing.decoder.feed(data)

    def _hear_echo(self) -> None:
        link = self._link
        link.counters.echoes += 1
        link.hearing.words = "its own request only (the line echoes)"
        if link.echoes is False:  # fences so far may have been their own echo
            link.hearing.doubt = True
            link.hearing.suspicions += 1
        link.echoes = True


def _like_echo(beside: bytes, raw: bytes) -> bool:
    """True if the bytes could hold an echo of the request, even a damaged one: half of it in its place."""
    if len(beside) < len(raw):  # too little even for that
        return False
    return any(2 * sum(map(eq, beside[at:], raw)) >= len(raw) for at in range(len(beside)))
