"""One exchange with a PLC: deadline, retry, and never another question's answer.

Answers do not name their question: a 4F answer carries no page number, a 46 answer no register. So after a
time-out the late answer to page 5 would pass for page 6. What keeps them apart:

- Input is dropped before each request.
- After any doubt (a time-out, garbage, an answer that nobody asked for) a **fence** is put up before the next
  request: a loopback (4E) with a fresh nonce. All that comes before its echo is dropped, and only the exact
  nonce brings the fence down: an older fence's echo does not.
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
from typing import TYPE_CHECKING, TypeVar

from fatektool.errors import (
    FrameError,
    LineError,
    NoAnswer,
    PlcRefused,
    TransportClosed,
    TransportError,
    TransportTimeout,
    UsageError,
)
from fatektool.hearing import Hearing
from fatektool.protocol.commands import Command, Loopback, ReadBriefStatus
from fatektool.protocol.read_back import read_back
from fatektool.silence import no_answer
from fatektool.transport.base import no_note

if TYPE_CHECKING:
    from collections.abc import Callable

    from fatektool.protocol.codec import Codec, Frame
    from fatektool.protocol.commands import Request
    from fatektool.transport.base import LineSettings, Transport

A = TypeVar("A")

_READ_BYTES = 4096
_SILENT_TRIES_BEFORE_RENEWAL = 2


class Link:
    """Exchanges with one station over one transport.

    Args:
        transport: the medium, open.
        codec: the protocol.
        station: 1 to 254.
        line: speed and format, for wire times; over TCP and UDP that of the line behind the gateway.
        timeout_s: the PLC's time to answer, beside wire time.
        retries: further tries of one exchange.
        nonces: gives the fences' nonces, never the same twice; for tests.
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
        note: Callable[[str], None] = no_note,
    ) -> None:
        if not 1 <= station <= 254:
            raise UsageError(
                f"station: expected 1 to 254, got {station}", hint="0 is broadcast: no PLC answers it"
            )
        self.transport = transport
        self.codec = codec
        self.station = station
        self.timeout_s = timeout_s
        self.retries = retries
        self.hearing = Hearing(transport, codec.decoder(), station)
        self.counters = self.hearing.counters
        self.line = line
        self.byte_time_s = line.byte_time_s
        self._nonces = nonces
        self._note = note
        self.echoes: bool | None = None
        self._silent_tries = 0
        self.answered: set[int] = set()  # commands

    # --- what others call -------------------------------------------------------------------------

    def ask(self, request: Request[A]) -> A:
        """Send a request and give its answer, with retries.

        Raises:
            NoAnswer: no try found an answer to trust.
            PlcRefused: the answer is an error code.
        """
        failure: LineError | None = None
        fences = self.counters.fences
        for _ in range(self.retries + 1):
            self.hearing.drop_input()
            if self.hearing.doubt:
                try:
                    self.fence()
                except LineError as error:  # the fence stays up: further tries would be in vain
                    closed = failure if isinstance(failure, TransportClosed) else error
                    raise self._silence(request, closed) from error
            try:
                if self.echoes is None and self.codec.echo_may_pass(request):
                    self.learn_echo()
                return self.try_once(request)
            except (TransportError, FrameError) as error:
                failure = error
            if request.writes and self._took(request):
                return None  # type: ignore[return-value]  # a write's answer is None
        raise self._silence(request, failure, alive=self.counters.fences > fences)

    @property
    def suspicions(self) -> int:
        """How often something came that may have been an answer gone astray."""
        return self.hearing.suspicions

    @property
    def signs(self) -> tuple[int, int, int]:
        """Suspicions, trouble and fences so far: the same twice means that nothing was out of order."""
        counters = self.counters
        return self.suspicions, counters.trouble, counters.fences

    def fence(self) -> None:
        """Make sure that no answer to an earlier request can come any more.

        Raises:
            NoAnswer: the PLC does not answer the loopback.
            PlcRefused: it refuses it.
        """
        failure: LineError | None = None
        nonce = Loopback(b"")
        for _ in range(self.retries + 1):
            nonce = Loopback(self._nonces())
            try:
                if self.echoes is None and self.codec.echo_may_pass(nonce):
                    self.learn_echo()
                self.try_once(nonce)
            except (TransportError, FrameError) as error:
                failure = error
                continue
            self.hearing.fenced()
            self.counters.fences += 1
            return
        raise self._silence(nonce, failure)

    def closing_fence(self) -> bool:
        """A fence behind the last of many requests; True if it proves their answers.

        A PLC that never answered a loopback is let off with a note: with nothing astray before, what is lost
        is the proof, not the answers.
        """
        self.hearing.drop_input()
        doubt = self.hearing.doubt
        try:
            self.fence()
        except (NoAnswer, PlcRefused):
            if doubt or Command.LOOPBACK in self.answered:
                raise
            self._note("this PLC answers no loopback (4E): a late answer to an earlier request could pass")
            self.hearing.fenced()
            return False
        return True

    def broadcast(self, request: Request[None]) -> None:
        """Send a request to every PLC on the line (station 0). Nobody answers."""
        self.transport.write(self.codec.encode(0, request))

    # --- one try ----------------------------------------------------------------------------------

    def learn_echo(self) -> None:
        """Ask what cannot be mistaken for its own echo, and hear whether the line echoes.

        Raises:
            LineError: nothing was learnt by this try; the PLC may not even have answered.
        """
        self.try_once(ReadBriefStatus())
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
        """
        raw = self.codec.encode(self.station, request)
        self.hearing.words = ""
        self.counters.exchanges += 1
        try:
            self.transport.write(raw)
            size = self.codec.answer_bytes(request)
            deadline = self.transport.clock() + (len(raw) + size) * self.byte_time_s
            return self._await(request, raw, size, deadline + self.timeout_s * self.hearing.patience)
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

    def _await(self, request: Request[A], raw: bytes, size: int, deadline: float) -> A:
        echo_due = self.echoes is True
        heard_before = self.counters.bytes_heard
        while True:
            frame = self._next_frame(size, deadline)
            if frame.raw == raw and (echo_due or not self.codec.echo_may_pass(request)):
                self._hear_echo()
                echo_due = False
            elif frame.station != self.station or frame.command != request.command:
                self.hearing.stray(frame)
            else:
                try:
                    answer = self.codec.parse_answer(request, frame)
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

    def _took(self, request: Request[A]) -> bool:
        """Read back a write whose answer was lost."""
        question, took = read_back(request)  # type: ignore[arg-type]  # request.writes: its answer is None
        try:
            return took(self.ask(question))
        except PlcRefused:
            return False
        except LineError as error:
            raise self._silence(request, error, unknown=True) from error

    def _silence(
        self, request: Request[A], failure: LineError | None, *, alive: bool = False, unknown: bool = False
    ) -> LineError:
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
        )
