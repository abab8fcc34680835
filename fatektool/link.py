"""One exchange with a PLC: deadline, retry, and never another question's answer.

Answers do not name their question: a 4F answer carries no page number, a 46 answer no register. So after a
time-out the late answer to page 5 would pass for page 6. What keeps them apart:

- Input is dropped before each request.
- After any doubt (a time-out, garbage, an answer that nobody asked for) a **fence** is put up before the next
  request: see ``fences``. Where answers repeat a number of their request (``Codec.numbers``), that tells them
  apart, and none is needed.
- A two-wire line may echo every byte. The echo of most requests can be told from any answer by its content;
  that of 4E, STOP and RUN cannot. So before the first of those it is learned, from a request of the former
  kind, whether this line echoes; from then on the first copy is the echo and the second the answer.
- A write whose answer was lost is read back before it is sent again.

``suspicions`` counts what could mean that an earlier answer was taken for another's: input that nobody asked
for. Whoever sends many requests of one kind puts up a fence at the end and reads again what stands in doubt:
that is ``batch.ask_all``.

Deadline of one try = wire time of request and longest answer at this baud + the PLC's time. A PLC whose
answers are seen to come late gets twice that time, up to four times; one that is silent does not.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, TypeVar

from fatektool.errors import (
    FrameError,
    LineError,
    LineReadOnly,
    PlcRefused,
    TransportClosed,
    TransportError,
    TransportTimeout,
)
from fatektool.fences import Fences
from fatektool.hearing import Hearing
from fatektool.protocol.codec import require_station
from fatektool.protocol.commands import Command, Loopback
from fatektool.protocol.read_back import read_back
from fatektool.sending import Sender
from fatektool.silence import no_answer
from fatektool.transport.base import no_note

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.codec import Codec, Frame
    from fatektool.protocol.commands import Request
    from fatektool.sending import Sent
    from fatektool.transport.base import LineSettings, Transport

A = TypeVar("A")

_READ_BYTES = 4096
_SILENT_TRIES_BEFORE_RENEWAL = 2


class Link:
    """Exchanges with one station over one transport.

    Args:
        transport: the medium, open.
        codec: the protocol.
        station: 1 to the codec's last.
        line: speed and format, for wire times; over TCP and UDP that of the line behind the gateway.
        timeout_s: the PLC's time to answer, beside wire time.
        retries: further tries of one exchange.
        nonces: gives the fences' nonces, never the same twice; for tests.
        read_only: refuse every request that writes, before a byte is sent.
        note: is told what a curious user may want to know.
    """

    def __init__(
        self,
        transport: Transport,
        codec: Codec,
        station: int,
        line: LineSettings,
        *,
        timeout_s: float = 0.5,
        retries: int = 3,
        nonces: Callable[[], bytes] = lambda: os.urandom(4).hex().upper().encode(),
        read_only: bool = False,
        note: Callable[[str], None] = no_note,
    ) -> None:
        require_station(codec, station)
        self.transport = transport
        self.codec = codec
        self.station = station
        self.timeout_s = timeout_s
        self.retries = retries
        self.hearing = Hearing(transport, codec.decoder(), station)
        self.counters = self.hearing.counters
        self.line = line
        self.byte_time_s = line.byte_time_s
        self.read_only = read_only
        self.note = note
        self.echoes: bool | None = None
        self._silent_tries = 0
        self.answered: set[int] = set()  # commands
        self.fences = Fences(self, nonces)
        self.sender = Sender(self)

    # --- what others call -------------------------------------------------------------------------

    def ask(self, request: Request[A]) -> A:
        """Send a request and give its answer, with retries.

        Raises:
            NoAnswer: no try found an answer to trust.
            PlcRefused: the answer is an error code.
            LineReadOnly: it writes, and the line may only be read.
        """
        self.require_leave(request)
        failure: LineError | None = None
        fences = self.counters.fences
        for _ in range(self.retries + 1):
            self.hearing.drop_input()
            if self.hearing.doubt:
                try:
                    self.fence(request)
                except LineError as error:  # the fence stays up: further tries would be in vain
                    closed = failure if isinstance(failure, TransportClosed) else error
                    raise self.silence(request, closed) from error
            try:
                if self.echoes is None and self._needs_a_read_before(request):
                    self.learn_echo()
                return self.try_once(request)
            except (TransportError, FrameError) as error:
                failure = error
            if request.writes and self.took(request):
                return None  # type: ignore[return-value]  # a write's answer is None
        raise self.silence(request, failure, alive=self.counters.fences > fences)

    @property
    def suspicions(self) -> int:
        """How often something came that may have been an answer gone astray; numbered ones never do."""
        return 0 if self.numbered else self.hearing.suspicions

    @property
    def signs(self) -> tuple[int, int, int]:
        """Suspicions, trouble and fences so far: the same twice means that nothing was out of order."""
        counters = self.counters
        return (0, 0, 0) if self.numbered else (self.suspicions, counters.trouble, counters.fences)

    @property
    def numbered(self) -> bool:
        """True if each answer tells which request it belongs to."""
        return self.codec.numbers > 1

    def fence(self, before: Request[Any] | None = None) -> None:
        """Make sure that no answer to an earlier request can come any more: see ``fences``.

        Args:
            before: what is asked next, if that is known: the fence's answer must not pass for its either.

        Raises:
            NoAnswer: the PLC does not answer it.
            PlcRefused: it refuses it.
        """
        self.fences.put_up(before)

    def broadcast(self, request: Request[None]) -> None:
        """Send a request to every PLC on the line (station 0). Nobody answers.

        Raises:
            LineReadOnly: it writes, and the line may only be read.
        """
        self.require_leave(request)
        self.transport.write(self.codec.encode(0, request))

    def require_leave(self, request: Request[A]) -> None:
        """Check that this request may be sent at all.

        Raises:
            LineReadOnly: it writes, and the line may only be read.
        """
        if self.read_only and request.writes:
            raise LineReadOnly(f"{request.command.words} ({request.command:02X})")

    def _needs_a_read_before(self, request: Request[Any]) -> bool:
        """True where nothing is known of this line yet, and this request could be misunderstood.

        The echo of some could pass for the answer. And a write to unit 0 is handed by a gateway to every PLC
        behind it, none of which answers: what answers a read there is one PLC.
        """
        return self.codec.echo_may_pass(request) or (request.writes and self.station == 0)

    # --- one try ----------------------------------------------------------------------------------

    def learn_echo(self) -> None:
        """Ask what cannot be mistaken for its own echo, and hear whether the line echoes.

        Raises:
            LineError: nothing was learnt by this try; the PLC may not even have answered.
        """
        self.try_once(self.codec.probe)
        if self.echoes is None:
            self.hearing.doubt = True
            self.hearing.words = self.hearing.words or "more than one answer"
            raise FrameError("something beside the answer: it may have been an echo or not")

    def try_once(self, request: Request[A]) -> A:
        """Send a request once and wait for its answer.

        Whether the line echoes is the caller's to know before it sends what its own echo would answer.

        Raises:
            TransportTimeout, TransportClosed, FrameError: this try has failed, and left a doubt.
            PlcRefused: the answer is an error code.
            LineReadOnly: it writes, and the line may only be read.
        """
        sent = self.prepare(request)
        self.hearing.words = ""
        self.counters.exchanges += 1
        try:
            self.sender.send(sent)
            size = self.codec.answer_bytes(request)
            deadline = self.transport.clock() + (len(sent.raw) + size) * self.byte_time_s
            return self._await(request, sent, size, deadline + self.timeout_s * self.hearing.patience)
        except TransportTimeout:
            self.counters.timeouts += 1
            self.hearing.lost()
            if not self.hearing.words:
                self._silent_tries += 1
                if self._silent_tries >= _SILENT_TRIES_BEFORE_RENEWAL:
                    self._silent_tries = 0
                    self.transport.renew()
            raise
        except PlcRefused:
            raise
        except BaseException:  # an interrupt too: the answer may still come
            self.hearing.lost()
            raise
        finally:
            self.sender.heard_out()

    def prepare(self, request: Request[Any]) -> Sent:
        """A request as it goes out; its answer may come from now on, until the next fence.

        Raises:
            UsageError: it cannot be said in this protocol.
            LineReadOnly: it writes, and the line may only be read.
        """
        if self.read_only:
            self.require_leave(request)
        self.fences.note_asked(request)
        return self.sender.prepare(request)

    def _await(self, request: Request[A], sent: Sent, size: int, deadline: float) -> A:
        raw = sent.raw
        echo_due = self.echoes is True
        heard_before = self.counters.bytes_heard
        while True:
            frame = self._next_frame(size, deadline)
            if frame.raw == raw and (echo_due or not self.codec.echo_may_pass(request)):
                self._hear_echo()
                echo_due = False
            elif not sent.answered_by(frame):
                self.hearing.stray(frame)
            else:
                try:
                    answer = self.codec.parse_answer(request, frame)
                except TransportTimeout as error:  # what a gateway says instead of the PLC
                    self.hearing.words = error.message
                    raise
                except FrameError as error:
                    self.hearing.words = error.message
                    self.hearing.stray(frame)
                    continue
                if isinstance(request, Loopback) and answer != request.data:
                    self.hearing.words = "another loopback's answer"
                    self.hearing.stray(frame)
                    continue
                self._silent_tries = 0
                self.answered.add(request.command)
                if self.echoes is None and not self.codec.echo_may_pass(request):
                    beside = self.counters.bytes_heard - heard_before - len(frame.raw)
                    if beside < len(raw):  # too little for an echo, even a damaged one
                        self.echoes = False
                return answer

    def _next_frame(self, size: int, deadline: float) -> Frame:
        """The next whole frame; bad bytes on the way are dropped and counted."""
        while True:
            try:
                frame = self.hearing.decoder.next_frame()
            except FrameError as error:
                self.hearing.bad_bytes(error)
                if error.checksum and len(error.raw) == size:  # the answer, damaged: no use in waiting
                    raise
                continue
            if frame is not None:
                return frame
            rest = deadline - self.transport.clock()
            if rest <= 0:
                if self.hearing.decoder.expect_no_more():
                    continue
                raise TransportTimeout(f"{self.transport.name}: no answer in time")
            try:
                data = self.transport.read(_READ_BYTES, rest)
            except TransportTimeout:
                continue
            self.counters.bytes_heard += len(data)
            self.hearing.decoder.feed(data)

    def _hear_echo(self) -> None:
        self.counters.echoes += 1
        self.hearing.words = "its own request only (the line echoes)"
        if self.echoes is False:  # fences so far may have been their own echo
            self.hearing.doubt = True
            self.hearing.suspicions += 1
        self.echoes = True

    # --- after a failure --------------------------------------------------------------------------

    def took(self, request: Request[A]) -> bool:
        """Read back a write whose answer was lost: did the PLC take it?

        Raises:
            LineError: that is not known.
        """
        question, took = read_back(request)  # type: ignore[arg-type]  # request.writes: its answer is None
        try:
            return took(self.ask(question))
        except PlcRefused:
            return False
        except LineError as error:
            raise self.silence(request, error, unknown=True) from error

    def silence(
        self, request: Request[A], failure: LineError | None, *, alive: bool = False, unknown: bool = False
    ) -> LineError:
        """The error for a request that found no answer to trust: see ``silence.no_answer``."""
        if isinstance(failure, TransportClosed):
            return failure
        return no_answer(
            request,
            self.hearing.words,
            station=self.station,
            target=self.transport.name,
            line=self.transport.line or self.codec.name,
            tries=self.retries + 1,
            timeout_s=self.timeout_s,
            alive=alive,
            served=request.command in self.answered,
            unknown=unknown,
            fence="loopbacks" if Command.LOOPBACK in self.codec.commands else "other questions",
        )
